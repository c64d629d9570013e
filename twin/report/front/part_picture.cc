#include "twin/report/front/part_picture.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "twin/report/chart.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

constexpr double kWidth = 360.0;  ///< Of the part's picture, pixels.
constexpr double kMargin = 6.0;
constexpr double kMeasure = 26.0;  ///< Height of the line with the measure.

/// The shape with its main extent along x and the next one along y, its box from (0, 0) on.
Polyline LaidOut(const Polyline& line) {
  const Polyline even = ResampleCount(line, 60);
  const Vector3 centre = CurveCentre(even);
  Matrix3 spread = Matrix3::Zero();
  for (const Vector3& p : even) spread += (p - centre) * (p - centre).transpose();
  // Eigenvalues come in increasing order: the last direction is the longest.
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(spread);
  Polyline out;
  for (const Vector3& p : line) {
    const Vector3 local = axes.eigenvectors().transpose() * (p - centre);
    out.push_back({local.z(), local.y(), 0.0});
  }
  // Eigenvectors have no sign of their own: from left to right, and the ends below the bow.
  const Vector3 ends = out.front() + out.back();
  const double flip_x = out.front().x() > out.back().x() ? -1.0 : 1.0;
  const double flip_y = ends.y() < 0.0 ? -1.0 : 1.0;
  Vector3 low = Vector3::Constant(1e9);
  for (Vector3& p : out) {
    p = Vector3(flip_x * p.x(), flip_y * p.y(), 0.0);
    low = low.cwiseMin(p);
  }
  for (Vector3& p : out) p -= low;
  return out;
}

Vector3 SizeOf(const Polyline& line) {
  Vector3 high = Vector3::Zero();
  for (const Vector3& p : line) high = high.cwiseMax(p);
  return high;
}

std::string PolylineSvg(const std::string& css_class, const Polyline& line, double scale,
                        double width, const Vector3& offset) {
  std::string out =
      "<polyline class=\"" + css_class + "\" stroke-width=\"" + Fixed(width, 1) + "\" points=\"";
  for (const Vector3& p : Simplified(line, 0.0005)) {
    out += Fixed(offset.x() + scale * p.x(), 1) + "," + Fixed(offset.y() + scale * p.y(), 1) + " ";
  }
  return out + "\"/>";
}

std::string Head(double width, double height, const std::string& label) {
  return "<svg class=\"plan part-picture\" viewBox=\"0 0 " + Fixed(width, 0) + " " +
         Fixed(height, 0) + "\" role=\"img\" aria-label=\"" + Escaped(label) + "\">";
}

/// A bar of round length with its name.
std::string MeasureSvg(double longest_m, double scale, double y) {
  const double step_m = NiceStep(1.2 * longest_m);  // A fifth to a half of the longest.
  const double end = kMargin + scale * step_m;
  return "<line class=\"measure\" x1=\"" + Fixed(kMargin, 1) + "\" x2=\"" + Fixed(end, 1) +
         "\" y1=\"" + Fixed(y, 1) + "\" y2=\"" + Fixed(y, 1) + "\"/><text class=\"tick\" x=\"" +
         Fixed(end + 6.0, 1) + "\" y=\"" + Fixed(y + 4.0, 1) + "\">" + Fixed(1e3 * step_m, 0) +
         " mm</text>";
}

}  // namespace

