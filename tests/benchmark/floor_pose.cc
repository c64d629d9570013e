// How often a pose from floor and walls is wrong, over random piles in random bins seen from random
// poses: floor_pose own|coarse|other|several COUNT [FIRST [THREADS]]. Seeds FIRST to FIRST + COUNT
// - 1.
//
//   own     the twin's scanners, as `tubetwin scan` sees, their pose thrown away
//   coarse  points about 3 mm apart in no order with 1 to 2 mm of noise, as stereo cameras give
//   other   as own, but the bin that is said to be seen has another size
//   several two to four views like own of each pile, which do not know how they stand to each other
//
// A line for every accepted view that is more than 5 mm or 0.5 degrees off (a turn that looks the
// same allowed) or, of another bin, accepted at all; then "right K of N accepted" with the 95 %
// interval and the reasons of the others.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "models/base/error.h"
#include "models/cell_model.h"
#include "models/part.h"
#include "perception/view/floor_pose.h"
#include "scenes/pile.h"
#include "tests/support/paper_scan.h"
#include "twin/render/scan/scan_geometry.h"
#include "twin/statistics/wilson.h"

namespace tubetwin {
namespace {

constexpr double kShift_m = 0.005, kTurn_deg = 0.5;
constexpr float kAlbedo = 0.5f;

struct ViewCase {
  Bin bin, given;
  int tubes = 0;
  RigidTransform X_NS = RigidTransform::Identity();
  ScanGeometry geometry_N;
};

Bin DrawAnyBin(RandomStream& stream) {
  Bin bin;
  const double which = stream.Uniform();
  if (which < 0.25) return bin;
  bin.size_m = {0.80, 0.60, which < 0.4 ? 0.09 : 0.20};
  if (which >= 0.6) {
    bin.size_m = {stream.Uniform(0.5, 0.9), stream.Uniform(0.35, 0.5), stream.Uniform(0.06, 0.22)};
  }
  return bin;
}

void AddBin(const Bin& bin, RandomStream& stream, ScanGeometry& out) {
  const auto add = [&out](const Vector3& centre, const Vector3& half) {
    out.boxes.push_back({Translation(centre.x(), centre.y(), centre.z()), half, 1, kAlbedo});
  };
  const double x = bin.half_x_m(), y = bin.half_y_m(), h = 0.5 * bin.wall_m();
  const double t = 0.5 * Bin::kWallThickness_m;
  add({0, 0, -t}, {x + 2 * t, y + 2 * t, t});
  for (const double side : {-1.0, 1.0}) {
    add({side * (x + t), 0, h}, {t, y + 2 * t, h});
    add({0, side * (y + t), h}, {x + 2 * t, t, h});
  }
  // The table that it stands on, or nothing.
  if (stream.Uniform() < 0.7) add({0.2, 0.1, -0.03 - stream.Uniform(0, 0.1)}, {1.2, 1.0, 0.01});
}

void AddPile(int tubes, const Bin& bin, RandomStream& stream, ScanGeometry& out) {
  const std::vector<std::string> parts = PartNames();
  const Part part = LoadPart(parts[stream.Index(static_cast<std::uint32_t>(parts.size()))]);
  for (int i = 0; i < tubes; ++i) {
    const double reach_x = std::max(0.0, bin.half_x_m() - 0.12);
    const double reach_y = std::max(0.0, bin.half_y_m() - 0.12);
    const Vector3 centre(stream.Uniform(-reach_x, reach_x), stream.Uniform(-reach_y, reach_y),
                         part.radius_m * (1.0 + 0.7 * i * stream.Uniform(0.3, 1.0)));
    const RigidTransform X =
        MakeTransform(RotZ(stream.Uniform(0, 2 * kPi)) * RotX(stream.Uniform(-0.2, 0.2)), centre);
    Polyline line = Transformed(X, DrawShape(part, stream));
    for (Vector3& p : line) {
      p.x() = std::clamp(p.x(), part.radius_m - bin.half_x_m(), bin.half_x_m() - part.radius_m);
      p.y() = std::clamp(p.y(), part.radius_m - bin.half_y_m(), bin.half_y_m() - part.radius_m);
      p.z() = std::max(p.z(), part.radius_m);
    }
    for (const AxisPiece& piece : PiecesWithin(line, part.radius_m)) {
      out.capsules.push_back({piece.from, piece.to, part.radius_m, kLabelFirstTube, kAlbedo});
    }
  }
}

/// From above, looking up to 20 degrees askew at a place in the bin.
RigidTransform DrawPose(const Bin& bin, RandomStream& stream) {
  const double distance = stream.Uniform(0.45, 1.15);
  const Vector3 axis = RotZ(stream.Uniform(0, 2 * kPi)) * Vector3::UnitX();
  const double tilt = Radians(stream.Uniform(0, 20));
  const Matrix3 R = Eigen::AngleAxisd(tilt, axis).toRotationMatrix() *
                    RotZ(stream.Uniform(0, 2 * kPi)) * RotX(kPi);
  const double reach = stream.Uniform(0.0, 0.8);
  const Vector3 at(reach * stream.Uniform(-1, 1) * bin.half_x_m(),
                   reach * stream.Uniform(-1, 1) * bin.half_y_m(), 0);
  return MakeTransform(R, at - distance * R.col(2));
}

ViewCase DrawViewCase(const std::string& kind, RandomStream& stream) {
  ViewCase c;
  c.bin = c.given = DrawAnyBin(stream);
  if (kind == "other") {
    for (const int k : {0, 1}) {
      const double sign = stream.Uniform() < 0.5 ? -1 : 1;
      c.given.size_m[static_cast<std::size_t>(k)] += sign * stream.Uniform(0.02, 0.12);
    }
  }
  c.tubes = static_cast<int>(stream.Index(13));
  AddBin(c.bin, stream, c.geometry_N);
  AddPile(c.tubes, c.bin, stream, c.geometry_N);
  c.X_NS = DrawPose(c.bin, stream);
  return c;
}

OrganizedCloud Look(const ViewCase& c, bool coarse, RandomStream& stream, Parallelism parallelism) {
  ScanSettings settings = PaperScan();
  if (c.X_NS.translation().z() > 0.65)
    settings.spec = ReadScanner(OpenModelFile("scanners", "phoxi_m", "scanner"));
  settings.width = 516;
  if (coarse) {
    const double seen_m =
        c.X_NS.translation().z() * settings.spec.full_width / settings.spec.focal_px;
    settings.width = static_cast<int>(seen_m / 0.003);
  }
  settings.height = settings.width * settings.spec.full_height / settings.spec.full_width;
  settings.noise_scale = stream.Uniform(1.0, 3.0);
  OrganizedCloud cloud = CastScan(c.geometry_N, c.X_NS, settings, stream.Fork("scan"), parallelism);
  cloud.X_NS = RigidTransform::Identity();
  if (!coarse) return cloud;
  const double sigma_m = stream.Uniform(0.001, 0.002);
  std::erase_if(cloud.p_SP, [](const auto& p) { return !IsValid(p); });
  for (auto& p : cloud.p_SP) p += static_cast<float>(stream.Normal(0, sigma_m)) * p.normalized();
  for (std::size_t i = cloud.p_SP.size(); i > 1; --i) {
    std::swap(cloud.p_SP[i - 1], cloud.p_SP[stream.Index(static_cast<std::uint32_t>(i))]);
  }
  cloud.width = static_cast<int>(cloud.p_SP.size());
  cloud.height = 1;
  return cloud;
}

/// How far a pose is off, a turn that looks the same allowed.
struct PoseError {
  double shift_m = 1e9, turn_deg = 1e9;
  bool right() const { return shift_m <= kShift_m && turn_deg <= kTurn_deg; }
};
PoseError ErrorOf(const std::vector<RigidTransform>& fitted,
                  const std::vector<RigidTransform>& X_NS, const Bin& bin) {
  PoseError best;
  const bool square = std::abs(bin.size_m[0] - bin.size_m[1]) < 0.001;
  for (int k = 0; k < 4; k += square ? 1 : 2) {
    PoseError worst{0.0, 0.0};
    for (std::size_t v = 0; v < fitted.size(); ++v) {
      const RigidTransform off =
          (MakeTransform(RotZ(0.5 * kPi * k), Vector3::Zero()) * X_NS[v]).inverse() * fitted[v];
      worst.shift_m = std::max(worst.shift_m, off.translation().norm());
      worst.turn_deg = std::max(worst.turn_deg, Degrees(Eigen::AngleAxisd(off.linear()).angle()));
    }
    if (worst.turn_deg < best.turn_deg) best = worst;
  }
  return best;
}

/// A refusal without its numbers, so that equal reasons count together.
std::string Reason(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(),
                            [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; }),
             text.end());
  return text.substr(0, 70);
}

