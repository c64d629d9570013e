#pragma once

#include <string>

#include "models/base/json_fwd.h"
#include "twin/round/records/round_record.h"

namespace tubetwin {

/// {"variant", "round", "seed", "summary", "picks", "timings"}, rows with their place, and back.
/// Throws Error(kBadData).
Json ToJson(const RoundRecord& record);
RoundRecord RecordFromJson(const JsonView& view);

/// One line without its line break, closed by a check sum that ParseRecordLine() verifies.
std::string RecordLine(const RoundRecord& record);

/// The record of a line. Throws Error(kBadData) saying what is wrong: half-written, damaged, or no
/// record.
RoundRecord ParseRecordLine(const std::string& line);

/// First difference in what rows depend on (everything but timings), for messages; empty when
/// equal.
std::string RecordDifference(const RoundRecord& a, const RoundRecord& b);

/// `json`, an object, as a line closed by "check": the fingerprint of what stands before it.
std::string CheckedLine(const Json& json);
/// The object of such a line without its check. Throws Error(kBadData).
Json ParseCheckedLine(const std::string& line);

}  // namespace tubetwin
