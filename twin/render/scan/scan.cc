// The image formation, in this order per pixel (what each effect is: models/scanner_effects.h):
// 1. camera ray -> depth z, incidence, shape; projector ray -> lit or not (ray_scene.cc);
// 2. empty when nothing is hit, the projector's light does not get there, or z is out of range;
// 3. empty with the probability of range, incidence, weak signal and highlight together;
// 4. at depth edges empty, or a flying point between both depths, without label;
// 5. in valleys off by an interreflection; 6. bias; 7. correlated noise.
#include <algorithm>
#include <cmath>
#include <optional>

#include "models/base/error.h"
#include "twin/render/scan/depth_error.h"
#include "twin/render/scan/ray_scene.h"
#include "twin/render/scan/scan_geometry.h"
#include "twin/render/scan/valleys.h"

namespace tubetwin {
namespace {

constexpr int kBandRows = 8;  // Work unit of a thread: whole ray packets.
static_assert(kBandRows % HitImage::kPacketSide == 0);

constexpr float kGrazingHalf_deg = 75.0f, kGrazingWidth_deg = 3.0f;
constexpr float kGrazingFrom_deg = 45.0f;  // Below it the drop-out is under 0.005 %.
constexpr float kSteepestSigma_deg = 80.0f;
constexpr float kWeakHalf = 0.03f;            // Signal where half of the pixels are empty.
constexpr float kStrong = 10.0f * kWeakHalf;  // From it on the drop-out is under 0.01 %.
constexpr float kGlossWidth_deg = 4.0f;
constexpr float kEdgeJump_m = 0.003f;
constexpr float kEdgeEmpty = 0.3f, kEdgeMixed = 0.2f;
constexpr double kInterreflected = 0.02;  // Share of a valley's points.
constexpr double kInterreflection_m = 0.001;
constexpr double kBias_m = 0.00005, kBiasWavelength_m = 0.100;

/// Probability 1 / (1 + exp(x)).
float Logistic(float x) { return 1.0f / (1.0f + std::exp(x)); }
/// Uniform in (0, 1), 24 bits.
float UnitFloat(std::uint32_t bits) { return (static_cast<float>(bits >> 8) + 0.5f) * 0x1.0p-24f; }

float CosDeg(float angle_deg) { return std::cos(static_cast<float>(Radians(angle_deg))); }

/// What a shape's points look like.
struct Surface {
  float albedo, gloss;
  std::uint32_t label;
};

std::vector<Surface> SurfacesOf(const ScanGeometry& geometry) {
  std::vector<Surface> out;
  for (const auto& capsule : geometry.capsules) {
    out.push_back({capsule.albedo, capsule.gloss, capsule.label});
  }
  for (const auto& box : geometry.boxes) out.push_back({box.albedo, box.gloss, box.label});
  return out;
}

/// Rows of an image from the rays' hits. Immutable after construction; one instance for all
/// threads.
class Former {
 public:
  Former(const ScanGeometry& geometry, const RigidTransform& X_BS, const ScanSettings& settings,
         const RandomStream& stream, const Pinhole& pinhole, const HitImage& hits)
      : settings_(settings),
        effects_(settings.effects),
        stream_(stream),
        pixels_(stream.Fork("pixel")),
        pinhole_(pinhole),
        hits_(hits),
        surfaces_(SurfacesOf(geometry)),
        sweet_spot_m_(static_cast<float>(settings.spec.sweet_spot_m)),
        sigma_m_(static_cast<float>(settings.spec.sigma_m * settings.noise_scale)),
        far_half_m_(static_cast<float>(settings.spec.far_half_m)),
        far_width_m_(static_cast<float>(settings.spec.far_width_m)),
        near_half_m_(static_cast<float>(settings.spec.near_half_m)),
        near_width_m_(static_cast<float>(settings.spec.near_width_m)) {
    const ScannerSpec& spec = settings.spec;
    z_min_m_ = static_cast<float>(effects_.hard_range ? spec.range_min_m : spec.soft_min_m);
    z_max_m_ = static_cast<float>(effects_.hard_range ? spec.range_max_m : spec.soft_max_m);
    if (effects_.interreflections) valleys_.emplace(geometry, X_BS, pinhole, hits);
  }

  /// What the depth errors need to know of the whole image; before the first FormRow.
  void PrepareErrors(float nearest_m, float farthest_m, Parallelism parallelism) {
    if (effects_.noise) {
      noise_.emplace(stream_.Fork("depth"), pinhole_.width, pinhole_.height, parallelism);
    }
    if (effects_.bias) {
      // Around the rays' ends and the points that errors move, between the depths that are kept.
      constexpr float kMargin_m = 0.01f;
      const float low_z = std::max(nearest_m, z_min_m_) - kMargin_m;
      const float high_z = std::max(low_z, std::min(farthest_m, z_max_m_)) + kMargin_m;
      const Eigen::Vector3f low(pinhole_.x(0) * high_z, pinhole_.y(0) * high_z, low_z);
      const Eigen::Vector3f high(-low.x(), -low.y(), high_z);
      bias_.emplace(settings_.bias_seed, kBias_m, kBiasWavelength_m, low, high);
    }
  }

