#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "scenes/pile.h"

namespace tubetwin {
namespace {

constexpr double kFineStep_m = 0.001;  // Curves are drawn in steps of this, then thinned.
constexpr int kRigidPieces = 12;       // Capsules of a rigid tube with round bends.
constexpr double kHookRadius_m = 0.05;
constexpr double kHookEndFrom_m = 0.04, kHookEndTo_m = 0.09, kShortest_m = 0.02;
constexpr double kHookMiddleBend_deg = 20.0;
constexpr double kShortestPiece_m = 0.02;  // The public set's cl_min.

// Draws a whole number between two that the part gives as doubles.
int DrawCount(RandomStream& stream, const std::vector<double>& range) {
  const int low = static_cast<int>(std::lround(range[0]));
  const int high = static_cast<int>(std::lround(range[1]));
  return low + static_cast<int>(stream.Index(static_cast<std::uint32_t>(high - low + 1)));
}

// A pen that leaves a line and turns as it goes: x of its frame is the direction.
class Pen {
 public:
  Pen() { line_.push_back(p_); }
  // Bends in the frame's xy plane while going `length_m`.
  void Arc(double length_m, double angle_rad) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kFineStep_m)));
    const Matrix3 half = RotZ(0.5 * angle_rad / steps);
    for (int i = 0; i < steps; ++i) {
      R_ = R_ * half;
      Straight(length_m / steps);
      R_ = R_ * half;
    }
  }
  void Straight(double length_m) {
    p_ += length_m * R_.col(0);
    line_.push_back(p_);
  }
  void Corner(double angle_rad) { R_ = R_ * RotZ(angle_rad); }
  void TurnPlane(double angle_rad) { R_ = R_ * RotX(angle_rad); }
  const Polyline& line() const { return line_; }

 private:
  Polyline line_;
  Vector3 p_ = Vector3::Zero();
  Matrix3 R_ = Matrix3::Identity();
};

Polyline DrawArcs(const Part& part, RandomStream& stream) {
  const int count = DrawCount(stream, part.bends);
  Pen pen;
  for (int i = 0; i < count; ++i) {
    const double angle = Radians(stream.Uniform(part.bend_deg[0], part.bend_deg[1]));
    pen.Arc(part.length_m / count, stream.Uniform() < 0.5 ? -angle : angle);
  }
  return pen.line();
}

Polyline DrawHooks(const Part& part, RandomStream& stream) {
  double first_m = stream.Uniform(kHookEndFrom_m, kHookEndTo_m);
  double last_m = stream.Uniform(kHookEndFrom_m, kHookEndTo_m);
  const double bend1 = Radians(stream.Uniform(part.bend_deg[0], part.bend_deg[1]));
  const double bend2 = Radians(stream.Uniform(part.bend_deg[0], part.bend_deg[1]));
  const double middle_bend = Radians(stream.Uniform(-kHookMiddleBend_deg, kHookMiddleBend_deg));
  const double plane = stream.Uniform(0.0, 2 * kPi);
  // Ends give way where the hooks leave no room for a middle.
  const double straight_m = part.length_m - kHookRadius_m * (bend1 + bend2);
  const double ends_m = straight_m - kShortest_m;
  if (first_m + last_m > ends_m) {
    const double share = ends_m / (first_m + last_m);
    first_m *= share;
    last_m *= share;
  }
  Pen pen;
  pen.Straight(first_m);
  pen.Arc(kHookRadius_m * bend1, bend1);
  pen.Arc(straight_m - first_m - last_m, middle_bend);
  pen.TurnPlane(plane);
  pen.Arc(kHookRadius_m * bend2, bend2);
  pen.Straight(last_m);
  return pen.line();
}

// As the public set was drawn: each piece takes a uniform share of what the shortest pieces after
// it leave, so that the first are long.
Polyline DrawCorners(const Part& part, RandomStream& stream) {
  const int pieces = DrawCount(stream, part.bends) + 1;
  const double shortest_m = std::min(kShortestPiece_m, 0.5 * part.length_m / pieces);
  double left_m = part.length_m;
  Pen pen;
  for (int i = 0; i < pieces; ++i) {
    const double max_m = left_m - shortest_m * (pieces - 1 - i);
    const double piece_m = i + 1 == pieces ? left_m : stream.Uniform(shortest_m, max_m);
    pen.Straight(piece_m);
    left_m -= piece_m;
    pen.TurnPlane(stream.Uniform(0.0, 2 * kPi));
    pen.Corner(Radians(stream.Uniform(part.bend_deg[0], part.bend_deg[1])));
  }
  return pen.line();
}

// Centred, longest extent along x, flattest along z.
Polyline Aligned(const Polyline& line) {
  const Vector3 centre = CurveCentre(line);
  Matrix3 spread = Matrix3::Zero();
  for (const Vector3& p : Resample(line, 0.005)) {
    spread += (p - centre) * (p - centre).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(spread);
  Matrix3 axes;
  axes.col(0) = solver.eigenvectors().col(2);
  if (axes.col(0).dot(line.back() - line.front()) < 0) axes.col(0) = -axes.col(0);
  axes.col(1) = solver.eigenvectors().col(1);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return Transformed(MakeTransform(axes, centre).inverse(), line);
}

}  // namespace

Polyline DrawShape(const Part& part, RandomStream& stream) {
  Polyline line;
  if (part.shape == "hooks") {
    line = DrawHooks(part, stream);
  } else if (part.shape == "polyline") {
    line = DrawCorners(part, stream);
  } else if (part.shape == "fixed") {
    line = part.centerline();
  } else {
    line = DrawArcs(part, stream);
  }
  if (part.is_hose()) {
    line = ResampleCount(line, part.links + 1);
  } else if (part.shape != "polyline" && part.shape != "fixed") {
    line = ResampleCount(line, kRigidPieces + 1);
  }
  // Chords are shorter than arcs: bring the whole to its length.
  const double scale = part.length_m / Length(line);
  for (Vector3& p : line) p *= scale;
  return Aligned(line);
}

}  // namespace tubetwin
