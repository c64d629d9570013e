#include "perception/view/floor_pose.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "models/base/error.h"
#include "perception/view/common_heights.h"
#include "perception/view/floor_ways.h"

namespace tubetwin {
namespace {

/// Poses that differ by less are the same: what grabbers write who do not know where they are.
constexpr double kUnknownShift_m = 0.001;
const double kUnknownTurn_rad = Radians(0.1);

/// Of the turns of a way the one that the header promises.
FloorWay Promised(const FloorWay& way, const Vector3& x_C, const Bin& bin) {
  FloorWay best = way;
  double max_along = -2.0;
  for (const RigidTransform& turn : TurnsOf(bin)) {
    const Vector3 x_N = (turn * way.X_NC).linear() * x_C;
    // A little of y decides where x is square to it.
    const double along = x_N.x() + 1e-3 * x_N.y();
    if (along <= max_along) continue;
    max_along = along;
    best = Turned(way, turn);
  }
  return best;
}

std::string Ambiguity(const std::vector<FloorWay>& ways, const RigidTransform& X_CS) {
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(ways.size(), 3); ++k) {
    const Vector3 p = (ways[k].X_NC * X_CS).translation();
    char place[64];
    std::snprintf(place, sizeof place, "(%.2f, %.2f, %.2f)", p.x(), p.y(), p.z());
    text += (k > 0 ? " or at " : "") + std::string(place) + " with the walls " +
            WallsText(ways[k].seen_walls);
  }
  return "the pose is ambiguous, the scanner may be at " + text +
         ": two walls that face each other, or one from corner to corner, must be seen to tell "
         "which is a long one and that it is the bin given";
}

bool KnowTheirPlaces(const std::vector<OrganizedCloud>& clouds) {
  return std::any_of(clouds.begin(), clouds.end(), [&clouds](const OrganizedCloud& cloud) {
    const RigidTransform off = clouds.front().X_NS.inverse() * cloud.X_NS;
    return off.translation().norm() > kUnknownShift_m ||
           Eigen::AngleAxisd(off.linear()).angle() > kUnknownTurn_rad;
  });
}

[[noreturn]] void Refuse(const std::string& why) { throw Error(ErrorKind::kBadData, why); }

/// All clouds in one frame.
FloorPose FitTogether(const std::vector<OrganizedCloud>& clouds, const Bin& bin) {
  const FloorWays found = FindFloorWays(clouds, bin);
  if (found.ways.empty()) Refuse(found.why_none);
  std::vector<FloorWay> ways;
  for (const FloorWay& way : found.ways) {
    ways.push_back(Promised(way, clouds.front().X_NS.linear().col(0), bin));
  }
  if (ways.size() > 1 || !ways.front().shows_size) {
    Refuse(Ambiguity(ways, clouds.front().X_NS));
  }
  FloorPose out;
  for (const OrganizedCloud& cloud : clouds) out.X_NS.push_back(ways.front().X_NC * cloud.X_NS);
  out.walls = WallsText(ways.front().seen_walls);
  return out;
}

/// Each cloud for itself, then all by what they see in common.
FloorPose FitApart(const std::vector<OrganizedCloud>& clouds, const Bin& bin) {
  std::vector<std::vector<FloorWay>> ways;
  for (std::size_t v = 0; v < clouds.size(); ++v) {
    OrganizedCloud alone = clouds[v];
    alone.X_NS = RigidTransform::Identity();
    const FloorWays found = FindFloorWays({alone}, bin);
    if (found.ways.empty()) Refuse("cloud " + std::to_string(v + 1) + ": " + found.why_none);
    ways.emplace_back();
    for (const FloorWay& way : found.ways) {
      if (v == 0) {
        ways.back().push_back(Promised(way, Vector3::UnitX(), bin));
        continue;
      }
      for (const RigidTransform& turn : TurnsOf(bin)) ways.back().push_back(Turned(way, turn));
    }
  }
  const ChosenWays chosen = ChooseByCommonHeights(clouds, ways, bin);
  if (chosen.ways.empty()) Refuse(chosen.why_none);
  std::vector<OrganizedCloud> placed = clouds;
  for (std::size_t v = 0; v < placed.size(); ++v) placed[v].X_NS = chosen.ways[v].X_NC;
  return FitTogether(placed, bin);
}

}  // namespace

FloorPose FitFloorPose(const std::vector<OrganizedCloud>& clouds, const Bin& bin) {
  if (clouds.empty()) Refuse("no cloud was given");
  FloorPose out;
  if (clouds.size() == 1 || KnowTheirPlaces(clouds)) {
    out = FitTogether(clouds, bin);
  } else {
    out = FitApart(clouds, bin);
  }
  out.open = TurnsOf(bin).size() > 2 ? "a quarter turn of the bin" : "half a turn of the bin";
  return out;
}

}  // namespace tubetwin
