#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/campaign/merge.h"
#include "twin/statistics/rate.h"

namespace tubetwin {

/// The campaign file of the 2020 paper's experiment (Leão et al., Appl. Sci. 10, 2264): sets A
/// (`pvc_a`) and B (`hose_b`), seven tubes, in profile leao2020 with one scan from 0.80 m over the
/// floor, then with the same seeds in profile best with eight views. `rounds` of each.
std::string ReproductionToml(std::int64_t seed, int rounds);

/// Profiles that stand beside the paper, in the order of columns.
inline constexpr std::array<const char*, 2> kReproductionProfiles = {"leao2020", "best"};

/// A mean time with Student's interval, seconds. n is 2 or more.
struct MeanTime {
  int n = 0;
  double mean_s = 0.0, sd_s = 0.0;
  Interval mean95_s;
};

/// What a table says at one place: nothing, a share or a time.
using ReproductionCell = std::variant<std::monostate, Rate, MeanTime>;

struct ReproductionRow {
  std::string set, what;
  std::optional<int> tubes_left;  ///< Nothing: all attempts count.
  ReproductionCell paper;         ///< Its k is its printed percentage times its printed number.
  std::array<ReproductionCell, kReproductionProfiles.size()> ours;
  std::vector<std::string> apart;  ///< Profiles whose interval does not meet the paper's.
};

struct ReproductionTable {
  int number = 0;  ///< In the paper.
  std::string title;
  std::vector<ReproductionRow> rows;
};

/// Tables 3 to 9 of the paper beside ours. Success by truth.
struct Reproduction {
  std::int64_t seed = 0;
  int rounds = 0;
  std::vector<ReproductionTable> tables;
};

/// From the campaign of ReproductionToml. Throws Error(kBadData) when it has other variants.
Reproduction ReproductionOf(const CampaignResult& result);

/// {schema, seed, rounds, tables: [{table, title, rows: [{set, what, tubes_left, paper, leao2020,
/// best, apart}]}]}; cells are null, {k, n, wilson95, cluster95?} or {n, mean, sd, mean95}.
Json ToJson(const Reproduction& reproduction);
/// The tables in Markdown, three columns, and below them where they differ.
std::string ReproductionText(const Reproduction& reproduction);

}  // namespace tubetwin
