#include "twin/render/film_panels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <opencv2/imgproc.hpp>

namespace tubetwin {
namespace {

constexpr int kMargin = 24;
constexpr double kTraceSeconds = 10.0;
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
const cv::Scalar kInk(245, 245, 245);
const cv::Scalar kFaint(165, 160, 155);

cv::Scalar Bgr(const Colour& colour) {
  return {255.0 * colour[2], 255.0 * colour[1], 255.0 * colour[0]};
}

/// Darkens a panel so that light text reads on any picture.
void Shade(cv::Mat& image, const cv::Rect& panel) {
  constexpr double kKept = 0.35;
  const cv::Rect inside = panel & cv::Rect(0, 0, image.cols, image.rows);
  cv::Mat part = image(inside);
  part.convertTo(part, -1, kKept, 12);
}

void Text(cv::Mat& image, const std::string& text, const cv::Point& at, double scale,
          const cv::Scalar& colour) {
  cv::putText(image, text, at, kFont, scale, colour, 1, cv::LINE_AA);
}

int TextWidth(const std::string& text, double scale) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, scale, 1, &baseline).width;
}

void DrawCaption(cv::Mat& image, const std::string& caption, double time_s) {
  char clock[32];
  std::snprintf(clock, sizeof clock, "%5.1f s", time_s);
  Shade(image, {0, 0, image.cols, 48});
  Text(image, caption, {kMargin, 32}, 0.75, kInk);
  Text(image, clock, {image.cols - kMargin - TextWidth(clock, 0.75), 32}, 0.75, kInk);
}

void DrawLegend(cv::Mat& image) {
  const struct {
    const char* name;
    Colour colour;
  } entries[] = {{"free", ClassColour(0)},
                 {"weak", ClassColour(1)},
                 {"strong", ClassColour(2)},
                 {"chosen", kTargetColour}};
  constexpr int kRow = 24;
  const cv::Rect panel(kMargin, image.rows - kMargin - 4 * kRow - 36, 150, 4 * kRow + 36);
  Shade(image, panel);
  Text(image, "perceived", {panel.x + 12, panel.y + 22}, 0.5, kFaint);
  int y = panel.y + 22 + kRow;
  for (const auto& entry : entries) {
    cv::line(image, {panel.x + 14, y - 5}, {panel.x + 50, y - 5}, Bgr(entry.colour),
             entry.colour == kTargetColour ? 5 : 3, cv::LINE_AA);
    Text(image, entry.name, {panel.x + 64, y}, 0.5, kInk);
    y += kRow;
  }
}

/// Range of the force axis: fixed for the whole recording, wide enough for all but rare knocks.
std::pair<double, double> ForceRange(const Recording& recording) {
  std::vector<float> forces;
  for (const Recording::Frame& frame : recording.frames) forces.push_back(frame.force_N);
  auto quantile = [&](double share) {
    const auto at = forces.begin() + static_cast<std::ptrdiff_t>(share * (forces.size() - 1));
    std::nth_element(forces.begin(), at, forces.end());
    return static_cast<double>(*at);
  };
  constexpr double kRareShare = 0.01;
  const double low = std::min(-0.5, std::floor(quantile(kRareShare)));
  const double high = std::max(2.0, std::ceil(quantile(1.0 - kRareShare)));
  return {low, high};
}

void DrawTrace(cv::Mat& image, const Recording& recording, int frame) {
  const cv::Rect panel(image.cols - kMargin - 400, image.rows - kMargin - 150, 400, 150);
  Shade(image, panel);
  char value[48];
  std::snprintf(value, sizeof value, "%+.2f N", recording.frames[frame].force_N);
  Text(image, "load below the sensor", {panel.x + 12, panel.y + 22}, 0.5, kFaint);
  Text(image, value, {panel.x + panel.width - 12 - TextWidth(value, 0.6), panel.y + 23}, 0.6, kInk);

  const cv::Rect plot(panel.x + 40, panel.y + 36, panel.width - 52, panel.height - 50);
  const auto [low, high] = ForceRange(recording);
  const double pixels_per_N = plot.height / (high - low);
  auto y_of = [&, low = low, high = high](double force_N) {
    return plot.y + (high - std::clamp(force_N, low, high)) * pixels_per_N;
  };
  // Lines at whole newtons, at most five of them.
  const double step = std::max(1.0, std::ceil((high - low) / 5.0));
  for (double force = std::ceil(low / step) * step; force <= high; force += step) {
    const int y = static_cast<int>(std::lround(y_of(force)));
    cv::line(image, {plot.x, y}, {plot.x + plot.width, y}, force == 0 ? kFaint : kFaint * 0.55, 1);
    const std::string label = std::to_string(static_cast<int>(force));
    Text(image, label, {plot.x - 8 - TextWidth(label, 0.4), y + 5}, 0.4, kFaint);
  }
  const int window = static_cast<int>(kTraceSeconds * Recording::kFramesPerSecond);
  constexpr int kSubpixelBits = 4;
  std::vector<cv::Point> line;
  for (int i = std::max(0, frame - window); i <= frame; ++i) {
    const double x = plot.x + plot.width * (1.0 - static_cast<double>(frame - i) / window);
    const double y = y_of(recording.frames[i].force_N);
    line.emplace_back(static_cast<int>(std::lround(x * (1 << kSubpixelBits))),
                      static_cast<int>(std::lround(y * (1 << kSubpixelBits))));
  }
  cv::polylines(image, line, false, {120, 215, 255}, 2, cv::LINE_AA, kSubpixelBits);
}

}  // namespace

Colour ClassColour(int tube_class) {
  switch (tube_class) {
    case 0:
      return {0.16f, 0.76f, 0.32f};
    case 1:
      return {1.00f, 0.78f, 0.08f};
    default:
      return {0.93f, 0.20f, 0.16f};
  }
}

void DrawPanels(const Recording& recording, int frame, Image& image) {
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.bgr.data());
  const Recording::Frame& now = recording.frames[frame];
  DrawCaption(pixels, now.caption < 0 ? std::string() : recording.captions[now.caption],
              static_cast<double>(frame) / Recording::kFramesPerSecond);
  DrawLegend(pixels);
  DrawTrace(pixels, recording, frame);
}

}  // namespace tubetwin
