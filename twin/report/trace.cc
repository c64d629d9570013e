#include "twin/report/trace.h"

#include <algorithm>
#include <cmath>

#include "twin/report/chart.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

constexpr double kWidth = 420.0, kHeight = 120.0, kLeft = 30.0, kBottom = 20.0, kTop = 8.0;

/// All but one frame in a hundred on either side, in steps of half a newton.
std::pair<double, double> ForceRange(const Recording& recording, int from, int to) {
  std::vector<float> forces;
  for (int i = from; i < to; ++i) forces.push_back(recording.frames[i].force_N);
  std::sort(forces.begin(), forces.end());
  const auto quantile = [&](double share) {
    return static_cast<double>(forces[static_cast<std::size_t>(share * (forces.size() - 1))]);
  };
  const auto half = [](double x) { return 0.5 * x; };
  return {std::min(-0.5, half(std::floor(2.0 * quantile(0.01)))),
          std::max(1.5, half(std::ceil(2.0 * quantile(0.99))))};
}

std::string Tick(double x, double y, const char* anchor, const std::string& text) {
  return "<text class=\"tick small\" text-anchor=\"" + std::string(anchor) + "\" x=\"" +
         Fixed(x, 1) + "\" y=\"" + Fixed(y, 1) + "\">" + text + "</text>";
}

std::string GridLine(double x1, double y1, double x2, double y2) {
  return "<line class=\"grid\" x1=\"" + Fixed(x1, 1) + "\" y1=\"" + Fixed(y1, 1) + "\" x2=\"" +
         Fixed(x2, 1) + "\" y2=\"" + Fixed(y2, 1) + "\"/>";
}

/// Frames at which the weighing step was running, as a band.
std::string WeighingBands(const Recording& recording, int from, int to, double pixels_per_frame) {
  std::string out;
  const auto weighing = [&](int i) {
    const int caption = recording.frames[i].caption;
    return caption >= 0 && recording.captions[caption] == "weighing";
  };
  for (int i = from; i < to; ++i) {
    if (!weighing(i)) continue;
    int end = i;
    while (end < to && weighing(end)) ++end;
    out += "<rect class=\"band\" x=\"" + Fixed(kLeft + (i - from) * pixels_per_frame, 1) +
           "\" y=\"" + Fixed(kTop, 1) + "\" width=\"" + Fixed((end - i) * pixels_per_frame, 1) +
           "\" height=\"" + Fixed(kHeight - kBottom - kTop, 1) +
           "\"><title>weighing</title></rect>";
    i = end;
  }
  return out;
}

}  // namespace

std::string ForceTraceSvg(const Recording& recording, int from, int to,
                          std::optional<double> decided_s) {
  if (to - from < 2) return "";
  const auto [low, high] = ForceRange(recording, from, to);
  const double per_N = (kHeight - kBottom - kTop) / (high - low);
  const double per_frame = (kWidth - kLeft - 4.0) / (to - from);
  const auto y_of = [&, low = low, high = high](double force_N) {
    return kTop + (high - std::clamp(force_N, low, high)) * per_N;
  };
  std::string out = "<svg class=\"trace\" viewBox=\"0 0 " + Fixed(kWidth, 0) + " " +
                    Fixed(kHeight, 0) + "\" role=\"img\" aria-label=\"Load at the wrist\">" +
                    WeighingBands(recording, from, to, per_frame);
  const double step = std::max(0.5, NiceStep(high - low));
  for (double force = step * std::ceil(low / step); force <= high + 1e-9; force += step) {
    out += GridLine(kLeft, y_of(force), kWidth, y_of(force)) +
           Tick(kLeft - 5.0, y_of(force) + 3.5, "end", Fixed(force, step < 1.0 ? 1 : 0));
  }
  const double seconds = static_cast<double>(to - from) / Recording::kFramesPerSecond;
  const double every_s = NiceStep(seconds);
  for (double t = 0.0; t <= seconds; t += every_s) {
    out += Tick(kLeft + t * Recording::kFramesPerSecond * per_frame, kHeight - 6.0, "middle",
                Fixed(t, 0) + (t == 0.0 ? " s" : ""));
  }
  Polyline line;
  for (int i = from; i < to; ++i) {
    line.push_back({kLeft + (i - from) * per_frame, y_of(recording.frames[i].force_N), 0.0});
  }
  out += "<polyline class=\"force\" points=\"";
  for (const Vector3& p : Simplified(line, 0.25))
    out += Fixed(p.x(), 1) + "," + Fixed(p.y(), 1) + " ";
  out += "\"/>";
  if (decided_s) {
    const double frame = *decided_s * Recording::kFramesPerSecond;
    if (frame >= 0.0 && frame <= to - from) {
      const double x = kLeft + frame * per_frame;
      out += "<line class=\"decided\" x1=\"" + Fixed(x, 1) + "\" x2=\"" + Fixed(x, 1) + "\" y1=\"" +
             Fixed(kTop, 1) + "\" y2=\"" + Fixed(kHeight - kBottom, 1) +
             "\"><title>decided how many hang</title></line>";
    }
  }
  return out + "</svg>";
}

