#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "models/base/disk/output_file.h"

namespace tubetwin {

/// What no input of this program is larger than.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;

/// Whole content of a regular file. Throws Error(kMissing) when it does not exist, may not be read,
/// has a name that no file can have, or is a folder, pipe, device or socket (which might never
/// end); Error(kBadData) when it holds more than `max_bytes`; Error(kIo) when reading fails.
std::string ReadFile(const std::string& path, std::uint64_t max_bytes = kMaxFileBytes);

/// Calls `use` with every line of a regular file, without its line break; `whole` says whether the
/// break was there, which the last one may lack. Keeps one line in memory. Throws as ReadFile does,
/// with Error(kBadData) naming the line for one of more than `max_line_bytes`.
void ForEachLine(const std::string& path, std::uint64_t max_line_bytes,
                 const std::function<void(const std::string& line, bool whole)>& use);

// Files are written beside their place and then renamed: readers see the old file or the new one,
// never half. File and folder are on the disk when the call returns, so that a power cut leaves the
// old file or the new one, too. Missing parent folders are made. A symbolic link is replaced, what
// it points to stays. All of these throw Error(kCannotCreate) when folder or file cannot be created
// or the path is a folder, device, pipe or socket, Error(kIo) when writing fails, the disk is full
// or broken; the old file then stays.

void WriteFileAtomically(const std::string& path, std::string_view content);
/// Same for content that comes piece by piece.
void WriteFileInPieces(const std::string& path, const std::function<void(OutputFile& out)>& write);
/// Same for a library that wants a file name: `write` gets that of an empty file, whose ending is
/// the path's.
void WriteThroughTemporary(const std::string& path,
                           const std::function<void(const std::string& temporary_path)>& write);

/// A message to another program: whole when it is seen, but nothing waits for the disk, since
/// nobody reads it after a power cut. Throws as WriteFileAtomically().
void WriteMessageFile(const std::string& path, std::string_view content);

/// Renames, replacing what file is there, and waits until the disk has it. Throws Error(kIo).
void RenameDurably(const std::string& from, const std::string& to);

/// Creates the folder and its parents, on the disk when it returns, and checks that files can be
/// made in it. Throws Error(kCannotCreate | kIo).
void MakeFolder(const std::string& path);

/// 64-bit fingerprint of a text, 16 hexadecimal digits; the same on every machine. Not
/// cryptographic.
std::string Fingerprint(std::string_view text);

}  // namespace tubetwin
