#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/round/records/metric.h"
#include "twin/round/records/round_record.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// Text of the scenario with every key written out; reading it again gives the same scenario.
std::string ResolvedToml(const Scenario& scenario);

/// Refuses a folder with picks.jsonl of another configuration: throws Error(kCannotCreate).
void RequireSameConfiguration(const std::string& folder, const std::string& resolved_toml);

/// One JSON object per line, each without line breaks; written atomically.
void WriteJsonLines(const std::vector<Json>& rows, const std::string& path);
/// Hands each object of such a file to `use`; its source names file and line. Throws
/// Error(kMissing | kBadData).
void ReadJsonLines(const std::string& path, const std::function<void(const JsonView& row)>& use);

/// Writes picks.jsonl, timings.jsonl and summary.json of a round's own folder.
void WriteRoundRecord(const RoundRecord& record, const std::string& folder);
/// Reads them back; timings may be missing. Throws Error(kMissing), and Error(kBadData) for rows
/// that cannot be read, are not what the manifest beside them says, or contradict their summary.
RoundRecord ReadRoundRecord(const std::string& folder);
/// Content of a round's summary.json: the summary, and behind it the measures that `metrics` add.
Json RoundSummaryJson(const RoundRecord& record, const std::vector<Metric>& metrics = Metrics());

/// manifest.json: versions, build, seeds, machine, fingerprint of the configuration, end. The one
/// file besides timings.jsonl that holds what a clock or a machine said.
Json Manifest(const Scenario& scenario, const std::string& resolved_toml,
              const std::string& program_version, int threads, double wall_s);

}  // namespace tubetwin