  /// Space of one thread.
  struct Scratch {
    std::vector<float> noise, low, high;
    std::vector<double> interreflected_m;
  };

  void FormRow(int row, Scratch& scratch, OrganizedCloud& cloud) const {
    scratch.noise.resize(pinhole_.width);
    if (noise_) noise_->Row(row, scratch.noise.data());
    if (effects_.flying_pixels) FindRange(row, scratch);
    FindInterreflections(row, scratch);
    for (int column = 0; column < pinhole_.width; ++column) {
      const std::size_t out = static_cast<std::size_t>(row) * pinhole_.width + column;
      const std::size_t at = hits_.Index(row, column);
      cloud.p_SP[out] = InvalidPoint();
      cloud.intensity[out] = 0;
      const float cos_projector = hits_.cos_projector[at];
      float z = hits_.z_m[at];
      if (!(cos_projector > 0) || z < z_min_m_ || z > z_max_m_) continue;
      const Surface& surface = surfaces_[hits_.shape[at]];
      const float gleam = Gleam(surface, at);
      // Chance is asked only where it decides something.
      const float keep = Keep(surface, at, gleam);
      const float jump = effects_.flying_pixels ? Jump(scratch, column, z) : 0.0f;
      bool mixed = false;
      if (keep < 1 || jump != 0) {
        const auto chance = pixels_.Block(out);
        if (UnitFloat(chance[0]) >= keep) continue;
        if (jump != 0) {
          const float u = UnitFloat(chance[1]);
          if (u < kEdgeEmpty) continue;
          mixed = u < kEdgeEmpty + kEdgeMixed;
          if (mixed) z += UnitFloat(chance[2]) * jump;
        }
      }
      float error_m = 0;
      if (!scratch.interreflected_m.empty() && !mixed) {
        error_m = static_cast<float>(scratch.interreflected_m[column]);
      }
      if (bias_) error_m += bias_->At({pinhole_.x(column) * z, pinhole_.y(row) * z, z});
      if (noise_) error_m += Sigma(at) * scratch.noise[column];
      z += error_m;
      cloud.p_SP[out] = {pinhole_.x(column) * z, pinhole_.y(row) * z, z};
      cloud.intensity[out] = std::min(1.0f, surface.albedo * cos_projector + gleam);
      if (settings_.labels) cloud.label[out] = mixed ? kLabelNone : surface.label;
    }
  }

 private:
  /// Brightness of the projector's mirror image.
  float Gleam(const Surface& surface, std::size_t at) const {
    const float cos_mirror = hits_.cos_mirror[at];
    if (!effects_.highlights || surface.gloss <= 0 || cos_mirror < cos_gleam_from_) return 0;
    // 1 - cos d is d^2 / 2 at these angles.
    return surface.gloss * std::exp((cos_mirror - 1.0f) * per_gloss_width2_);
  }

  /// Probability that the pixel is not lost to range, incidence, weak signal or highlight.
  float Keep(const Surface& surface, std::size_t at, float gleam) const {
    const float z = hits_.z_m[at], cos_projector = hits_.cos_projector[at];
    float keep = 1.0f - gleam;
    if (effects_.soft_range) {
      if (z > settings_.spec.range_max_m) {
        keep *= 1.0f - Logistic((far_half_m_ - z) / far_width_m_);
      } else if (z < settings_.spec.range_min_m) {
        keep *= 1.0f - Logistic((z - near_half_m_) / near_width_m_);
      }
    }
    const float steepest = std::min(hits_.cos_camera[at], cos_projector);
    if (effects_.incidence && steepest < cos_grazing_from_) {
      const auto angle_deg = static_cast<float>(Degrees(std::acos(steepest)));
      keep *= 1.0f - Logistic((kGrazingHalf_deg - angle_deg) / kGrazingWidth_deg);
    }
    if (effects_.weak_signal) {
      const float near = sweet_spot_m_ / z;
      const float signal = std::max(1e-6f, surface.albedo * cos_projector * near * near);
      if (signal < kStrong) {
        const float squared = (kWeakHalf / signal) * (kWeakHalf / signal);
        keep *= 1.0f - squared * squared / (1.0f + squared * squared);
      }
    }
    return keep;
  }

  float Sigma(std::size_t at) const {
    const float ratio = hits_.z_m[at] / sweet_spot_m_;
    return sigma_m_ * ratio * ratio / std::max(hits_.cos_camera[at], cos_steepest_);
  }

