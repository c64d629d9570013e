#include "twin/campaign/report_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace tubetwin {
namespace {

std::string Fixed(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string Short(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// The 1, 2 or 5 times a power of ten that gives at most five steps up to `top`.
double NiceStep(double top) {
  const double power = std::pow(10.0, std::floor(std::log10(top / 5.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * 5.0 >= top) return factor * power;
  }
  return 10.0 * power;
}

constexpr double kWidth = 900.0;
constexpr double kHeight = 260.0;
constexpr double kLeft = 46.0;
constexpr double kBottom = 34.0;
constexpr double kTop = 12.0;

double HeightOf(double seconds, double top) { return seconds / top * (kHeight - kBottom - kTop); }

std::string Axis(double step, double top) {
  std::string out;
  const int ticks = static_cast<int>(std::lround(top / step));
  for (int i = 0; i <= ticks; ++i) {
    const double tick = i * step;
    const std::string y = Fixed(kHeight - kBottom - HeightOf(tick, top), 1);
    out += "<line class=\"grid\" x1=\"" + Fixed(kLeft, 0) + "\" x2=\"" + Fixed(kWidth, 0) +
           "\" y1=\"" + y + "\" y2=\"" + y + "\"/><text class=\"tick\" text-anchor=\"end\" x=\"" +
           Fixed(kLeft - 6.0, 0) + "\" y=\"" + y + "\" dy=\"4\">" + Short(tick) + "</text>\n";
  }
  return out;
}

}  // namespace

std::string TimeChartSvg(const std::vector<TimeParts>& attempts) {
  double longest = 0.0;
  for (const TimeParts& parts : attempts) {
    longest = std::max(longest, std::accumulate(parts.begin(), parts.end(), 0.0));
  }
  if (!(longest > 0.0)) return "";
  const double step = NiceStep(longest);
  const double top = step * std::ceil(longest / step);
  const double pitch = (kWidth - kLeft) / static_cast<double>(attempts.size());
  const double bar = std::min(0.7 * pitch, 60.0);
  // A number under every bar as long as they do not touch, then under every n-th.
  const std::size_t label_every = static_cast<std::size_t>(std::ceil(22.0 / pitch));

  std::string out = "<svg viewBox=\"0 0 " + Fixed(kWidth, 0) + " " + Fixed(kHeight, 0) +
                    "\" role=\"img\" aria-label=\"Simulated seconds of each attempt\">\n" +
                    Axis(step, top);
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const double centre = kLeft + (static_cast<double>(i) + 0.5) * pitch;
    double y = kHeight - kBottom;
    for (std::size_t part = 0; part < kTimeParts.size(); ++part) {
      const double height = HeightOf(std::max(0.0, attempts[i][part]), top);
      y -= height;
      out += "<rect class=\"part" + std::to_string(part) + "\" x=\"" +
             Fixed(centre - 0.5 * bar, 1) + "\" y=\"" + Fixed(y, 1) + "\" width=\"" +
             Fixed(bar, 1) + "\" height=\"" + Fixed(height, 1) + "\"><title>" + kTimeParts[part] +
             " " + Fixed(attempts[i][part], 1) + " s</title></rect>\n";
    }
    if (i % label_every == 0) {
      out += "<text class=\"tick\" text-anchor=\"middle\" x=\"" + Fixed(centre, 1) + "\" y=\"" +
             Fixed(kHeight - kBottom + 18.0, 0) + "\">" + std::to_string(i + 1) + "</text>\n";
    }
  }
  return out + "</svg>\n";
}

}  // namespace tubetwin