/// The views of a case; the error of the first, and of the others to it.
std::vector<OrganizedCloud> LookAt(ViewCase& c, const std::string& kind, RandomStream& stream,
                                   Parallelism parallelism, std::vector<RigidTransform>& X_NS) {
  const int views = kind == "several" ? 2 + static_cast<int>(stream.Index(3)) : 1;
  std::vector<OrganizedCloud> out;
  for (int v = 0; v < views; ++v) {
    if (v > 0) c.X_NS = DrawPose(c.bin, stream);
    out.push_back(Look(c, kind == "coarse", stream, parallelism));
    X_NS.push_back(c.X_NS);
  }
  return out;
}

int MeasureFloorPoses(const std::string& kind, int count, int first, Parallelism parallelism) {
  int accepted = 0, right = 0;
  std::map<std::string, int> reasons;
  for (int seed = first; seed < first + count; ++seed) {
    RandomStream stream =
        RandomStream(static_cast<std::uint64_t>(seed), 0, "floor pose bench").Fork(kind);
    ViewCase c = DrawViewCase(kind, stream);
    std::vector<RigidTransform> X_NS;
    const std::vector<OrganizedCloud> clouds = LookAt(c, kind, stream, parallelism, X_NS);
    try {
      const FloorPose pose = FitFloorPose(clouds, c.given);
      ++accepted;
      const PoseError error = ErrorOf(pose.X_NS, X_NS, c.bin);
      if (kind != "other" && error.right()) {
        ++right;
        continue;
      }
      const Vector3& p = X_NS.front().translation();
      std::printf(
          "seed %d: %.1f mm, %.2f degrees off, walls %s; bin %.3f x %.3f x %.3f m, given "
          "%.3f x %.3f, %d tubes, scanner at %.2f %.2f %.2f m\n",
          seed, 1e3 * error.shift_m, error.turn_deg, pose.walls.c_str(), c.bin.size_m[0],
          c.bin.size_m[1], c.bin.size_m[2], c.given.size_m[0], c.given.size_m[1], c.tubes, p.x(),
          p.y(), p.z());
      std::fflush(stdout);
    } catch (const Error& refusal) {
      ++reasons[Reason(refusal.what())];
      if (count == 1)
        std::printf("%s; scanner at %.2f %.2f %.2f m, bin %.3f x %.3f x %.3f m\n", refusal.what(),
                    X_NS[0].translation().x(), X_NS[0].translation().y(), X_NS[0].translation().z(),
                    c.bin.size_m[0], c.bin.size_m[1], c.bin.size_m[2]);
    }
  }
  const ShareInterval interval = Wilson95(right, accepted);
  if (kind == "other") {
    std::printf("%s: accepted %d of %d\n", kind.c_str(), accepted, count);
  } else {
    std::printf("%s: right %d of %d accepted (95 %% interval %.3f to %.3f), of %d\n", kind.c_str(),
                right, accepted, interval.low, interval.high, count);
  }
  for (const auto& [reason, n] : reasons) std::printf("%4d refused: %s\n", n, reason.c_str());
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  const std::string kind = argc > 2 ? argv[1] : "";
  if (kind != "own" && kind != "coarse" && kind != "other" && kind != "several") {
    std::fprintf(stderr, "usage: floor_pose own|coarse|other|several COUNT [FIRST [THREADS]]\n");
    return 64;
  }
  return tubetwin::MeasureFloorPoses(kind, std::atoi(argv[2]), argc > 3 ? std::atoi(argv[3]) : 0,
                                     {argc > 4 ? std::atoi(argv[4]) : 1});
}
