#include "twin/campaign/campaign_status.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <set>

#include "models/base/disk/file_lock.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/campaign/shard_file.h"
#include "twin/statistics/rate.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

// Three missed beats of 10 s and a slow file server.
constexpr double kSilentAfter_s = 60.0;

std::string StatusFile(const std::string& folder, const Shard& shard) {
  return (fs::path(folder) / "status" / fs::path(ShardFileName(shard)).replace_extension(".json"))
      .string();
}

std::string Format(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string ShareText(int k, int n) {
  if (n == 0) return "no attempt yet";
  const ShareInterval interval = Wilson95(k, n);
  char text[96];
  std::snprintf(text, sizeof text, "success %d/%d = %.1f %% [%.1f, %.1f]", k, n, 100.0 * k / n,
                100.0 * interval.low, 100.0 * interval.high);
  return text;
}

void AddShardState(const std::string& folder, const Shard& shard, CampaignStatus::ShardLine& line) {
  const std::string file = StatusFile(folder, shard);
  if (!fs::exists(file)) return;
  const Json json = ReadJsonFile(file);
  const JsonView view(json, file);
  RequireSchema(view, "shard_status");
  line.state = view.Field("state").AsString();
  line.where = view.Field("where").AsString();
  line.age_s = std::difftime(std::time(nullptr), view.Field("written_unix_s").AsInteger());
  if (line.state != "running") return;
  if (line.age_s > kSilentAfter_s) {
    line.state = "silent";
  } else {
    line.rounds_per_hour = view.Field("rounds_per_hour").AsNumber();
  }
}

}  // namespace

std::string DurationText(double seconds) {
  if (seconds < 120.0) return Format("%.0f s", seconds);
  if (seconds < 7200.0) return Format("%.0f min", seconds / 60.0);
  if (seconds < 172800.0) return Format("%.1f h", seconds / 3600.0);
  return Format("%.1f d", seconds / 86400.0);
}

void WriteShardStatus(const std::string& folder, const ShardProgress& progress,
                      const std::string& state) {
  Json out;
  out["schema"] = "tubetwin/shard_status/1";
  out["shard"] = progress.shard.Name();
  out["state"] = state;
  out["where"] = ThisProcess();
  out["written_unix_s"] = static_cast<std::int64_t>(std::time(nullptr));
  out["done"] = progress.done;
  out["total"] = progress.total;
  out["running"] = progress.running;
  out["faults"] = progress.faults;
  out["rounds_per_hour"] = progress.rounds_per_hour;
  out["peak_memory_kB"] = progress.peak_memory_kB;
  WriteJsonFile(out, StatusFile(folder, progress.shard));
}

namespace {

/// "62 parts/h"; of several variants, in their order, "62, 70, 75 parts/h by variant", and of many
/// the range. Empty before any round told.
std::string PartsText(const std::vector<RoundWork>& by_variant) {
  constexpr std::size_t kAllTold = 4;
  std::vector<double> rates;
  std::string list;
  for (const RoundWork& work : by_variant) {
    const double time_s = work.cell_s + work.compute_s;
    if (time_s > 0.0) rates.push_back(3600.0 * work.placed / time_s);
    list += (list.empty() ? "" : ", ") + (time_s > 0.0 ? ToText(rates.back()) : "-");
  }
  if (rates.empty()) return "";
  if (by_variant.size() == 1) return ", " + list + " parts/h";
  if (by_variant.size() <= kAllTold) return ", " + list + " parts/h by variant";
  const auto [low, high] = std::minmax_element(rates.begin(), rates.end());
  return ", " + ToText(*low) + " to " + ToText(*high) + " parts/h by variant";
}

/// What is counted where several variants share the rounds of a file.
std::string OfVariants(int rounds, int variants) {
  if (variants < 2) return "";
  return " (" + std::to_string(rounds / variants) + " of each of " + std::to_string(variants) +
         " variants)";
}

}  // namespace

std::string ProgressText(const ShardProgress& progress) {
  std::string text = "shard " + progress.shard.Name() + ": " + std::to_string(progress.done) + "/" +
                     std::to_string(progress.total) + " rounds" +
                     OfVariants(progress.total, progress.variants) + ", " +
                     Format("%.1f/h", progress.rounds_per_hour);
  text += PartsText(progress.work);
  if (progress.seconds_left) text += ", " + DurationText(*progress.seconds_left) + " left";
  text += ", " + ShareText(progress.successes, progress.attempts);
  if (progress.faults > 0) text += ", " + std::to_string(progress.faults) + " crashed";
  return text;
}

namespace {

PartsPerHour PartsOf(std::vector<RoundRecord>& records, std::int64_t seed, int variant) {
  // In the order of a merged file, whatever the shards: the same interval as there.
  std::sort(records.begin(), records.end(),
            [](const RoundRecord& a, const RoundRecord& b) { return a.round < b.round; });
  std::vector<RoundFacts> facts;
  for (const RoundRecord& record : records) facts.push_back(FactsOf(record));
  return PartsPerHourOf(facts, HourOf::kCellAndComputing,
                        BootstrapStream(seed, variant).Fork("parts_per_hour"));
}

}  // namespace

