#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tubetwin {

/// Charts as inline SVG, so that they print and show without scripts. Colours come from the page's
/// style: classes grid, tick, part0 to part4, variant0 to variant5, good, bad. Texts are escaped
/// here.

/// What a cell's time is spent on, in the order of picks.jsonl's sim_s.
inline constexpr std::array<const char*, 4> kTimeParts = {"scan", "move", "weigh", "settle"};
using TimeParts = std::array<double, kTimeParts.size()>;

/// One attempt's bar: simulated seconds, and by truth whether it succeeded (nothing: unknown).
struct TimeBar {
  TimeParts seconds{};
  std::optional<bool> success;
};

/// Stacked bars of simulated seconds, one per attempt, with a mark over those that failed. Empty
/// when no attempt took time.
std::string TimeChartSvg(const std::vector<TimeBar>& attempts);

/// A share with its interval at a place on the x axis; all of [0, 1].
struct IntervalPoint {
  int x = 0;
  double share = 0.0, low = 0.0, high = 1.0;
  std::string hint;  ///< Shown where the mouse rests.
};
struct IntervalSeries {
  std::string name;
  std::vector<IntervalPoint> points;
};

/// Shares with intervals over whole numbers (`x_label`), largest left, series beside each other.
/// The axis begins at the multiple of 10 % below all intervals. Empty when there is no point.
std::string IntervalChartSvg(const std::vector<IntervalSeries>& series, const std::string& x_label);

/// A share on a line from 0 to 100 %, with its interval, for a row of a table.
std::string IntervalMarkSvg(double share, double low, double high);

/// Horizontal stacked bars of numbers >= 0 as HTML, one row each, with its whole name before and
/// what is told behind; segment i has the class `classes[i]`. Empty when all are 0.
struct BarRow {
  std::string name;
  std::vector<double> segments;
  std::string told;
};
std::string BarsHtml(const std::vector<BarRow>& rows, const std::vector<std::string>& classes,
                     const std::string& title);

/// What happens from when to when, seconds from the begin, as HTML with a row each. Empty when
/// nothing takes time.
struct GanttRow {
  std::string name;
  double from_s = 0.0, to_s = 0.0;
  std::string css_class;
};
std::string GanttHtml(const std::vector<GanttRow>& rows, const std::string& title);

/// The 1, 2 or 5 times a power of ten that gives at most five steps up to `top` > 0.
double NiceStep(double top);

}  // namespace tubetwin
