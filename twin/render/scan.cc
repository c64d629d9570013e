// The image formation, in this order per pixel (design.md section 5 and reference figures there):
// 1. camera ray -> depth z, incidence, shape; projector ray -> lit or not (ray_scene.cc);
// 2. empty when nothing is hit, the projector's light does not get there, or z is out of range;
// 3. with noise: empty with the probability of far, near and grazing drop-out;
// 4. at depth edges (a neighbour of 3 x 3 more than 3 mm nearer or farther): 30 % empty, 20 %
// mixed,
//    a flying point between both depths, without label;
// 5. depth error with sigma 0.05 mm (z / 442 mm)^2 / cos(incidence), correlated over 3 to 5 pixels.
#include <algorithm>
#include <cmath>

#include "hw_bridge/base/error.h"
#include "twin/render/ray_scene.h"
#include "twin/render/scan_geometry.h"

namespace tubetwin {
namespace {

constexpr int kBandRows = 8;  // Work unit of a thread; even, as ray packets are two rows high.

constexpr float kFarHalf_m = 0.900f, kFarWidth_m = 0.060f;
constexpr float kNearHalf_m = 0.340f, kNearWidth_m = 0.015f;
constexpr float kGrazingHalf_deg = 75.0f, kGrazingWidth_deg = 3.0f;
constexpr float kGrazingFrom_deg = 55.0f;  // Below it the drop-out would be under 0.2 %.
constexpr float kSteepestSigma_deg = 80.0f;
constexpr float kEdgeJump_m = 0.003f;
constexpr float kEdgeEmpty = 0.3f, kEdgeMixed = 0.2f;

// Binomial smoothing of white noise, one sigma 1 px: neighbours correlate by exp(-d^2 / 4), half at
// 1.7 px, so spots are 3 to 4 px wide. Divided by the root of its squared sum the variance stays 1.
constexpr float kSmooth[5] = {1, 4, 6, 4, 1};
constexpr float kSmoothNorm = 8.366600265f;  // sqrt(1 + 16 + 36 + 16 + 1)
constexpr int kSmoothReach = 2;

float Logistic(float x) { return 1.0f / (1.0f + std::exp(x)); }

/// Uniform in (0, 1), 24 bits.
float UnitFloat(std::uint32_t bits) { return (static_cast<float>(bits >> 8) + 0.5f) * 0x1.0p-24f; }

/// Row of white noise smoothed along the row. A row's numbers depend on stream and row only.
void NoiseRow(const RandomStream& stream, int row, int width, std::vector<float>& white,
              float* out) {
  RandomStream bits = stream.Fork("depth", static_cast<std::uint64_t>(row));
  white.resize(static_cast<std::size_t>(width) + 2 * kSmoothReach + 1);
  for (std::size_t i = 0; i + 1 < white.size(); i += 2) {  // Box-Muller, both numbers used.
    const float radius = std::sqrt(-2.0f * std::log(UnitFloat(bits.NextBits())));
    const float angle = static_cast<float>(2.0 * kPi) * UnitFloat(bits.NextBits());
    white[i] = radius * std::cos(angle);
    white[i + 1] = radius * std::sin(angle);
  }
  for (int c = 0; c < width; ++c) {
    float sum = 0;
    for (int k = 0; k < 5; ++k) sum += kSmooth[k] * white[c + k];
    out[c] = sum / kSmoothNorm;
  }
}

class Former {
 public:
  Former(const ScanGeometry& geometry, const ScanSettings& settings, const RandomStream& stream,
         const Pinhole& pinhole, const std::vector<RayHit>& hits, const std::vector<float>& noise)
      : geometry_(geometry),
        settings_(settings),
        stream_(stream),
        pinhole_(pinhole),
        hits_(hits),
        noise_(noise),
        cos_steepest_(std::cos(static_cast<float>(Radians(kSteepestSigma_deg)))),
        cos_grazing_from_(std::cos(static_cast<float>(Radians(kGrazingFrom_deg)))) {
    const ScannerSpec& spec = settings.spec;
    z_min_m_ = static_cast<float>(settings.hard_range ? spec.range_min_m : spec.soft_min_m);
    z_max_m_ = static_cast<float>(settings.hard_range ? spec.range_max_m : spec.soft_max_m);
  }

