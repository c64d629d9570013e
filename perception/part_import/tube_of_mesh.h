#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/parallel.h"
#include "models/base/polyline.h"
#include "models/mesh/mesh.h"

namespace tubetwin {

/// What a mesh is, seen as a tube.
enum class MeshVerdict {
  kTube,
  kSeveralBodies,  ///< Pieces that do not lie within the tube.
  kNotRound,       ///< Little of the surface is round.
  kNoAxis,         ///< Round, but about a point or about nothing long.
  kBranches,
  kClosed,  ///< A ring.
  kRadiusSpread,
  kOtherSurface,  ///< A flange, a hook: surface beyond the tube's.
  kOpenWall,      ///< A gutter: the wall does not close about the axis.
  kWrongSize,     ///< Thinner or thicker than parts may be, or longer.
};

/// The tube that a mesh stands for. Frame and metres of the mesh.
struct MeshTube {
  MeshVerdict verdict = MeshVerdict::kTube;
  std::string reason;  ///< Why it is no tube, with numbers; empty for a tube.
  Polyline line;       ///< From end to end of the axis: from cut to cut of a tube that is cut off,
                       ///< from centre to centre of rounded ends.
  double length_m = 0.0;
  double radius_m = 0.0;       ///< Outer: median distance of the mesh's corners from the axis.
  double rms_m = 0.0;          ///< Of the outer wall's distance from the tube, facets included.
  double max_m = 0.0;          ///< Largest of these distances.
  double radius_spread = 0.0;  ///< (90th - 10th percentile of the radius) / median.
  /// Of sections along the axis; share of them that differ from the median by more than 5 %.
  double min_radius_m = 0.0, max_radius_m = 0.0, other_radius_share = 0.0;
  bool hollow = false;  ///< An inner wall was seen; it is not part of the fit.
  /// What the mesh encloses, bore left out; none for an open mesh or one of several bodies.
  std::optional<double> volume_m3;
  std::vector<MeshPoint> wall;  ///< Samples of the outer wall.
};

/// Finds axis and radius by the axis-space method: points of the surface, moved inwards along their
/// normals by the right radius, meet on the axis. The radius to begin with is the most common local
/// one, found from pairs of normals; it is then measured again from the axis, and so on. At last
/// the axis is moved into the centres of the outer wall's sections, which know no radius: spigots,
/// beads and tapers do not bend it. Ends and inner walls may be open or closed. Accepted are tubes
/// of at least four radii of length whose radius spreads by at most 10 % (six sides are no tube,
/// twelve are). A verdict, not an exception, says what is no tube. Precondition: the mesh has a
/// face.
MeshTube FindTubeOfMesh(const Mesh& mesh, Parallelism parallelism);

}  // namespace tubetwin
