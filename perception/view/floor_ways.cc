// 1. Planes with most points (floor_plane.h); up is where the scanner is.
// 2. Upright surfaces over such a plane are lines from above (wall_lines.h).
// 3. Each line may be either of two sides of the rectangle, long or short: all ways are refined by
//    least squares and compared with what is seen (bin_fit.h).
#include "perception/view/floor_ways.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "models/base/text.h"
#include "perception/view/bin_evidence.h"
#include "perception/view/bin_fit.h"

namespace tubetwin {
namespace {

constexpr std::size_t kMaxFitPoints = 300000;
constexpr std::size_t kMaxCheckPoints = 120000;
constexpr int kMaxPlanes = 3;  ///< Floor, a table around the bin, one more.
/// Where a cloud's scanner is not known it is taken to be this far over the bin.
constexpr double kOver_m = 1.5;
/// Poses closer than this are the same.
constexpr double kSameShift_m = 0.005;
const double kSameTurn_rad = Radians(0.5);
/// Sides of a bin that differ by less are equal.
constexpr double kSquareBin_m = 0.001;
/// Walls that face each other over less are no bin's.
constexpr double kCommon_m = 0.12;
/// Distance of two walls that is another than the bin's.
constexpr double kOtherSize_m = 0.005;
/// A wall this close to where the bin's would be, by a pose that may be a little off, is the bin's.
constexpr double kInPlace_m = 0.006;
/// A plane with less floor in the bin than this share of another's is a table beside it.
constexpr double kLeastFloor = 0.3;

Sighting Thinned(const std::vector<OrganizedCloud>& clouds, std::size_t max_points) {
  Sighting out;
  for (std::size_t v = 0; v < clouds.size(); ++v) {
    const OrganizedCloud& cloud = clouds[v];
    out.eye_C.emplace_back();
    if (SeenFromOrigin(cloud.p_SP)) out.eye_C.back() = cloud.X_NS.translation();
    std::vector<Vector3> valid;
    for (const auto& p : cloud.p_SP) {
      if (IsValid(p)) valid.push_back(cloud.X_NS * p.cast<double>());
    }
    const std::size_t keep = std::min(valid.size(), max_points / clouds.size());
    for (std::size_t i = 0; i < keep; ++i) {
      // By golden-ratio steps, so that no raster's columns are preferred.
      const double share = std::fmod(0.6180339887498949 * static_cast<double>(i), 1.0);
      const auto k = static_cast<std::size_t>(share * static_cast<double>(valid.size()));
      out.p_C.push_back(valid[keep == valid.size() ? i : k]);
      out.view_of.push_back(static_cast<int>(v));
    }
  }
  return out;
}

BinView ViewOnPlane(const Sighting& sighting, const FloorPlane& plane, const Bin& bin) {
  BinView out;
  out.X_CP = PlaneFrame(plane);
  const RigidTransform X_PC = out.X_CP.inverse();
  Vector3 mean = Vector3::Zero();
  for (const Vector3& p : sighting.p_C) mean += p / static_cast<double>(sighting.p_C.size());
  const Vector3 above = X_PC * (mean + kOver_m * plane.normal);
  for (std::size_t i = 0; i < sighting.p_C.size(); ++i) {
    const auto& eye_C = sighting.eye_C[static_cast<std::size_t>(sighting.view_of[i])];
    out.p_P.push_back(X_PC * sighting.p_C[i]);
    out.eye_P.push_back(eye_C ? Vector3(X_PC * *eye_C) : above);
    out.eye_known.push_back(eye_C.has_value());
  }
  out.walls = WallsOf(out, bin);
  return out;
}

/// Whether two poses are the same but for a turn that looks the same.
bool Same(const RigidTransform& X_NC, const RigidTransform& other, const Bin& bin) {
  const std::vector<RigidTransform> turns = TurnsOf(bin);
  return std::any_of(turns.begin(), turns.end(), [&](const RigidTransform& turn) {
    const RigidTransform off = X_NC * (turn * other).inverse();
    return off.translation().norm() < kSameShift_m &&
           Eigen::AngleAxisd(off.linear()).angle() < kSameTurn_rad;
  });
}

/// What two walls that face each other say about the size; empty when that is the bin's.
std::string WrongSize(const BinView::Walls& walls, const Bin& bin) {
  for (const WallLine& a : walls.lines.lines) {
    for (const WallLine& b : walls.lines.lines) {
      const double apart_m = -b.offset_m - a.offset_m;
      // Their extents along run against each other.
      const double common_m = std::min(a.high_m, -b.low_m) - std::max(a.low_m, -b.high_m);
      if (b.direction != a.direction + 2 || apart_m < 0.05 || common_m < kCommon_m) continue;
      if (std::abs(apart_m - bin.size_m[0]) > kOtherSize_m &&
          std::abs(apart_m - bin.size_m[1]) > kOtherSize_m) {
        char text[80];
        std::snprintf(text, sizeof text, "two walls %.3f m apart are seen", apart_m);
        return text;
      }
    }
  }
  return {};
}

/// The walls of P = N without those parallel to a side of the bin that is seen in its place: that
/// size is right, and what faces it is no wall of another bin.
BinView::Walls WithoutSides(const BinView::Walls& walls, const Bin& bin) {
  std::array<bool, 2> in_place{};
  const auto side_of = [&](const WallLine& line) {
    return SideFacing(DirectionOf(walls.lines.yaw_rad, line.direction));
  };
  for (const WallLine& line : walls.lines.lines) {
    const std::size_t side = side_of(line);
    if (side > 3) continue;
    const double half_m = side < 2 ? bin.half_x_m() : bin.half_y_m();
    in_place[side / 2] |= std::abs(-line.offset_m - half_m) < kInPlace_m;
  }
  BinView::Walls out = walls;
  std::erase_if(out.lines.lines, [&](const WallLine& line) {
    const std::size_t side = side_of(line);
    return side > 3 || in_place[side / 2];
  });
  return out;
}

/// Ways so far, and why there is none: of several planes the reason that came furthest counts.
class Search {
 public:
  explicit Search(const Bin& bin) : bin_(bin) {
    Refuse(0, "no floor with two neighbouring walls of a bin of " + SizeText(bin) +
                  " is seen, so its pose cannot be fitted");
  }