std::string PartPictureSvg(const std::vector<Polyline>& shapes, double radius_m) {
  std::vector<Polyline> laid;
  double longest_m = 0.0;
  for (const Polyline& shape : shapes) {
    if (shape.size() < 2 || !(Length(shape) > 0.0)) continue;
    laid.push_back(LaidOut(shape));
    longest_m = std::max(longest_m, SizeOf(laid.back()).x());
  }
  if (laid.empty() || !(longest_m > 0.0)) return "";
  const double scale = (kWidth - 2.0 * kMargin) / (longest_m + 2.0 * radius_m);
  const double reach = scale * radius_m;
  double y = kMargin;
  std::string lines;
  for (const Polyline& line : laid) {
    const Vector3 offset(kMargin + reach, y + reach, 0.0);
    lines += PolylineSvg("tube-edge", line, scale, 2.0 * reach, offset) +
             PolylineSvg("tube", line, scale, std::max(1.0, 2.0 * reach - 2.0), offset);
    y += scale * SizeOf(line).y() + 2.0 * reach + 10.0;
  }
  return Head(kWidth, y + kMeasure, "The part") + lines +
         MeasureSvg(longest_m, scale, y + 0.5 * kMeasure) + "</svg>\n";
}

namespace {

/// The bin from above; what is drawn into it comes from frame N by InBin().
struct BinPicture {
  explicit BinPicture(const Bin& bin)
      : corner(bin.half_x_m() + Bin::kWallThickness_m, bin.half_y_m() + Bin::kWallThickness_m, 0.0),
        scale(0.5 * kWidth / corner.x()) {}
  double height() const { return 2.0 * scale * corner.y(); }
  Vector3 InBin(const Vector3& p_N) const {
    return {p_N.x() + corner.x(), corner.y() - p_N.y(), 0.0};
  }
  Polyline InBin(const Polyline& line_N) const {
    Polyline out;
    for (const Vector3& p_N : line_N) out.push_back(InBin(p_N));
    return out;
  }
  std::string Box(const std::string& label) const {
    const auto rect = [&](const char* css_class, double inset) {
      return "<rect class=\"" + std::string(css_class) + "\" x=\"" + Fixed(inset, 1) + "\" y=\"" +
             Fixed(inset, 1) + "\" width=\"" + Fixed(kWidth - 2.0 * inset, 1) + "\" height=\"" +
             Fixed(height() - 2.0 * inset, 1) + "\"/>";
    };
    return Head(kWidth, height(), label) + rect("wall", 0.0) +
           rect("floor", scale * Bin::kWallThickness_m);
  }
  Vector3 corner;
  double scale;  ///< Pixels per metre.
};

}  // namespace

std::string PilePictureSvg(const std::vector<Polyline>& tubes_N, double radius_m, const Bin& bin) {
  if (tubes_N.empty()) return "";
  std::vector<Polyline> ordered = tubes_N;
  std::stable_sort(ordered.begin(), ordered.end(), [](const Polyline& a, const Polyline& b) {
    return CurveCentre(a).z() < CurveCentre(b).z();
  });
  const BinPicture picture(bin);
  const double width = 2.0 * picture.scale * radius_m;
  std::string out = picture.Box("One bin at the start, from above");
  for (const Polyline& line_N : ordered) {
    const Polyline line = picture.InBin(line_N);
    out += PolylineSvg("tube-edge", line, picture.scale, width, Vector3::Zero()) +
           PolylineSvg("tube", line, picture.scale, std::max(1.0, width - 2.0), Vector3::Zero());
  }
  return out + "</svg>\n";
}

std::string SeenPictureSvg(const std::vector<SeenTube>& tubes, const std::optional<Vector3>& p_NG,
                           const Bin& bin) {
  const BinPicture picture(bin);
  std::string out = picture.Box("What was seen in the bin, from above");
  for (const SeenTube& tube : tubes) {
    out += PolylineSvg("class" + std::to_string(tube.tube_class), picture.InBin(tube.line_N),
                       picture.scale, tube.is_target ? 6.0 : 3.0, Vector3::Zero());
  }
  if (p_NG) {
    const Vector3 at = picture.scale * picture.InBin(*p_NG);
    out += "<circle class=\"grasp\" cx=\"" + Fixed(at.x(), 1) + "\" cy=\"" + Fixed(at.y(), 1) +
           "\" r=\"9\"/>";
  }
  return out + "</svg>\n";
}

}  // namespace tubetwin
