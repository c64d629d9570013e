#include "twin/report/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <set>

#include "twin/report/text.h"

namespace tubetwin {
namespace {

std::string Short(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string Open(double width, double height, const std::string& css_class,
                 const std::string& label) {
  return "<svg class=\"" + css_class + "\" viewBox=\"0 0 " + Fixed(width, 0) + " " +
         Fixed(height, 0) + "\" role=\"img\" aria-label=\"" + Escaped(label) + "\">\n";
}

std::string Text(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text class=\"tick\" text-anchor=\"" + anchor + "\" x=\"" + Fixed(x, 1) + "\" y=\"" +
         Fixed(y, 1) + "\">" + Escaped(text) + "</text>\n";
}

std::string Line(const std::string& css_class, double x1, double y1, double x2, double y2) {
  return "<line class=\"" + css_class + "\" x1=\"" + Fixed(x1, 1) + "\" y1=\"" + Fixed(y1, 1) +
         "\" x2=\"" + Fixed(x2, 1) + "\" y2=\"" + Fixed(y2, 1) + "\"/>";
}

std::string Rect(const std::string& css_class, double x, double y, double width, double height,
                 const std::string& hint) {
  return "<rect class=\"" + css_class + "\" x=\"" + Fixed(x, 1) + "\" y=\"" + Fixed(y, 1) +
         "\" width=\"" + Fixed(width, 1) + "\" height=\"" + Fixed(height, 1) + "\"><title>" +
         Escaped(hint) + "</title></rect>\n";
}

/// Horizontal grid lines with their values.
std::string Grid(double left, double right, double step, double from, double to,
                 const std::function<double(double)>& y_of, const std::string& unit) {
  std::string out;
  const int ticks = static_cast<int>(std::lround((to - from) / step));
  for (int i = 0; i <= ticks; ++i) {
    const double y = y_of(from + i * step);
    out += Line("grid", left, y, right, y) +
           Text(left - 6.0, y + 4.0, "end", Short(from + i * step) + unit);
  }
  return out;
}

constexpr double kTrack = 1000.0;  ///< Width of a row's drawing, which is stretched to its place.

/// A row of bars: names and numbers are text beside it, which wraps and stays readable.
std::string TrackRow(const std::string& name, const std::string& rects, const std::string& told) {
  return "<div class=\"bar-row\"><div class=\"bar-name\">" + Escaped(name) +
         "</div><svg class=\"track\" viewBox=\"0 0 1000 10\" preserveAspectRatio=\"none\">" +
         rects + "</svg><div class=\"bar-told\">" + Escaped(told) + "</div></div>\n";
}

constexpr int kVariantColours = 6;

std::string VariantClass(std::size_t i) { return "variant" + std::to_string(i % kVariantColours); }

}  // namespace

double NiceStep(double top) {
  const double power = std::pow(10.0, std::floor(std::log10(top / 5.0)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * 5.0 >= top) return factor * power;
  }
  return 10.0 * power;
}

std::string TimeChartSvg(const std::vector<TimeBar>& attempts) {
  constexpr double kWidth = 900.0, kHeight = 250.0, kLeft = 46.0, kBottom = 28.0, kTop = 20.0;
  double longest = 0.0;
  for (const TimeBar& bar : attempts) {
    longest = std::max(longest, std::accumulate(bar.seconds.begin(), bar.seconds.end(), 0.0));
  }
  if (!(longest > 0.0)) return "";
  const double step = NiceStep(longest);
  const double top = step * std::ceil(longest / step);
  const auto y_of = [&](double s) {
    return kHeight - kBottom - s / top * (kHeight - kBottom - kTop);
  };
  const double pitch = (kWidth - kLeft) / static_cast<double>(attempts.size());
  const double width = std::min(0.7 * pitch, 60.0);
  // A number under every bar as long as they do not touch, then under every n-th.
  const std::size_t label_every = static_cast<std::size_t>(std::ceil(22.0 / pitch));

  std::string out = Open(kWidth, kHeight, "wide-chart", "Simulated seconds of each attempt") +
                    Grid(kLeft, kWidth, step, 0.0, top, y_of, "");
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const double centre = kLeft + (static_cast<double>(i) + 0.5) * pitch;
    double sum = 0.0;
    for (std::size_t part = 0; part < kTimeParts.size(); ++part) {
      const double seconds = std::max(0.0, attempts[i].seconds[part]);
      const double y = y_of(sum + seconds);
      out += Rect("part" + std::to_string(part), centre - 0.5 * width, y, width, y_of(sum) - y,
                  std::string(kTimeParts[part]) + " " + Fixed(attempts[i].seconds[part], 1) + " s");
      sum += seconds;
    }
    if (attempts[i].success == false) {
      out += "<text class=\"mark bad\" text-anchor=\"middle\" x=\"" + Fixed(centre, 1) + "\" y=\"" +
             Fixed(y_of(sum) - 5.0, 1) + "\">\xc3\x97</text>\n";
    }
    if (i % label_every == 0) {
      out += Text(centre, kHeight - kBottom + 18.0, "middle", std::to_string(i + 1));
    }
  }
  return out + "</svg>\n";
}

std::string IntervalChartSvg(const std::vector<IntervalSeries>& series,
                             const std::string& x_label) {
  constexpr double kWidth = 520.0, kHeight = 250.0, kLeft = 52.0, kBottom = 40.0, kTop = 10.0;
  std::set<int, std::greater<>> places;
  double lowest = 1.0;
  for (const IntervalSeries& one : series) {
    for (const IntervalPoint& point : one.points) {
      places.insert(point.x);
      lowest = std::min(lowest, point.low);
    }
  }
  if (places.empty()) return "";
  const double from = std::min(90.0, 10.0 * std::floor(10.0 * lowest + 1e-9));
  const double step = from < 50.0 ? 20.0 : 10.0;
  const double begin = step * std::floor(from / step);
  const auto y_of = [&](double percent) {
    return kTop + (100.0 - percent) / (100.0 - begin) * (kHeight - kBottom - kTop);
  };
  const double pitch = (kWidth - kLeft) / static_cast<double>(places.size());
  const double apart = std::min(14.0, 0.7 * pitch / static_cast<double>(series.size()));
  std::string out = Open(kWidth, kHeight, "chart-svg", "Success by " + x_label) +
                    Grid(kLeft, kWidth, step, begin, 100.0, y_of, " %");
  for (std::size_t s = 0; s < series.size(); ++s) {
    const double offset = (static_cast<double>(s) - 0.5 * (series.size() - 1)) * apart;
    for (const IntervalPoint& point : series[s].points) {
      const auto place = std::distance(places.begin(), places.find(point.x));
      const double x = kLeft + (static_cast<double>(place) + 0.5) * pitch + offset;
      out += "<g class=\"" + VariantClass(s) + "\"><title>" + Escaped(point.hint) + "</title>" +
             Line("whisker", x, y_of(100.0 * point.low), x, y_of(100.0 * point.high)) +
             "<circle cx=\"" + Fixed(x, 1) + "\" cy=\"" + Fixed(y_of(100.0 * point.share), 1) +
             "\" r=\"4\"/></g>\n";
    }
  }
  const std::size_t label_every = static_cast<std::size_t>(std::ceil(22.0 / pitch));
  std::size_t i = 0;
  for (const int place : places) {
    if (i % label_every == 0) {
      out += Text(kLeft + (static_cast<double>(i) + 0.5) * pitch, kHeight - kBottom + 17.0,
                  "middle", std::to_string(place));
    }
    ++i;
  }
  return out + Text(0.5 * (kLeft + kWidth), kHeight - 4.0, "middle", x_label) + "</svg>\n";
}

std::string IntervalMarkSvg(double share, double low, double high) {
  constexpr double kWidth = 160.0, kMiddle = 9.0;
  const auto x_of = [&](double value) { return 4.0 + value * (kWidth - 8.0); };
  return Open(kWidth, 18.0, "mark-svg", Fixed(100.0 * share, 1) + " %") +
         Line("grid", x_of(0.0), kMiddle, x_of(1.0), kMiddle) +
         Line("grid", x_of(0.5), 6.0, x_of(0.5), 12.0) +
         Line("grid", x_of(0.0), 4.0, x_of(0.0), 14.0) +
         Line("grid", x_of(1.0), 4.0, x_of(1.0), 14.0) + "<g class=\"variant0\">" +
         Line("whisker", x_of(low), kMiddle, x_of(high), kMiddle) + "<circle cx=\"" +
         Fixed(x_of(share), 1) + "\" cy=\"9\" r=\"4\"/></g></svg>";
}

std::string BarsHtml(const std::vector<BarRow>& rows, const std::vector<std::string>& classes,
                     const std::string& title) {
  double longest = 0.0;
  for (const BarRow& row : rows) {
    longest = std::max(longest, std::accumulate(row.segments.begin(), row.segments.end(), 0.0));
  }
  if (!(longest > 0.0)) return "";
  std::string out = "<div class=\"bars\" role=\"img\" aria-label=\"" + Escaped(title) + "\">\n";
  for (const BarRow& row : rows) {
    std::string rects;
    double x = 0.0;
    for (std::size_t k = 0; k < row.segments.size(); ++k) {
      const double width = std::max(0.0, row.segments[k]) / longest * kTrack;
      if (width <= 0.0) continue;
      rects += Rect(classes.at(k), x, 0.0, width, 10.0,
                    row.name + ": " + Short(std::round(100.0 * row.segments[k]) / 100.0));
      x += width;
    }
    out += TrackRow(row.name, rects, row.told);
  }
  return out + "</div>\n";
}

std::string GanttHtml(const std::vector<GanttRow>& rows, const std::string& title) {
  double end_s = 0.0;
  for (const GanttRow& row : rows) end_s = std::max(end_s, row.to_s);
  if (!(end_s > 0.0)) return "";
  std::string out =
      "<div class=\"bars gantt\" role=\"img\" aria-label=\"" + Escaped(title) + "\">\n";
  for (const GanttRow& row : rows) {
    const double x = row.from_s / end_s * kTrack;
    const double took_s = row.to_s - row.from_s;
    out +=
        TrackRow(row.name,
                 Rect(row.css_class, x, 0.0, std::max(2.0, took_s / end_s * kTrack), 10.0,
                      row.name + ": " + Fixed(row.from_s, 1) + " to " + Fixed(row.to_s, 1) + " s"),
                 Fixed(took_s, took_s < 0.95 ? 2 : 1) + " s");
  }
  return out + "</div>\n";
}

}  // namespace tubetwin
