#include "twin/render/scan/smooth_edges.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr int kContrast = 14;           // Of 255: less is no edge.
constexpr float kReach_px = 6.0f;       // Longest step along an edge.
constexpr float kReduce = 1.0f / 8.0f;  // Shortens the step where the neighbourhood is bright.

/// Brightness of every pixel, 0..255.
std::vector<std::uint8_t> Luma(const Image& image) {
  std::vector<std::uint8_t> luma(static_cast<std::size_t>(image.width) * image.height);
  for (std::size_t i = 0; i < luma.size(); ++i) {
    const std::uint8_t* p = &image.bgr[3 * i];
    luma[i] = static_cast<std::uint8_t>((29 * p[0] + 150 * p[1] + 77 * p[2]) >> 8);
  }
  return luma;
}

using Pixel = Eigen::Array3f;

/// Bilinear sample; coordinates in pixels, clamped to the picture.
Pixel Sample(const Image& image, float x, float y) {
  x = std::clamp(x, 0.0f, image.width - 1.001f);
  y = std::clamp(y, 0.0f, image.height - 1.001f);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float u = x - column, v = y - row;
  const std::uint8_t* p = &image.bgr[3 * (static_cast<std::size_t>(row) * image.width + column)];
  const std::uint8_t* q = p + 3 * static_cast<std::size_t>(image.width);
  Pixel out;
  for (int k = 0; k < 3; ++k) {
    out[k] = (1 - v) * ((1 - u) * p[k] + u * p[k + 3]) + v * ((1 - u) * q[k] + u * q[k + 3]);
  }
  return out;
}

float LumaOf(const Pixel& p) { return (29 * p[0] + 150 * p[1] + 77 * p[2]) / 256; }

}  // namespace

void SmoothEdges(Image& image) {
  const std::vector<std::uint8_t> luma = Luma(image);
  const Image source = image;
  const int width = image.width;
  for (int row = 1; row + 1 < image.height; ++row) {
    for (int column = 1; column + 1 < width; ++column) {
      const std::uint8_t* at = &luma[static_cast<std::size_t>(row) * width + column];
      const int nw = at[-width - 1], ne = at[-width + 1], sw = at[width - 1], se = at[width + 1];
      const int low = std::min({nw, ne, sw, se, static_cast<int>(*at)});
      const int high = std::max({nw, ne, sw, se, static_cast<int>(*at)});
      if (high - low < kContrast) continue;
      // Across the gradient, that is along the edge; longer the more axis-parallel the edge is.
      float dx = static_cast<float>((sw + se) - (nw + ne));
      float dy = static_cast<float>((nw + sw) - (ne + se));
      const float reduce = std::max((nw + ne + sw + se) * 0.25f * kReduce, 2.0f);
      const float scale = 1.0f / (std::min(std::abs(dx), std::abs(dy)) + reduce);
      dx = std::clamp(dx * scale, -kReach_px, kReach_px);
      dy = std::clamp(dy * scale, -kReach_px, kReach_px);
      auto along = [&](float t) { return Sample(source, column + t * dx, row + t * dy); };
      const Pixel near = 0.5f * (along(-1.0f / 6) + along(1.0f / 6));
      const Pixel far = 0.5f * near + 0.25f * (along(-0.5f) + along(0.5f));
      const float far_luma = LumaOf(far);
      const Pixel& out = far_luma < low || far_luma > high ? near : far;
      for (int k = 0; k < 3; ++k) {
        image.bgr[3 * (static_cast<std::size_t>(row) * width + column) + k] =
            static_cast<std::uint8_t>(std::lround(out[k]));
      }
    }
  }
}

}  // namespace tubetwin
