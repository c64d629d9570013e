#pragma once

#include <cstdint>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/base/parallel.h"
#include "models/base/random.h"
#include "models/scanner_effects.h"
#include "models/scanner_spec.h"

namespace tubetwin {

/// Share of the projector's light that bin, tray, arm and gripper scatter back.
inline constexpr float kCellAlbedo = 0.45f;

/// What rays can hit: exact shapes, frame B, each with the label that its points get.
struct ScanGeometry {
  struct Capsule {
    Vector3 a, b;
    double radius_m;
    std::uint32_t label;
    float albedo;     ///< 0..1, share of the light that is scattered back.
    float gloss = 0;  ///< 0..1, see ScannerEffects::highlights.
  };
  struct Box {
    RigidTransform X_BBox;
    Vector3 half_m;
    std::uint32_t label;
    float albedo;
    float gloss = 0;
  };
  std::vector<Capsule> capsules;
  std::vector<Box> boxes;
};

struct ScanSettings {
  int width = 0, height = 0;
  ScannerSpec spec;
  ScannerEffects effects;
  double noise_scale = 1.0;     ///< Of ScannerEffects::noise.
  std::uint64_t bias_seed = 1;  ///< Which scanner it is: decides ScannerEffects::bias.
  bool labels = false;
};

/// One scan by ray casting (Embree) with the effects that the settings ask for (order of the image
/// formation at the top of scan.cc). `X_BS` is the true pose; the result's X_NS is left to the
/// caller. Intensity is albedo times the cosine of the projector's incidence, plus the highlight,
/// at most 1. Random numbers depend on stream and pixel only: the same cloud for any thread count.
/// Throws Error(kInternal) when Embree fails.
OrganizedCloud CastScan(const ScanGeometry& geometry, const RigidTransform& X_BS,
                        const ScanSettings& settings, RandomStream stream, Parallelism parallelism);

}  // namespace tubetwin
