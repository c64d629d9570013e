#pragma once

#include <array>
#include <string>
#include <vector>

namespace tubetwin {

/// What a cell's time is spent on, in the order of picks.jsonl's sim_s.
inline constexpr std::array<const char*, 4> kTimeParts = {"scan", "move", "weigh", "settle"};
using TimeParts = std::array<double, kTimeParts.size()>;

/// Stacked bars of simulated seconds, one bar per attempt, as an inline SVG that takes its colours
/// from the page's CSS classes "part0" to "part3". Empty when there is no attempt.
std::string TimeChartSvg(const std::vector<TimeParts>& attempts);

}  // namespace tubetwin