  void FormRow(int row, OrganizedCloud& cloud) const {
    RandomStream bits = stream_.Fork("pixel", static_cast<std::uint64_t>(row));
    for (int column = 0; column < pinhole_.width; ++column) {
      // Always the same four numbers per pixel, whatever the pixel sees.
      std::uint32_t word[4] = {};
      if (settings_.noise) {
        for (std::uint32_t& w : word) w = bits.NextBits();
      }
      const std::size_t i = static_cast<std::size_t>(row) * pinhole_.width + column;
      const RayHit& hit = hits_[i];
      cloud.p_SP[i] = InvalidPoint();
      if (hit.shape < 0 || hit.cos_projector <= 0 || hit.z_m < z_min_m_ || hit.z_m > z_max_m_) {
        continue;
      }
      float z = hit.z_m;
      bool mixed = false;
      if (settings_.noise) {
        if (UnitFloat(word[0]) < DropOut(hit)) continue;
        const float jump = LargestJump(row, column);
        if (jump != 0) {
          const float u = UnitFloat(word[1]);
          if (u < kEdgeEmpty) continue;
          mixed = u < kEdgeEmpty + kEdgeMixed;
          if (mixed) z += UnitFloat(word[2]) * jump;
        }
        z += Sigma(hit) * DepthNoise(row, column);
      }
      cloud.p_SP[i] = {pinhole_.x(column) * z, pinhole_.y(row) * z, z};
      const Surface surface = Of(hit.shape);
      cloud.intensity[i] = surface.albedo * hit.cos_projector;
      if (settings_.labels) cloud.label[i] = mixed ? kLabelNone : surface.label;
    }
  }

 private:
  struct Surface {
    float albedo;
    std::uint32_t label;
  };
  Surface Of(int shape) const {
    const auto capsules = static_cast<int>(geometry_.capsules.size());
    if (shape < capsules)
      return {geometry_.capsules[shape].albedo, geometry_.capsules[shape].label};
    const ScanGeometry::Box& box = geometry_.boxes[shape - capsules];
    return {box.albedo, box.label};
  }

  /// Probability that the pixel stays empty: too far, too near, too steep for camera or projector.
  float DropOut(const RayHit& hit) const {
    const ScannerSpec& spec = settings_.spec;
    float keep = 1.0f;
    if (hit.z_m > spec.range_max_m) keep *= 1.0f - Logistic((kFarHalf_m - hit.z_m) / kFarWidth_m);
    if (hit.z_m < spec.range_min_m) {
      keep *= 1.0f - Logistic((hit.z_m - kNearHalf_m) / kNearWidth_m);
    }
    const float steepest = std::min(hit.cos_camera, hit.cos_projector);
    if (steepest < cos_grazing_from_) {
      const auto angle_deg = static_cast<float>(Degrees(std::acos(steepest)));
      keep *= 1.0f - Logistic((kGrazingHalf_deg - angle_deg) / kGrazingWidth_deg);
    }
    return 1.0f - keep;
  }

  float Sigma(const RayHit& hit) const {
    const ScannerSpec& spec = settings_.spec;
    const float ratio = hit.z_m / static_cast<float>(spec.sweet_spot_m);
    return static_cast<float>(spec.sigma_m * settings_.noise_scale) * ratio * ratio /
           std::max(hit.cos_camera, cos_steepest_);
  }

