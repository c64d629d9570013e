#include "twin/round/result_files.h"

#include <sys/utsname.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "models/base/disk/build_id.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/json_text.h"
#include "scenes/engine/engine_error.h"
#include "twin/round/folder/file_checks.h"
#include "twin/round/records/throughput.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxRowBytes = std::uint64_t{16} << 20;

std::string CpuName() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) == 0) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string UtcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace

std::string ResolvedToml(const Scenario& scenario) {
  Scenario copy = scenario;  // Visiting is non-const: one list serves reading and writing.
  return WriteToml([&copy](ConfigVisitor& v) { copy.Visit(v); }, false);
}

void RequireSameConfiguration(const std::string& folder, const std::string& resolved_toml) {
  const fs::path rows = fs::path(folder) / "picks.jsonl";
  const fs::path config = fs::path(folder) / "config.resolved.toml";
  // What belongs to a campaign is refused as a campaign.
  if (!fs::exists(rows) || fs::exists(fs::path(folder) / "campaign.json")) return;
  if (!fs::exists(config) || ReadFile(config.string()) != resolved_toml) {
    throw Error(ErrorKind::kCannotCreate,
                folder + ": holds the rows of another configuration (" + config.string() +
                    " differs); give another --out, or --force to replace them");
  }
}

void WriteJsonLines(const std::vector<Json>& rows, const std::string& path) {
  std::string text;
  for (const Json& row : rows) {
    text += row.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  WriteFileAtomically(path, text);
}

void ReadJsonLines(const std::string& path, const std::function<void(const JsonView& row)>& use) {
  int number = 0;
  ForEachLine(path, kMaxRowBytes, [&](const std::string& line, bool) {
    const std::string where = path + ":" + std::to_string(++number);
    const Json row = ParseJson(line, where);
    if (!row.is_object()) throw Error(ErrorKind::kBadData, where + ": not a JSON object");
    use(JsonView(row, where));
  });
}

Json RoundSummaryJson(const RoundRecord& record, const std::vector<Metric>& metrics) {
  Json out = ToJson(record.summary);
  const std::vector<RoundFacts> facts = {FactsOf(record)};
  for (const Metric& metric : metrics) {
    // Some of the headline the summary tells itself, and needs no attempt for it.
    const bool told = metric.place == Metric::Place::kHeadline && !out.contains(metric.name);
    if (told || metric.place == Metric::Place::kMeasure) AddValue(ValueOf(metric, facts), out);
  }
  out["parts_per_hour"] = ToJson(PartsPerHourOf(facts, HourOf::kCell, {}));
  return out;
}

void WriteRoundRecord(const RoundRecord& record, const std::string& folder) {
  const fs::path out(folder);
  std::vector<Json> picks, timings;
  for (const AttemptRecord& attempt : record.attempts) picks.push_back(ToJson(attempt, RowPlace()));
  for (const AttemptTiming& timing : record.timings) timings.push_back(ToJson(timing, RowPlace()));
  WriteJsonLines(picks, (out / "picks.jsonl").string());
  WriteJsonLines(timings, (out / "timings.jsonl").string());
  WriteJsonFile(RoundSummaryJson(record), (out / "summary.json").string());
}

RoundRecord ReadRoundRecord(const std::string& folder) {
  const fs::path at(folder);
  RequireWholeFiles(folder, {"picks.jsonl", "summary.json"}, /*always=*/false);
  RoundRecord record;
  const std::string file = (at / "summary.json").string();
  const Json summary = ReadJsonFile(file);
  record.summary = SummaryFromJson(JsonView(summary, file));
  ReadJsonLines((at / "picks.jsonl").string(),
                [&](const JsonView& row) { record.attempts.push_back(AttemptFromJson(row)); });
  RequireConsistent(record, (at / "picks.jsonl").string());
  const std::string timings = (at / "timings.jsonl").string();
  if (!fs::exists(timings)) return record;
  ReadJsonLines(timings,
                [&](const JsonView& row) { record.timings.push_back(TimingFromJson(row)); });
  return record;
}

Json Manifest(const Scenario& scenario, const std::string& resolved_toml,
              const std::string& program_version, int threads, double wall_s) {
  utsname name{};
  uname(&name);
  Json out;
  out["schema"] = "tubetwin/manifest/1";
  out["program"] = program_version;
  out["build"] = BuildId();
  out["mujoco"] = EngineVersion();
  out["compiler"] = __VERSION__;
  out["seed"] = scenario.seed;
  out["fingerprint"] = Fingerprint(resolved_toml);
  out["machine"] = Json{{"system", name.sysname},
                        {"release", name.release},
                        {"architecture", name.machine},
                        {"cpu", CpuName()},
                        {"threads", threads}};
  out["finished_utc"] = UtcNow();
  out["wall_s"] = wall_s;
  return out;
}

}  // namespace tubetwin
