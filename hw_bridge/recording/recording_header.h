#pragma once

#include <string>

#include "hw_bridge/recording/cell_recording.h"

namespace tubetwin {

/// Text of a recording's first block. Poses are written as sixteen numbers, which do not round.
std::string HeaderToText(const CellRecordingHeader& header);

/// Throws Error(kBadData) naming `source` and field.
CellRecordingHeader HeaderFromText(const std::string& text, const std::string& source);

/// Text of the end mark and what it says.
struct RecordingEnd {
  std::string reason;
  std::uint64_t commands = 0, reads = 0;
};
std::string EndToText(const RecordingEnd& end);
RecordingEnd EndFromText(const std::string& text, const std::string& source);

}  // namespace tubetwin
