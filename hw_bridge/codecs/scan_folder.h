#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tubetwin {

// A folder through which a client asks for scans and gets them: for scanners whose vendor software
// saves files, on a network share or on the same machine. Numbers count up from 1 and have at least
// six digits. "The feed" is whatever saves the scans.
//
//   trigger-000007      written by the client: please scan now. Its content is for people.
//   scan-000007.pcd     the feed's answer: the whole cloud, organised, in the scanner's frame S;
//   scan-000007.ply     PCD in metres, PLY as PhoXi saves it (millimetres, empties 0 0 0 kept)
//   scan-000007.error   the feed's refusal: one line of text that says why
//   ANYTHING.pcd, .ply  a scan that an operator saved: answers a trigger when it comes after it
//
// Files are written under a name with a leading dot and then renamed, so that no half-written file
// is ever read. The feed removes a trigger when it starts on it; the client removes one that it
// gives up on. Only the newest trigger counts. Otherwise neither removes files of the other.

/// What a file of the folder is, by its name alone.
struct ScanFileName {
  enum class Kind {
    kOther,    ///< Not ours: hidden, temporary, any other ending.
    kTrigger,  ///< trigger-N
    kScan,     ///< scan-N.pcd, scan-N.ply
    kRefusal,  ///< scan-N.error
    kSaved,    ///< Another cloud, saved by an operator.
  };
  Kind kind = Kind::kOther;
  std::uint64_t number = 0;  ///< Of trigger, scan and refusal.
};

/// Understands any bytes. Endings in any case; a number has 6 to 18 digits.
ScanFileName ParseScanFileName(std::string_view name);

std::string TriggerFileName(std::uint64_t number);
/// `ending` with its dot: ".pcd", ".ply" or ".error".
std::string ScanFileNameOf(std::uint64_t number, std::string_view ending);

}  // namespace tubetwin
