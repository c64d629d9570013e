#include "twin/render/tube_fit_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>

#include "models/base/error.h"
#include "twin/render/picture.h"
#include "twin/render/stage.h"

namespace tubetwin {
namespace {

// Blue green red.
const cv::Scalar kPaper(250, 250, 250), kInk(60, 50, 45), kFaint(215, 212, 208);
const cv::Scalar kAxis(20, 90, 235);
constexpr int kMargin = 40, kTitle = 56, kProfile = 190;
constexpr int kSubpixels = 4;  // Shift of OpenCV's fixed-point coordinates: 1/16 pixel.

cv::Point Fixed(double x, double y) {
  return {static_cast<int>(std::lround(x * (1 << kSubpixels))),
          static_cast<int>(std::lround(y * (1 << kSubpixels)))};
}

void Text(cv::Mat& image, const std::string& text, const cv::Point& at, double scale = 0.5) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, kInk, 1, cv::LINE_AA);
}

/// Columns: longest, middle and flattest direction of the samples.
Matrix3 PrincipalAxes(const std::vector<MeshPoint>& points) {
  Vector3 mean = Vector3::Zero();
  for (const MeshPoint& point : points) mean += point.p / static_cast<double>(points.size());
  Matrix3 spread = Matrix3::Zero();
  for (const MeshPoint& point : points) spread += (point.p - mean) * (point.p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(spread);
  Matrix3 axes;
  axes.col(0) = solver.eigenvectors().col(2);
  axes.col(1) = solver.eigenvectors().col(1);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// A view without perspective into a rectangle of the picture: x right, y up, z to the viewer.
struct Sheet {
  Matrix3 R;  ///< Columns x, y, z in the samples' frame.
  Vector3 middle;
  double pixels_per_m;
  cv::Point2d centre;
  Vector3 operator()(const Vector3& p) const {
    const Vector3 q = R.transpose() * (p - middle);
    return {centre.x + pixels_per_m * q.x(), centre.y - pixels_per_m * q.y(), q.z()};
  }
};

struct Extent {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
};

Extent ExtentAlong(const Matrix3& axes, const std::vector<MeshPoint>& points) {
  Extent extent;
  for (const MeshPoint& point : points) {
    const Vector3 q = axes.transpose() * point.p;
    extent.low = extent.low.cwiseMin(q);
    extent.high = extent.high.cwiseMax(q);
  }
  return extent;
}

void DrawSheet(cv::Mat& image, const Sheet& sheet, const TubeFitPicture& fit) {
  std::vector<std::pair<double, std::size_t>> far_first;
  for (std::size_t i = 0; i < fit.wall.size(); ++i) {
    far_first.emplace_back(sheet(fit.wall[i].p).z(), i);
  }
  std::sort(far_first.begin(), far_first.end());
  for (const auto& [depth, i] : far_first) {
    const MeshPoint& point = fit.wall[i];
    // Only what faces the viewer; lit from there, a little from the upper left.
    const double facing = point.n.dot(sheet.R.col(2));
    if (facing < 0.05) continue;
    const double light =
        std::clamp(0.75 * facing + 0.2 * point.n.dot(sheet.R.col(1) - sheet.R.col(0)), 0.0, 1.0);
    const double shade = 95.0 + 120.0 * light;
    const Vector3 at = sheet(point.p);
    cv::circle(image, Fixed(at.x(), at.y()), 20, {shade, shade - 8, shade - 18}, cv::FILLED,
               cv::LINE_AA, kSubpixels);
  }
  std::vector<cv::Point> curve;
  for (const Vector3& p : fit.line) curve.push_back(Fixed(sheet(p).x(), sheet(p).y()));
  cv::polylines(image, curve, false, kAxis, 2, cv::LINE_AA, kSubpixels);
  for (const Vector3& p : {fit.line.front(), fit.line.back()}) {
    cv::circle(image, Fixed(sheet(p).x(), sheet(p).y()), 5 << kSubpixels, kAxis, cv::FILLED,
               cv::LINE_AA, kSubpixels);
  }
}

/// Each sample's radius over its place along the axis, +-10 %.
void DrawProfile(cv::Mat& image, const TubeFitPicture& fit) {
  const double length_m = Length(fit.line);
  const cv::Rect box(kMargin + 50, image.rows - kProfile, image.cols - 2 * kMargin - 50,
                     kProfile - kMargin);
  constexpr double kRange = 0.10;
  const auto y_of = [&](double share) {
    return box.y + 0.5 * box.height * (1.0 - std::clamp(share, -kRange, kRange) / kRange);
  };
  for (const double share : {-kRange, 0.0, kRange}) {
    const int y = static_cast<int>(y_of(share));
    cv::line(image, {box.x, y}, {box.x + box.width, y}, share == 0.0 ? kAxis : kFaint, 1);
    char text[32];
    std::snprintf(text, sizeof text, "%.1f mm", 1e3 * fit.radius_m * (1.0 + share));
    Text(image, text, {kMargin - 24, y + 4}, 0.4);
  }
  for (const MeshPoint& point : fit.wall) {
    const ClosestOnLine foot = Closest(fit.line, point.p);
    if (foot.s_m <= 0.0 || foot.s_m >= length_m) continue;  // Askew cuts stand out.
    cv::circle(
        image,
        Fixed(box.x + foot.s_m / length_m * box.width, y_of(foot.distance_m / fit.radius_m - 1.0)),
        12, {150, 120, 90}, cv::FILLED, cv::LINE_AA, kSubpixels);
  }
  char text[64];
  std::snprintf(text, sizeof text, "radius along the axis, 0 to %.1f mm", 1e3 * length_m);
  Text(image, text, {box.x, image.rows - kMargin / 2 + 6}, 0.45);
}

void DrawScale(cv::Mat& image, double pixels_per_m) {
  const double bar_m = std::pow(10.0, std::floor(std::log10(250.0 / pixels_per_m)));
  const int pixels = static_cast<int>(std::lround(bar_m * pixels_per_m));
  const cv::Point right(image.cols - kMargin, kTitle - 14);
  cv::line(image, right - cv::Point(pixels, 0), right, kInk, 2);
  char text[32];
  std::snprintf(text, sizeof text, "%g mm", 1e3 * bar_m);
  Text(image, text, right - cv::Point(pixels, 8), 0.45);
}

}  // namespace

void DrawTubeFit(const TubeFitPicture& fit, const std::string& path) {
  TT_CHECK(fit.line.size() >= 2 && !fit.wall.empty());
  Image image{kPictureWidth, kPictureHeight, {}};
  image.bgr.resize(3u * kPictureWidth * kPictureHeight);
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.bgr.data());
  pixels.setTo(kPaper);
  const Matrix3 axes = PrincipalAxes(fit.wall);
  const Extent extent = ExtentAlong(axes, fit.wall);
  const Vector3 size = extent.high - extent.low;
  // Both views one above the other at one scale.
  constexpr double kGap = 24.0;
  const double width = image.width - 2.0 * kMargin;
  const double height = image.height - kTitle - kProfile - 2.0 * kGap;
  const double scale = std::min(width / size.x(), height / (size.y() + size.z()));
  const double spare = height - scale * (size.y() + size.z());
  const Vector3 middle = axes * (0.5 * (extent.low + extent.high));
  const double x = 0.5 * image.width, top = kTitle + 0.33 * spare;
  const Sheet front{axes, middle, scale, {x, top + 0.5 * scale * size.y()}};
  Matrix3 turned;  // The front view's z upwards.
  turned << axes.col(0), axes.col(2), -axes.col(1);
  const double below = top + scale * size.y() + kGap + 0.33 * spare;
  const Sheet side{turned, middle, scale, {x, below + 0.5 * scale * size.z()}};
  DrawSheet(pixels, front, fit);
  DrawSheet(pixels, side, fit);
  DrawProfile(pixels, fit);
  DrawScale(pixels, scale);
  Text(pixels, fit.title, {kMargin - 24, kTitle - 20}, 0.6);
  WritePng(image, path);
}

}  // namespace tubetwin
