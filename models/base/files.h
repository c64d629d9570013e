#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <string_view>

namespace tubetwin {

/// Whole content of a file. Throws Error(kMissing) when it does not exist or is a folder,
/// Error(kIo) when it cannot be read.
std::string ReadFile(const std::string& path);

/// Writes `content` beside `path`, then renames: readers see the old file or the new one, never
/// half. Creates missing parent folders. Throws Error(kCannotCreate) when the folder or file cannot
/// be created or the path is a device, pipe or socket, Error(kIo) when writing fails; the old file
/// then stays.
void WriteFileAtomically(const std::string& path, std::string_view content);

/// Same for content that is written piece by piece, or by a library that wants a file name:
/// `write` gets the temporary path.
void WriteThroughTemporary(const std::string& path,
                           const std::function<void(const std::string& temporary_path)>& write);

/// Creates the folder and its parents and checks that files can be made in it.
/// Throws Error(kCannotCreate).
void MakeFolder(const std::string& path);

/// 64-bit fingerprint of a text, 16 hexadecimal digits; the same on every machine. Not
/// cryptographic.
std::string Fingerprint(std::string_view text);

}  // namespace tubetwin
