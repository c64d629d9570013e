// The inner loops of the first pass over a cloud: plain arrays and no branches, for the compiler's
// vector units. Compiled with -O3 and, so that comparisons become masks, without
// traps.

#include "perception/fragment/depth_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace tubetwin {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Floats = float __attribute__((vector_size(16)));
using Masks = int __attribute__((vector_size(16)));

Floats Load(const float* p) {
  Floats out;
  std::memcpy(&out, p, sizeof out);
  return out;
}

void Store(float* p, Floats value) { std::memcpy(p, &value, sizeof value); }

Floats Select(Masks mask, Floats value) {
  return reinterpret_cast<Floats>(mask & reinterpret_cast<Masks>(value));
}

/// Coordinates of four successive points.
struct FourPoints {
  Floats x, y, z;
};
FourPoints LoadPoints(const float* p) {
  const Floats a = Load(p), b = Load(p + 4), c = Load(p + 8);
  return {__builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 6), c, 0, 1, 2, 5),
          __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 7), c, 0, 1, 2, 6),
          __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 5, 5), c, 0, 1, 4, 7)};
}

constexpr int kLanes = 4;

}  // namespace

DepthBlocks::DepthBlocks(const ViewRaster& raster, const Foreground& foreground)
    : raster_(raster), foreground_(foreground) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R_NS_[3 * i + j] = static_cast<float>(raster.X_NS.linear()(i, j));
    p_NS_[i] = static_cast<float>(raster.X_NS.translation()[i]);
  }
  for (auto* plane : {&x_, &y_, &z_, &count_, &near_, &far_}) {
    plane->resize(static_cast<std::size_t>(raster.width));
  }
}

void DepthBlocks::SumPixels(int row) {
  const int width = raster_.width;
  float* x = x_.data();
  float* y = y_.data();
  float* z = z_.data();
  float* count = count_.data();
  float* near = near_.data();
  float* far = far_.data();
  std::fill_n(x, width, 0.0f);
  std::fill_n(y, width, 0.0f);
  std::fill_n(z, width, 0.0f);
  std::fill_n(count, width, 0.0f);
  std::fill_n(near, width, kInfinity);
  std::fill_n(far, width, 0.0f);
  const Floats nearest = kNearest_m - Floats{}, one = 1.0f - Floats{}, away = kInfinity - Floats{};
  for (int j = 0; j < raster_.block; ++j) {
    const float* p = raster_
                         .pixels_S()[static_cast<std::size_t>(row * raster_.block + j) *
                                     static_cast<std::size_t>(width)]
                         .data();
    int c = 0;
    for (; c + kLanes <= width; c += kLanes) {
      const FourPoints q = LoadPoints(p + 3 * c);
      const Masks valid = q.z >= nearest;
      Store(x + c, Load(x + c) + Select(valid, q.x));
      Store(y + c, Load(y + c) + Select(valid, q.y));
      Store(z + c, Load(z + c) + Select(valid, q.z));
      Store(count + c, Load(count + c) + Select(valid, one));
      const Floats low = Load(near + c), high = Load(far + c);
      const Floats z_or_away = valid ? q.z : away;
      Store(near + c, z_or_away < low ? z_or_away : low);
      Store(far + c, (q.z > high) & valid ? q.z : high);
    }
    for (; c < width; ++c) {
      const float* q = p + 3 * c;
      if (!(q[2] >= kNearest_m)) continue;
      x[c] += q[0];
      y[c] += q[1];
      z[c] += q[2];
      count[c] += 1.0f;
      near[c] = std::min(near[c], q[2]);
      far[c] = std::max(far[c], q[2]);
    }
  }
}

void DepthBlocks::MeanOfBlocks(BlockRow& out) {
  const int b = raster_.block, columns = raster_.block_columns();
  float* u = out.u.data() + kRowMargin;
  float* v = out.v.data() + kRowMargin;
  float* w = out.w.data() + kRowMargin;
  float* near = out.near.data() + kRowMargin;
  float* far = out.far.data() + kRowMargin;
  // Sums of the columns of each block, in place: block k's stand at k, which is never behind b k.
  for (int k = 0; b > 1 && k < columns; ++k) {
    float x = 0, y = 0, z = 0, n = 0, lowest = kInfinity, highest = 0;
    for (int i = b * k; i < b * (k + 1); ++i) {
      const auto at = static_cast<std::size_t>(i);
      x += x_[at];
      y += y_[at];
      z += z_[at];
      n += count_[at];
      lowest = std::min(lowest, near_[at]);
      highest = std::max(highest, far_[at]);
    }
    const auto at = static_cast<std::size_t>(k);
    x_[at] = x;
    y_[at] = y;
    z_[at] = z;
    count_[at] = n;
    near_[at] = lowest;
    far_[at] = highest;
  }
  std::copy_n(near_.data(), columns, near);
  std::copy_n(far_.data(), columns, far);
  const float *x = x_.data(), *y = y_.data(), *z = z_.data(), *n = count_.data();
  for (int k = 0; k < columns; ++k) {
    const float inverse = 1.0f / z[k];
    u[k] = x[k] * inverse;
    v[k] = y[k] * inverse;
    w[k] = far[k] - near[k] <= kEdgeDepth_m ? n[k] * inverse : kNaN;  // NaN without a return too.
  }
}