  /// Lays the bin on the walls over one plane.
  void Add(const BinView& view) {
    const std::string few = FewWalls(view.walls);
    if (!few.empty()) return Refuse(few == kNoWall ? 1 : 2, few);
    const std::vector<BinFit> fits = FitBin(view, bin_);
    bool any = false;
    for (const BinFit& fit : fits) {
      most_floor_m2_ = std::max(most_floor_m2_, fit.seen_floor);
      if (!IsSound(fit, bin_)) continue;
      any = true;
      const RigidTransform X_NC = fit.X_NP * view.X_CP.inverse();
      const bool known = std::any_of(ways_.begin(), ways_.end(), [&](const FloorWay& other) {
        return Same(other.X_NC, X_NC, bin_);
      });
      if (!known) ways_.push_back({X_NC, fit.seen_walls, fit.shows_size, fit.seen_floor});
    }
    if (!any) ExplainNone(view, fits);
  }

  FloorWays Result() {
    std::erase_if(ways_, [this](const FloorWay& way) {
      return way.seen_floor_m2 < kLeastFloor * most_floor_m2_;
    });
    return {ways_, ways_.empty() ? why_ : std::string()};
  }

 private:
  void Refuse(int stage, const std::string& why) {
    if (stage <= stage_) return;
    stage_ = stage;
    why_ = why;
  }

  void ExplainNone(const BinView& view, const std::vector<BinFit>& fits) {
    const std::string given = "; the bin given is " + SizeText(bin_);
    const std::string size = WrongSize(view.walls, bin_);
    if (!size.empty()) return Refuse(4, size + given + ": give the size of the one that is seen");
    const BinFit* best = nullptr;
    for (const BinFit& fit : fits) {
      if (fit.seen_floor < LeastSeenFloor(bin_)) continue;
      if (best == nullptr || fit.seen_through_m < best->seen_through_m) best = &fit;
    }
    if (best == nullptr) return;
    char text[180];
    std::snprintf(text, sizeof text,
                  "the walls seen fit no bin of that size: at best %.1f %% of the points lie below "
                  "its floor, and %.2f m of its walls are seen through",
                  100.0 * best->below_floor, best->seen_through_m);
    Refuse(3, (best->odd.empty() ? std::string(text) : best->odd) + given);
  }

  const Bin& bin_;
  std::vector<FloorWay> ways_;
  double most_floor_m2_ = 0.0;
  int stage_ = -1;
  std::string why_;
};

}  // namespace

FloorWays FindFloorWays(const std::vector<OrganizedCloud>& clouds, const Bin& bin) {
  const Sighting sighting = Thinned(clouds, kMaxFitPoints);
  Search search(bin);
  for (const FloorPlane& plane :
       FindPlanes(sighting, kMaxPlanes, RandomStream(1, 0, "floor pose"))) {
    search.Add(ViewOnPlane(sighting, plane, bin));
  }
  return search.Result();
}

std::string OtherBinSeen(const std::vector<OrganizedCloud>& clouds, const Bin& bin) {
  const BinView view = ViewOnPlane(Thinned(clouds, kMaxCheckPoints), FloorPlane{}, bin);
  const std::string size = WrongSize(WithoutSides(view.walls, bin), bin);
  return size.empty() ? size
                      : size + "; the bin given is " + SizeText(bin) + ": check --bin and the pose";
}

std::vector<RigidTransform> TurnsOf(const Bin& bin) {
  const bool square = std::abs(bin.size_m[0] - bin.size_m[1]) < kSquareBin_m;
  std::vector<RigidTransform> out;
  for (int k = 0; k < 4; k += square ? 1 : 2) {
    out.push_back(MakeTransform(RotZ(0.5 * kPi * k), Vector3::Zero()));
  }
  return out;
}

FloorWay Turned(const FloorWay& way, const RigidTransform& turn) {
  return {turn * way.X_NC, TurnedWalls(way.seen_walls, turn), way.shows_size, way.seen_floor_m2};
}

std::string WallsText(const std::array<bool, 4>& walls) {
  static const char* const kNames[] = {"-x", "+x", "-y", "+y"};
  std::vector<std::string> seen;
  for (std::size_t k = 0; k < 4; ++k) {
    if (walls[k]) seen.emplace_back(kNames[k]);
  }
  return Join(seen);
}

std::string SizeText(const Bin& bin) {
  return Number(bin.size_m[0]) + " x " + Number(bin.size_m[1]) + " x " + Number(bin.size_m[2]) +
         " m";
}

}  // namespace tubetwin