  /// Least and greatest depth among the hits of the three rows around each column.
  void FindRange(int row, Scratch& scratch) const {
    const int width = pinhole_.width;
    scratch.low.assign(width, 1e9f);
    scratch.high.assign(width, 0.0f);
    for (int r = std::max(0, row - 1); r <= std::min(pinhole_.height - 1, row + 1); ++r) {
      const float* z = &hits_.z_m[hits_.Index(r, 0)];
      for (int c = 0; c < width; ++c) {
        scratch.low[c] = std::min(scratch.low[c], z[c] > 0 ? z[c] : 1e9f);
        scratch.high[c] = std::max(scratch.high[c], z[c]);
      }
    }
  }

  /// Depth difference to the hit of the 3 x 3 around that jumps most; 0 when none jumps.
  float Jump(const Scratch& scratch, int column, float z) const {
    float low = z, high = z;
    const int last = std::min(pinhole_.width - 1, column + 1);
    for (int c = std::max(0, column - 1); c <= last; ++c) {
      low = std::min(low, scratch.low[c]);
      high = std::max(high, scratch.high[c]);
    }
    const float jump = high - z > z - low ? high - z : low - z;
    return std::abs(jump) > kEdgeJump_m ? jump : 0.0f;
  }

  /// Errors of the row's points that are interreflected, if any. Candidates are drawn by the gaps
  /// between them, so that chance is asked for the few that matter.
  void FindInterreflections(int row, Scratch& scratch) const {
    scratch.interreflected_m.clear();
    if (!valleys_) return;
    RandomStream chance = stream_.Fork("interreflection", static_cast<std::uint64_t>(row));
    static const double kPerLog = 1.0 / std::log(1.0 - kInterreflected);
    for (double column = -1;;) {
      column += 1 + std::floor(std::log(1.0 - chance.Uniform()) * kPerLog);
      if (!(column < pinhole_.width)) return;
      const double error_m = chance.Normal(0, kInterreflection_m);
      const int c = static_cast<int>(column);
      if (hits_.shape[hits_.Index(row, c)] < 0 || !valleys_->At(row, c)) continue;
      scratch.interreflected_m.resize(pinhole_.width, 0.0);
      scratch.interreflected_m[c] = error_m;
    }
  }

  const ScanSettings& settings_;
  const ScannerEffects& effects_;
  const RandomStream& stream_;
  const RandomStream pixels_;
  const Pinhole& pinhole_;
  const HitImage& hits_;
  const std::vector<Surface> surfaces_;
  const float sweet_spot_m_, sigma_m_;
  const float far_half_m_, far_width_m_, near_half_m_, near_width_m_;
  const float cos_steepest_ = CosDeg(kSteepestSigma_deg);
  const float cos_grazing_from_ = CosDeg(kGrazingFrom_deg);
  const float cos_gleam_from_ = CosDeg(4 * kGlossWidth_deg);
  const float per_gloss_width2_ =
      1.0f / static_cast<float>(Radians(kGlossWidth_deg) * Radians(kGlossWidth_deg));
  float z_min_m_ = 0, z_max_m_ = 0;
  std::optional<CorrelatedNoise> noise_;
  std::optional<BiasField> bias_;
  std::optional<ValleyFinder> valleys_;
};

/// Nearest and farthest depth of rows [first, last).
std::pair<float, float> DepthRange(const HitImage& hits, int first, int last) {
  float low = 1e9f, high = 0;
  for (std::size_t i = hits.Index(first, 0); i < hits.Index(last, 0); ++i) {
    low = std::min(low, hits.z_m[i] > 0 ? hits.z_m[i] : 1e9f);
    high = std::max(high, hits.z_m[i]);
  }
  return {low, high};
}

}  // namespace

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
  const auto end_of = [&](int band) { return std::min((band + 1) * kBandRows, pinhole.height); };

  HitImage hits(pinhole);
  const RayScene scene(geometry, X_BS, settings.spec);
  std::vector<std::pair<float, float>> depths(bands);
  ParallelFor(bands, parallelism, [&](int band, int) {
    scene.CastRows(pinhole, band * kBandRows, end_of(band), settings.effects.shadows, hits);
    depths[band] = DepthRange(hits, band * kBandRows, end_of(band));
  });
  std::pair<float, float> range = {1e9f, 0.0f};
  for (const auto& [low, high] : depths) {
    range = {std::min(range.first, low), std::max(range.second, high)};
  }

  OrganizedCloud cloud;
  cloud.width = pinhole.width;
  cloud.height = pinhole.height;
  cloud.p_SP.resize(pixels);
  cloud.intensity.resize(pixels);
  if (settings.labels) cloud.label.resize(pixels, kLabelNone);
  Former former(geometry, X_BS, settings, stream, pinhole, hits);
  former.PrepareErrors(range.first, range.second, parallelism);
  std::vector<Former::Scratch> scratch(std::max(1, parallelism.threads));
  ParallelFor(bands, parallelism, [&](int band, int worker) {
    for (int row = band * kBandRows; row < end_of(band); ++row) {
      former.FormRow(row, scratch[worker], cloud);
    }
  });
  return cloud;
}

}  // namespace tubetwin
