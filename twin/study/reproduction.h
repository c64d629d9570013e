#pragma once

#include <string>

#include "models/base/json_fwd.h"
#include "twin/campaign/merge.h"

namespace tubetwin {

/// The campaign file of the 2020 paper's experiment (Leão et al., Appl. Sci. 10, 2264): sets A
/// (`pvc_a`) and B (`hose_b`), seven tubes, in profile leao2020 with one scan from 0.80 m over the
/// floor, then with the same seeds in profile best with eight views. `rounds` of each.
std::string ReproductionToml(std::int64_t seed, int rounds);

/// Tables 3 to 9 of the paper from the campaign of ReproductionToml: {schema, rounds, tables:
/// [{table, title, rows: [{set, what, tubes_left, paper, leao2020, best}]}]}. Shares are {k, n,
/// wilson95}, ours also with cluster95; the paper's k is its printed percentage times its printed
/// number. Times are {n, mean, sd, mean95}, the interval by Student's t. `tubes_left` is null where
/// all attempts count. Success by truth. `apart` names the profiles whose interval does not meet
/// the paper's. Throws Error(kBadData) when the campaign has other arms.
Json ReproductionTables(const CampaignResult& result);

/// The tables in Markdown, three columns, and below them where they differ.
std::string ReproductionText(const Json& tables);

}  // namespace tubetwin