  /// Depth difference to the neighbour that jumps most; 0 when none jumps.
  float LargestJump(int row, int column) const {
    const float z = hits_[static_cast<std::size_t>(row) * pinhole_.width + column].z_m;
    float largest = 0;
    for (int r = std::max(0, row - 1); r <= std::min(pinhole_.height - 1, row + 1); ++r) {
      const RayHit* line = &hits_[static_cast<std::size_t>(r) * pinhole_.width];
      for (int c = std::max(0, column - 1); c <= std::min(pinhole_.width - 1, column + 1); ++c) {
        if (line[c].shape < 0) continue;
        const float jump = line[c].z_m - z;
        if (std::abs(jump) > kEdgeJump_m && std::abs(jump) > std::abs(largest)) largest = jump;
      }
    }
    return largest;
  }

  /// Unit-variance error: the rows of `noise_` smoothed down the columns. Row r of the image is row
  /// r + kSmoothReach of the noise.
  float DepthNoise(int row, int column) const {
    float sum = 0;
    for (int k = 0; k < 5; ++k) {
      sum += kSmooth[k] * noise_[static_cast<std::size_t>(row + k) * pinhole_.width + column];
    }
    return sum / kSmoothNorm;
  }

  const ScanGeometry& geometry_;
  const ScanSettings& settings_;
  const RandomStream& stream_;
  const Pinhole& pinhole_;
  const std::vector<RayHit>& hits_;
  const std::vector<float>& noise_;
  float cos_steepest_, cos_grazing_from_;
  float z_min_m_ = 0, z_max_m_ = 0;
};

}  // namespace

RigidTransform ProjectorPose(const ScannerSpec& spec) {
  const double toe_in = Radians(spec.toe_in_deg);
  // The baseline is tilted against the camera's x by the camera's own toe-in.
  const Vector3 p_SP = spec.baseline_m * Vector3(std::cos(toe_in), 0, std::sin(toe_in));
  return MakeTransform(RotY(-2.0 * toe_in), p_SP);
}

OrganizedCloud CastScan(const ScanGeometry& geometry, const RigidTransform& X_BS,
                        const ScanSettings& settings, RandomStream stream,
                        Parallelism parallelism) {
  TT_CHECK(settings.width > 0 && settings.height > 0);
  Pinhole pinhole;
  pinhole.width = settings.width;
  pinhole.height = settings.height;
  pinhole.focal_px =
      static_cast<float>(settings.spec.focal_px * settings.width / settings.spec.full_width);
  const std::size_t pixels = static_cast<std::size_t>(pinhole.width) * pinhole.height;
  const int bands = (pinhole.height + kBandRows - 1) / kBandRows;

  std::vector<RayHit> hits(pixels);
  const RayScene scene(geometry, X_BS, settings.spec);
  ParallelFor(bands, parallelism, [&](int band, int) {
    const int first = band * kBandRows;
    scene.CastRows(pinhole, first, std::min(first + kBandRows, pinhole.height), hits);
  });

  std::vector<float> noise;
  if (settings.noise) {
    const int rows = pinhole.height + 2 * kSmoothReach;
    noise.resize(static_cast<std::size_t>(rows) * pinhole.width);
    ParallelFor(bands + 1, parallelism, [&](int band, int) {
      std::vector<float> white;
      for (int row = band * kBandRows; row < std::min((band + 1) * kBandRows, rows); ++row) {
        NoiseRow(stream, row, pinhole.width, white,
                 &noise[static_cast<std::size_t>(row) * pinhole.width]);
      }
    });
  }

  OrganizedCloud cloud;
  cloud.width = pinhole.width;
  cloud.height = pinhole.height;
  cloud.p_SP.resize(pixels);
  cloud.intensity.resize(pixels);
  if (settings.labels) cloud.label.resize(pixels, kLabelNone);
  const Former former(geometry, settings, stream, pinhole, hits, noise);
  ParallelFor(bands, parallelism, [&](int band, int) {
    const int first = band * kBandRows;
    for (int row = first; row < std::min(first + kBandRows, pinhole.height); ++row) {
      former.FormRow(row, cloud);
    }
  });
  return cloud;
}

}  // namespace tubetwin
