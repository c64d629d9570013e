#pragma once

#include <string>

#include "models/base/parallel.h"
#include "models/part.h"
#include "perception/perceive.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin {

/// A bin with nothing, one tube or one foreign object in it, and how it is looked at: the cell's
/// own scan poses, small images of the twin's scanner with noise, one hand-eye error for all views.
struct BinCase {
  enum class Kind { kEmpty, kTube, kForeign };
  Kind kind = Kind::kEmpty;
  std::string what;  ///< "pvc_a straight in a corner", for reports.
  Bin bin;
  Part part;              ///< What perception is told to look for.
  ScanGeometry in_bin_N;  ///< Tube or object, frame N.
  double noise_scale = 1.0;
  RigidTransform X_SbelievedS = RigidTransform::Identity();
  std::uint64_t seed = 0;
};

/// Kinds of tube: flat anywhere, along a wall, in a corner, leaning on a wall, half out over the
/// rim, of every shipped part, straight or bent; bins of several sizes; noise 1 to 3 times; the
/// hand-eye error of design.md section 5. Same kind and seed, same case.
BinCase DrawBinCase(BinCase::Kind kind, std::uint64_t seed);

/// The clouds of a case, `width` pixels wide, with believed poses.
std::vector<OrganizedCloud> ScanBinCase(const BinCase& c, int width, Parallelism parallelism);

/// Empty when the scene is right about the case, else what is wrong: an empty bin is empty; a bin
/// with a tube is not; a foreign object is not empty, no tube, and unexplained.
std::string JudgeBinCase(const BinCase& c, const TubeScene& scene);

}  // namespace tubetwin