CampaignStatus ReadCampaignStatus(const std::string& folder) {
  const CampaignIdentity identity = ReadCampaignIdentity(folder);
  const int rounds = identity.rounds;
  const auto variants = static_cast<int>(identity.variants.size());
  CampaignStatus out;
  out.rounds = rounds * variants;
  out.variants = variants;
  std::vector<std::vector<RoundRecord>> records(identity.variants.size());
  const std::vector<std::string> files = ShardFiles(folder);
  if (files.empty() && fs::exists(fs::path(folder) / "rounds.jsonl")) {
    throw Error(ErrorKind::kMissing, folder + ": is a merged result; nothing is run here");
  }
  for (const std::string& file : files) {
    const ShardContent content = ReadShardFile(file);
    CampaignStatus::ShardLine line;
    line.name = content.shard.Name();
    for (int round = 0; round < rounds; ++round)
      line.total += content.shard.Owns(round) ? variants : 0;
    std::set<std::pair<int, int>> seen;
    for (const RoundRecord& record : content.records) {
      if (!seen.emplace(record.variant, record.round).second) continue;
      ++line.done;
      out.faults += record.summary.crashed() ? 1 : 0;
      for (const AttemptRecord& attempt : record.attempts) {
        ++out.attempts;
        out.successes += attempt.success == true ? 1 : 0;
      }
      if (record.variant < variants) records[record.variant].push_back(record);
    }
    AddShardState(folder, content.shard, line);
    out.shards = content.shard.count;
    out.done += line.done;
    out.rounds_per_hour += line.rounds_per_hour;
    out.problems.insert(out.problems.end(), content.problems.begin(), content.problems.end());
    out.lines.push_back(std::move(line));
  }
  for (int variant = 0; variant < variants; ++variant) {
    if (records[variant].empty()) continue;
    out.parts_per_hour.emplace_back(identity.variants[variant],
                                    PartsOf(records[variant], identity.seed, variant));
  }
  if (out.done == out.rounds) {
    out.seconds_left = 0.0;
  } else if (out.rounds_per_hour > 0.0) {
    out.seconds_left = 3600.0 * (out.rounds - out.done) / out.rounds_per_hour;
  }
  return out;
}

Json ToJson(const CampaignStatus& status) {
  Json out;
  out["schema"] = "tubetwin/campaign_status/1";
  out["rounds"] = status.rounds;
  out["done"] = status.done;
  out["crashed"] = status.faults;
  out["success"] = ToJson(Counts{status.successes, status.attempts});
  out["parts_per_hour"] = Json::array();
  for (const auto& [name, rate] : status.parts_per_hour) {
    Json row = ToJson(rate);
    row["name"] = name;
    out["parts_per_hour"].push_back(std::move(row));
  }
  out["rounds_per_hour"] = status.rounds_per_hour;
  out["seconds_left"] = status.seconds_left ? Json(*status.seconds_left) : Json(nullptr);
  out["shards"] = status.shards;
  out["shards_begun"] = Json::array();
  for (const auto& line : status.lines) {
    out["shards_begun"].push_back(Json{{"shard", line.name},
                                       {"state", line.state},
                                       {"where", line.where},
                                       {"done", line.done},
                                       {"total", line.total},
                                       {"rounds_per_hour", line.rounds_per_hour},
                                       {"age_s", line.age_s}});
  }
  out["problems"] = status.problems;
  return out;
}

std::string ToText(const CampaignStatus& status) {
  std::string text = std::to_string(status.done) + " of " + std::to_string(status.rounds) +
                     " rounds done" + OfVariants(status.rounds, status.variants) + ", " +
                     ShareText(status.successes, status.attempts);
  if (status.faults > 0) text += ", " + std::to_string(status.faults) + " crashed";
  text += "\n";
  for (const auto& [name, rate] : status.parts_per_hour) {
    text += "  " + ToText(rate) + " parts per hour, computing included: " + name + "\n";
  }
  if (status.done < status.rounds) {
    text += Format("%.1f rounds per hour", status.rounds_per_hour);
    text += status.seconds_left ? ", " + DurationText(*status.seconds_left) + " left\n"
                                : ", nothing runs\n";
  }
  if (status.shards > 1) {
    text += std::to_string(status.lines.size()) + " of " + std::to_string(status.shards) +
            " shards have begun\n";
  }
  for (const auto& line : status.lines) {
    text += "  shard " + line.name + "  " + std::to_string(line.done) + "/" +
            std::to_string(line.total) + "  " + line.state;
    if (line.state == "running") text += Format("  %.1f/h", line.rounds_per_hour);
    if (line.state == "running" || line.state == "silent") {
      text += "  " + line.where + ", heard of " + DurationText(line.age_s) + " ago";
    }
    text += "\n";
  }
  for (const std::string& problem : status.problems) text += "  " + problem + "\n";
  return text;
}

}  // namespace tubetwin
