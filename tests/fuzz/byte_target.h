#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tubetwin {

// One decoder, or the readers of one kind of file, under mutated bytes; each fuzz/NAME_target.cc
// defines these for NAME_mutations and NAME_fuzz.

/// Decodes `bytes`. What they are must not matter: a decoder says what it found or why it found
/// nothing, and what it found encodes to the bytes that it read; a reader gives what is whole, or
/// refuses with an Error that names the file in at most four printable lines. Anything else aborts
/// the process, as a fuzzer wants it.
void TryBytes(std::string_view bytes);

/// Messages or small files of every kind: where mutations start.
std::vector<std::string> ByteCorpus();

}  // namespace tubetwin