namespace {

constexpr double kPerMetre = 500.0;  // Of a plan, pixels.

std::string PlanLine(const std::string& css_class, const Polyline& line_N, const Bin& bin,
                     double width) {
  std::string out =
      "<polyline class=\"" + css_class + "\" stroke-width=\"" + Fixed(width, 1) + "\" points=\"";
  for (const Vector3& p : Simplified(line_N, 0.0005)) {
    out += Fixed(kPerMetre * (p.x() + bin.half_x_m() + Bin::kWallThickness_m), 1) + "," +
           Fixed(kPerMetre * (bin.half_y_m() + Bin::kWallThickness_m - p.y()), 1) + " ";
  }
  return out + "\"/>";
}

/// Thickness of the track's tubes, from their first capsule.
double TubeRadius(const CellTrack& track) {
  for (const CellTrack::Geom& geom : track.geoms) {
    if (geom.name.rfind("tube", 0) == 0) return geom.size_m[0];
  }
  return 0.01;
}

bool IsInView(const Polyline& line_N, const Bin& bin) {
  return std::any_of(line_N.begin(), line_N.end(), [&](const Vector3& p) {
    return std::abs(p.x()) < bin.half_x_m() + 0.05 && std::abs(p.y()) < bin.half_y_m() + 0.05;
  });
}

}  // namespace

std::string PlanViewSvg(const Recording& recording, const CellTrack& track, int sample,
                        const Recording::Overlay* overlay) {
  const Bin& bin = recording.bin;
  const double wall = kPerMetre * Bin::kWallThickness_m;
  const double width = kPerMetre * bin.size_m[0] + 2.0 * wall;
  const double height = kPerMetre * bin.size_m[1] + 2.0 * wall;
  std::string out =
      "<svg class=\"plan\" viewBox=\"0 0 " + Fixed(width, 1) + " " + Fixed(height, 1) +
      "\" role=\"img\" aria-label=\"The bin from above\"><rect class=\"wall\" width=\"" +
      Fixed(width, 1) + "\" height=\"" + Fixed(height, 1) + "\"/><rect class=\"floor\" x=\"" +
      Fixed(wall, 1) + "\" y=\"" + Fixed(wall, 1) + "\" width=\"" + Fixed(width - 2.0 * wall, 1) +
      "\" height=\"" + Fixed(height - 2.0 * wall, 1) + "\"/>";
  std::vector<Polyline> tubes_N;
  for (const Polyline& tube_B : TubesAt(track, sample)) {
    Polyline tube_N = Transformed(bin.X_BN.inverse(), tube_B);
    if (IsInView(tube_N, bin)) tubes_N.push_back(std::move(tube_N));
  }
  std::stable_sort(tubes_N.begin(), tubes_N.end(), [](const Polyline& a, const Polyline& b) {
    return CurveCentre(a).z() < CurveCentre(b).z();
  });
  const double thick = 2.0 * kPerMetre * TubeRadius(track);
  for (const Polyline& tube_N : tubes_N) {
    out += PlanLine("tube-edge", tube_N, bin, thick) + PlanLine("tube", tube_N, bin, thick - 2.0);
  }
  if (overlay != nullptr) {
    for (std::size_t i = 0; i < overlay->lines_N.size(); ++i) {
      const bool target = static_cast<int>(i) == overlay->target;
      out += PlanLine("class" + std::to_string(overlay->classes[i]), overlay->lines_N[i], bin,
                      target ? 5.0 : 2.0);
    }
  }
  return out + "</svg>";
}

}  // namespace tubetwin
