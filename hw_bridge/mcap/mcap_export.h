#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hw_bridge/recording/cell_recording.h"

namespace tubetwin {

struct McapOptions {
  TimeNs from = TimeNs::min(), to = TimeNs::max();  ///< Cell time that is exported.
  /// Every so many rows and columns of a cloud; 1: every point.
  int cloud_step = 2;
};

/// Writes a recording for public readers and viewers: topics /joint_states (arm and gripper), /tf
/// (frames base, link_1 .. link_6, flange, wrist, tool, scanner, bin, tray), /arm, /gripper,
/// /wrench (frame wrist: K), /cloud (frame bin, posed as the pipeline believes) and /log (captions,
/// results, commands, refusals, faults). SI units; times are the cell's, from 0. Joint states and
/// transforms at most 100 times a second, arm and gripper when they change, the rest as it was
/// read. Metadata `tubetwin` has versions, seed and fingerprint, the attachment
/// config.resolved.toml the configuration. Written atomically. Returns the number of messages of
/// each topic. Throws Error(kCannotCreate | kIo), and Error(kBadData) where the recording is
/// damaged.
std::map<std::string, std::uint64_t> ExportMcap(CellRecording& recording, const std::string& path,
                                                const McapOptions& options);

}  // namespace tubetwin
