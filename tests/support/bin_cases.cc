#include "tests/support/bin_cases.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/cell_model.h"
#include "models/physics.h"
#include "scenes/pile.h"
#include "tests/support/paper_cell.h"
#include "tests/support/paper_scan.h"

namespace tubetwin {
namespace {

constexpr float kBinAlbedo = 0.5f, kTubeAlbedo = 0.7f;
/// Arm and scanner stand over the bin: what sticks up higher than this would meet them.
constexpr double kHighest_m = 0.35;

Bin DrawBin(RandomStream& stream) {
  Bin bin;
  const double which = stream.Uniform();
  if (which < 0.4) return bin;
  if (which < 0.7) {
    bin.size_m = {0.80, 0.60, 0.20};
  } else {
    bin.size_m = {stream.Uniform(0.6, 0.9), stream.Uniform(0.4, 0.6), stream.Uniform(0.05, 0.20)};
  }
  return bin;
}

void AddLine(ScanGeometry& geometry, const Polyline& line_N, double radius_m) {
  for (const AxisPiece& piece : PiecesWithin(line_N, radius_m)) {
    geometry.capsules.push_back({piece.from, piece.to, radius_m, kLabelFirstTube, kTubeAlbedo});
  }
}

void AddBox(ScanGeometry& geometry, const RigidTransform& X_NBox, const Vector3& half_m) {
  geometry.boxes.push_back({X_NBox, half_m, kLabelCell, kBinAlbedo});
}

/// A line turned by `R`, on the floor, its box at the given shares (0..1) of the room that it has.
Polyline LaidDown(const Polyline& line, const Matrix3& R, double radius_m, const Bin& bin,
                  double share_x, double share_y) {
  Polyline out = Transformed(MakeTransform(R, Vector3::Zero()), line);
  Eigen::AlignedBox3d box;
  for (const Vector3& p : out) box.extend(p);
  const double half[2] = {bin.half_x_m() - radius_m, bin.half_y_m() - radius_m};
  const double share[2] = {share_x, share_y};
  Vector3 shift(0, 0, radius_m - box.min().z());
  for (int k = 0; k < 2; ++k) {
    const double room = std::max(0.0, 2 * half[k] - box.sizes()[k]);
    shift[k] = -half[k] - box.min()[k] + share[k] * room;
  }
  for (Vector3& p : out) p += shift;
  return out;
}

/// A straight tube with its lower end on the floor `d` before the edge point, going up towards it:
/// over the rim, or against the wall when it is too short for that.
Polyline Leaning(const Vector3& edge_N, const Vector3& inward, double d, double length_m,
                 double radius_m, double wall_m) {
  const Vector3 low = edge_N + d * inward + Vector3(0, 0, radius_m);
  const double up = wall_m - radius_m;
  double angle = std::atan2(up, d) + std::asin(std::min(1.0, radius_m / std::hypot(d, up)));
  if (length_m * std::sin(angle) < up) angle = std::acos(std::min(1.0, (d - radius_m) / length_m));
  angle = std::min(angle, std::asin(std::min(1.0, (kHighest_m - radius_m) / length_m)));
  return {low, low + length_m * (std::cos(angle) * -inward + std::sin(angle) * Vector3::UnitZ())};
}

Polyline DrawLeaning(const Part& part, const Bin& bin, bool corner, RandomStream& stream) {
  const double sign_x = stream.Uniform() < 0.5 ? -1 : 1, sign_y = stream.Uniform() < 0.5 ? -1 : 1;
  Vector3 edge, inward;
  const double turn = Radians(stream.Uniform(-35, 35));
  if (corner) {
    edge = {sign_x * bin.half_x_m(), sign_y * bin.half_y_m(), 0};
    inward = Vector3(-sign_x, -sign_y, 0).normalized();
  } else if (stream.Uniform() < 0.5) {
    edge = {sign_x * bin.half_x_m(), stream.Uniform(-0.4, 0.4) * bin.half_y_m(), 0};
    inward = RotZ(turn) * Vector3(-sign_x, 0, 0);
  } else {
    edge = {stream.Uniform(-0.4, 0.4) * bin.half_x_m(), sign_y * bin.half_y_m(), 0};
    inward = RotZ(turn) * Vector3(0, -sign_y, 0);
  }
  const double d = std::max(stream.Uniform(0.1, 0.9) * part.length_m, 2 * part.radius_m);
  return Leaning(edge, inward, d, part.length_m, part.radius_m, bin.wall_m());
}

void DrawTube(BinCase& c, RandomStream& stream) {
  static const char* const kPlaces[] = {"anywhere", "along a wall", "in a corner",
                                        "leaning on a wall", "leaning in a corner"};
  const auto place = stream.Index(5);
  const bool straight = place >= 3 || (!c.part.is_hose() && stream.Uniform() < 0.5);
  c.what = c.part.name + (straight ? " straight " : " bent ") + kPlaces[place];
  if (place >= 3) {
    return AddLine(c.in_bin_N, DrawLeaning(c.part, c.bin, place == 4, stream), c.part.radius_m);
  }
  const double half_m = 0.5 * c.part.length_m;
  Polyline line = {{-half_m, 0, 0}, {half_m, 0, 0}};
  if (!straight) {
    line = DrawShape(c.part, stream);
    // Flat on the floor, but for twisted hooks: the direction of least extent goes up.
    Matrix3 squares = Matrix3::Zero();
    for (const Vector3& p : line) squares += p * p.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(squares);
    Matrix3 R = solver.eigenvectors().rowwise().reverse();
    if (R.determinant() < 0) R.col(2) = -R.col(2);
    line = Transformed(MakeTransform(R.transpose(), Vector3::Zero()), line);
  }
  double yaw = stream.Uniform(0, 2 * kPi);
  if (place > 0 && stream.Uniform() < 0.7) yaw = 0.5 * kPi * stream.Index(4);
  double share[2] = {stream.Uniform(), stream.Uniform()};
  const auto end = [&stream] { return stream.Uniform() < 0.5 ? 0.0 : 1.0; };
  if (place == 1) share[stream.Index(2)] = end();
  if (place == 2) share[0] = end(), share[1] = end();
  AddLine(c.in_bin_N, LaidDown(line, RotZ(yaw), c.part.radius_m, c.bin, share[0], share[1]),
          c.part.radius_m);
}

void DrawForeign(BinCase& c, RandomStream& stream) {
  const Bin& bin = c.bin;
  const double r = c.part.radius_m;
  const auto place = [&](double reach_m, double z) {
    const double x = std::max(0.0, bin.half_x_m() - reach_m);
    const double y = std::max(0.0, bin.half_y_m() - reach_m);
    return Vector3(stream.Uniform(-x, x), stream.Uniform(-y, y), z);
  };
  const RigidTransform turned = MakeTransform(RotZ(stream.Uniform(0, 2 * kPi)), Vector3::Zero());
  switch (stream.Index(5)) {
    case 0: {
      c.what = "box";
      const Vector3 half(stream.Uniform(0.008, 0.06), stream.Uniform(0.008, 0.06),
                         stream.Uniform(0.005, 0.03));
      AddBox(c.in_bin_N, Translation(place(half.norm(), half.z())) * turned, half);
      break;
    }
    case 1: {
      c.what = "ball";
      const double radius_m = stream.Uniform(0.008, 0.04);
      const Vector3 p = place(radius_m, radius_m);
      AddLine(c.in_bin_N, {p, p + Vector3(1e-5, 0, 0)}, radius_m);
      break;
    }
    case 2: {
      c.what = "sheet";
      const double tilt = Radians(stream.Uniform(0, 12));
      const Vector3 half(stream.Uniform(0.05, 0.12), stream.Uniform(0.05, 0.10), 0.003);
      const double z = half.x() * std::sin(tilt) + half.z();
      AddBox(
          c.in_bin_N,
          Translation(place(half.norm(), z)) * turned * MakeTransform(RotY(tilt), Vector3::Zero()),
          half);
      break;
    }
    default: {
      const bool thin = stream.Uniform() < 0.5;
      const double radius_m = r * (thin ? stream.Uniform(0.4, 0.55) : stream.Uniform(1.7, 2.5));
      c.what = thin ? "cable" : "thick pipe";
      Part other = c.part;
      other.length_m = stream.Uniform(0.15, 0.35);
      Polyline line = {{-0.5 * other.length_m, 0, 0}, {0.5 * other.length_m, 0, 0}};
      if (thin && !c.part.is_hose()) line = DrawShape(other, stream);
      AddLine(c.in_bin_N,
              LaidDown(line, turned.linear(), radius_m, bin, stream.Uniform(), stream.Uniform()),
              radius_m);
    }
  }
}

/// The bin and what is in it, in B.
ScanGeometry GeometryOf(const BinCase& c) {
  ScanGeometry out;
  for (ScanGeometry::Capsule capsule : c.in_bin_N.capsules) {
    capsule.a = c.bin.X_BN * capsule.a;
    capsule.b = c.bin.X_BN * capsule.b;
    out.capsules.push_back(capsule);
  }
  for (ScanGeometry::Box box : c.in_bin_N.boxes) {
    box.X_BBox = c.bin.X_BN * box.X_BBox;
    out.boxes.push_back(box);
  }
  const double x = c.bin.half_x_m(), y = c.bin.half_y_m(), h = 0.5 * c.bin.wall_m();
  const double t = 0.5 * Bin::kWallThickness_m;
  AddBox(out, c.bin.X_BN * Translation(0, 0, -t), {x + 2 * t, y + 2 * t, t});
  for (const double side : {-1.0, 1.0}) {
    AddBox(out, c.bin.X_BN * Translation(side * (x + t), 0, h), {t, y + 2 * t, h});
    AddBox(out, c.bin.X_BN * Translation(0, side * (y + t), h), {x + 2 * t, t, h});
  }
  return out;
}

}  // namespace

BinCase DrawBinCase(BinCase::Kind kind, std::uint64_t seed) {
  static const char* const kNames[] = {"empty", "tube", "foreign"};
  RandomStream stream = RandomStream(seed, 0, "bin case").Fork(kNames[static_cast<int>(kind)]);
  BinCase c;
  c.kind = kind;
  c.seed = seed;
  const std::vector<std::string> parts = PartNames();
  c.part = LoadPart(parts[stream.Index(static_cast<std::uint32_t>(parts.size()))]);
  c.bin = DrawBin(stream);
  c.noise_scale = stream.Uniform(1.0, 3.0);
  PhysicsRanges ranges;
  c.X_SbelievedS = DrawPhysics(ranges, c.part, stream.Fork("hand-eye")).X_SbelievedS;
  c.what = "nothing";
  if (kind == BinCase::Kind::kTube) DrawTube(c, stream);
  if (kind == BinCase::Kind::kForeign) DrawForeign(c, stream);
  return c;
}

std::vector<OrganizedCloud> ScanBinCase(const BinCase& c, int width, Parallelism parallelism) {
  ScanSettings settings = PaperScan();
  settings.width = width;
  settings.height = width * settings.spec.full_height / settings.spec.full_width;
  settings.noise_scale = c.noise_scale;
  const ScanGeometry geometry = GeometryOf(c);
  std::vector<OrganizedCloud> out;
  for (const RigidTransform& X_BS : ScanPosesOf(PaperCell(), c.bin, c.part.radius_m)) {
    out.push_back(CastScan(geometry, X_BS * c.X_SbelievedS, settings,
                           RandomStream(c.seed, out.size(), "bin case scan"), parallelism));
    out.back().X_NS = c.bin.X_BN.inverse() * X_BS;
  }
  return out;
}

std::string JudgeBinCase(const BinCase& c, const TubeScene& scene) {
  const std::string seen = std::to_string(scene.tubes.size()) + " tubes, " +
                           std::string(ToString(scene.bin_content)) + ": " +
                           scene.bin_content_reason;
  switch (c.kind) {
    case BinCase::Kind::kEmpty:
      return scene.bin_content == BinContent::kEmpty && scene.tubes.empty() ? "" : seen;
    case BinCase::Kind::kTube:
      return scene.bin_content == BinContent::kNotEmpty ? "" : seen;
    case BinCase::Kind::kForeign:
      return scene.bin_content == BinContent::kNotEmpty && scene.tubes.empty() ? "" : seen;
  }
  TT_CHECK(!"a kind outside the enumeration");
  return "";
}

}  // namespace tubetwin
