#pragma once

namespace tubetwin {

/// The number of one column of a binary cloud or mesh, of this machine's byte order. `kind`: 'I'
/// signed, 'U' unsigned, 'F' floating (4 and 8 bytes); `size` in bytes: 1, 2, 4 or 8.
double ColumnNumber(const char* bytes, char kind, int size);

}  // namespace tubetwin