void DepthBlocks::KeepForeground(BlockRow& out) {
  const int columns = raster_.block_columns();
  float* u = out.u.data() + kRowMargin;
  float* v = out.v.data() + kRowMargin;
  float* w = out.w.data() + kRowMargin;
  const float r0 = R_NS_[0], r1 = R_NS_[1], r2 = R_NS_[2], r3 = R_NS_[3], r4 = R_NS_[4],
              r5 = R_NS_[5], r6 = R_NS_[6], r7 = R_NS_[7], r8 = R_NS_[8];
  const float px = p_NS_[0], py = p_NS_[1], pz = p_NS_[2];
  const Foreground foreground = foreground_;
  for (int c = 0; c < columns; ++c) {
    const float z = 1.0f / w[c];
    const float x_N = z * (r0 * u[c] + r1 * v[c] + r2) + px;
    const float y_N = z * (r3 * u[c] + r4 * v[c] + r5) + py;
    const float z_N = z * (r6 * u[c] + r7 * v[c] + r8) + pz;
    w[c] = foreground.Contains(x_N, y_N, z_N) ? w[c] : kNaN;
  }
  constexpr int kStep = 2 * kLanes;
  out.spans.clear();
  for (int c = 0; c < columns; c += kStep) {
    const Floats a = Load(w + c), b = Load(w + c + kLanes);  // The margin holds NaN.
    const Masks some = (a == a) | (b == b);
    std::uint64_t bits[2];
    std::memcpy(bits, &some, sizeof bits);
    if ((bits[0] | bits[1]) == 0) continue;
    if (!out.spans.empty() && out.spans.back().second == c) {
      out.spans.back().second = c + kStep;
    } else {
      out.spans.emplace_back(c, c + kStep);
    }
  }
}

void DepthBlocks::Fill(int row, BlockRow& out) {
  const auto size = static_cast<std::size_t>(raster_.block_columns() + 2 * kRowMargin);
  for (auto* plane : {&out.u, &out.v, &out.w}) plane->resize(size, kNaN);
  out.near.resize(size, kInfinity);
  out.far.resize(size, 0.0f);
  if (row < 0 || row >= raster_.block_rows()) {
    std::fill(out.w.begin(), out.w.end(), kNaN);
    out.spans.clear();
    return;
  }
  SumPixels(row);
  MeanOfBlocks(out);
  KeepForeground(out);
}

WindowPlanes FitWindows(const BlockRow* const* rows, int half, int column, float reach_m) {
  const int at = column + kRowMargin;
  const BlockRow& middle = *rows[half];
  const Floats u0 = Load(&middle.u[at]), v0 = Load(&middle.v[at]), w0 = Load(&middle.w[at]);
  const Floats limit = reach_m * w0 * w0;  // |d(1/z)| = |dz| / z^2.
  const Floats one = {1.0f, 1.0f, 1.0f, 1.0f};
  Floats n{}, su{}, sv{}, sw{}, suu{}, suv{}, svv{}, suw{}, svw{}, sww{};
  for (int j = 0; j <= 2 * half; ++j) {
    const float* u = rows[j]->u.data() + at;
    const float* v = rows[j]->v.data() + at;
    const float* w = rows[j]->w.data() + at;
    for (int i = -half; i <= half; ++i) {
      Floats dw = Load(w + i) - w0;
      const Masks in = (dw <= limit) & (-dw <= limit);  // False for NaN.
      const Floats du = Select(in, Load(u + i) - u0), dv = Select(in, Load(v + i) - v0);
      dw = Select(in, dw);
      n += Select(in, one);
      su += du;
      sv += dv;
      sw += dw;
      suu += du * du;
      suv += du * dv;
      svv += dv * dv;
      suw += du * dw;
      svw += dv * dw;
      sww += dw * dw;
    }
  }
  const Floats mu = su / n, mv = sv / n, mw = sw / n;
  suu -= su * mu;
  suv -= su * mv;
  svv -= sv * mv;
  suw -= su * mw;
  svw -= sv * mw;
  sww -= sw * mw;
  const Floats det = suu * svv - suv * suv, trace = suu + svv;
  const Floats a = (suw * svv - svw * suv) / det, b = (svw * suu - suw * suv) / det;
  const Floats c = w0 + mw - a * (u0 + mu) - b * (v0 + mv);
  const Floats variance = (sww - a * suw - b * svw) / n;
  const Floats roundness = 4.0f * det / (trace * trace);
  WindowPlanes out;
  std::memcpy(out.a, &a, sizeof a);
  std::memcpy(out.b, &b, sizeof b);
  std::memcpy(out.c, &c, sizeof c);
  std::memcpy(out.variance, &variance, sizeof variance);
  std::memcpy(out.count, &n, sizeof n);
  std::memcpy(out.roundness, &roundness, sizeof roundness);
  return out;
}

}  // namespace tubetwin
