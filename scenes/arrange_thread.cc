#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "models/base/error.h"
#include "models/base/rotation.h"
#include "scenes/arrange.h"

namespace tubetwin::arrange {
namespace {

using Vector2 = Eigen::Vector2d;

constexpr int kLayouts = 600;           // Drawn until one can be laid.
constexpr int kSweeps = 400;            // Over all conditions of one layout.
constexpr double kShift = 0.1;          // Of a ring's middle, share of the half sides.
constexpr double kJitter_deg = 12.0;    // Of a tube's place and direction on its ring.
constexpr double kUsualTilt = 0.3;      // Rise over run that the tightest ring needs.
constexpr double kGap_m = 0.003;        // Between tubes that cross.
constexpr double kMaxTilt = 0.5;        // Rise over run.
constexpr double kTurnRadius_m = 0.15;  // Weighs tilting against lifting.
constexpr double kSlack_m = 0.0015;     // What a condition may miss; settling lets it apart.
constexpr double kLayingBin_m = 2.0;

// A tube as it lies alone, and the plane it is lifted to: height and slopes at its middle.
struct Laid {
  PileTube flat;  // On the floor, its middle over the origin.
  double yaw_rad = 0.0;
  Vector2 middle = Vector2::Zero();
  Polyline line;                   // Turned and moved, not lifted.
  Vector3 lift = Vector3::Zero();  // Height, slope along x, slope along y.

  Vector3 Gradient(const Vector3& p) const { return {1.0, p.x() - middle.x(), p.y() - middle.y()}; }
  double HeightAt(const Vector3& p) const { return p.z() + lift.dot(Gradient(p)); }
  RigidTransform X_NFlat() const {
    // Exact rotation of the plane with these slopes.
    const Vector3 normal = Vector3(-lift.y(), -lift.z(), 1.0).normalized();
    const Matrix3 tilt = RotationBetween(Vector3::UnitZ(), normal).toRotationMatrix();
    return MakeTransform(tilt * RotZ(yaw_rad), Vector3(middle.x(), middle.y(), lift.x()));
  }
};

// Where two tubes cross seen from above.
struct Meeting {
  std::size_t over, under;
  Vector3 at_over, at_under;  // On the unlifted lines.
};

// A tube settled alone on a wide floor.
std::optional<PileTube> LayAlone(const Order& order, int id, RandomStream& stream) {
  const Part part = SpecimenPart(order, id);
  const Polyline shape = DrawShape(part, stream);
  Pile alone = EmptyPile(order);
  alone.bin.size_m = {kLayingBin_m, kLayingBin_m, 0.05};
  const double roll = stream.Uniform(0.0, 2 * kPi);
  RigidTransform X_NShape = MakeTransform(RotX(roll), Vector3::Zero());
  double lowest = 0.0;
  for (const Vector3& p : Transformed(X_NShape, shape)) lowest = std::min(lowest, p.z());
  X_NShape.translation().z() = order.part.radius_m + 0.002 - lowest;
  alone.tubes = {MakeTube(part, id, shape, X_NShape)};
  const SettleResult result = SettlePile(alone, order.physics);
  if (result.status != SettleStatus::kSettled) return std::nullopt;
  PileTube tube = result.pile.tubes[0];
  const Vector3 centre = CurveCentre(tube.centerline_N);
  const RigidTransform X_home = Translation(-centre.x(), -centre.y(), 0.0);
  tube.centerline_N = Transformed(X_home, tube.centerline_N);
  return tube;
}

// Puts the tubes around a circle, each along its tangent and rising forwards, so that each lies
// over the ones ahead of it and under the ones behind: a reciprocal frame, closed around.
void PlaceRing(const Order& order, std::vector<Laid>& ring, RandomStream& stream) {
  const double count = static_cast<double>(ring.size());
  // Neighbours' tangents meet at radius * tan(pi / count); there the rise must be one diameter.
  const double lever = std::tan(kPi / count);
  const double min_m = (order.part.radius_m + 0.5 * kGap_m) / (kUsualTilt * lever);
  const double radius_m = min_m * stream.Uniform(1.0, 1.6);
  const double slope = (order.part.radius_m + 0.5 * kGap_m) / (radius_m * lever);
  const double start_rad = stream.Uniform(0.0, 2 * kPi);
  const double sense = stream.Uniform() < 0.5 ? -1.0 : 1.0;
  const double shift_x = stream.Uniform(-kShift, kShift) * order.bin.half_x_m();
  const double shift_y = stream.Uniform(-kShift, kShift) * order.bin.half_y_m();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double angle = start_rad + sense * 2 * kPi * static_cast<double>(i) / count +
                         Radians(stream.Uniform(-kJitter_deg, kJitter_deg));
    const double forward = angle + sense * kPi / 2;
    const double jitter = Radians(stream.Uniform(-kJitter_deg, kJitter_deg));
    const double turned = stream.Uniform() < 0.5 ? kPi : 0.0;  // Either end ahead.
    Laid& tube = ring[i];
    tube.yaw_rad = forward + jitter + turned;
    tube.middle = {shift_x + radius_m * std::cos(angle), shift_y + radius_m * std::sin(angle)};
    tube.lift.setZero();
    tube.line = Transformed(tube.X_NFlat(), tube.flat.centerline_N);
    tube.lift.tail<2>() = slope * Vector2(std::cos(forward), std::sin(forward));
  }
}

bool InsideWalls(const Order& order, const Polyline& line) {
  const double r = order.part.radius_m;
  return std::all_of(line.begin(), line.end(), [&](const Vector3& p) {
    return std::abs(p.x()) < order.bin.half_x_m() - r && std::abs(p.y()) < order.bin.half_y_m() - r;
  });
}

// Proper crossing of two segments seen from above: parameters on both.
bool Cross(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1, double& s,
           double& t) {
  const Vector2 da = (a1 - a0).head<2>(), db = (b1 - b0).head<2>(), w = (b0 - a0).head<2>();
  const double det = da.x() * db.y() - da.y() * db.x();
  if (std::abs(det) < 1e-12) return false;
  s = (w.x() * db.y() - w.y() * db.x()) / det;
  t = (w.x() * da.y() - w.y() * da.x()) / det;
  return s >= 0 && s < 1 && t >= 0 && t < 1;
}

// All crossings of a ring's tubes: over is the one that has the other ahead of it, going round the
// shorter way.
std::vector<Meeting> FindMeetings(const std::vector<Laid>& ring) {
  std::vector<Meeting> meetings;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    for (std::size_t j = i + 1; j < ring.size(); ++j) {
      const bool i_over = 2 * (j - i) <= ring.size();
      const Polyline &a = ring[i].line, &b = ring[j].line;
      for (std::size_t m = 0; m + 1 < a.size(); ++m) {
        for (std::size_t n = 0; n + 1 < b.size(); ++n) {
          double s = 0, t = 0;
          if (!Cross(a[m], a[m + 1], b[n], b[n + 1], s, t)) continue;
          const Vector3 at_i = a[m] + s * (a[m + 1] - a[m]), at_j = b[n] + t * (b[n + 1] - b[n]);
          meetings.push_back(i_over ? Meeting{i, j, at_i, at_j} : Meeting{j, i, at_j, at_i});
        }
      }
    }
  }
  return meetings;
}

// Is every tube under another?
bool AllCovered(const std::vector<Meeting>& meetings, std::size_t count) {
  std::set<std::size_t> covered;
  for (const Meeting& m : meetings) covered.insert(static_cast<std::size_t>(m.under));
  return covered.size() == count;
}

// Moves the planes of up to two tubes by the least that closes a shortfall of height `missing_m`.
void Push(Laid* up, const Vector3& p_up, Laid* down, const Vector3& p_down, double missing_m) {
  const Vector3 ease(1.0, 1.0 / (kTurnRadius_m * kTurnRadius_m),
                     1.0 / (kTurnRadius_m * kTurnRadius_m));
  const Vector3 g_up = up->Gradient(p_up);
  double sum = g_up.cwiseAbs2().dot(ease);
  Vector3 g_down = Vector3::Zero();
  if (down != nullptr) {
    g_down = down->Gradient(p_down);
    sum += g_down.cwiseAbs2().dot(ease);
  }
  up->lift += ease.cwiseProduct(g_up) * (missing_m / sum);
  if (down != nullptr) down->lift -= ease.cwiseProduct(g_down) * (missing_m / sum);
}

// Lifts and tilts the tubes until each meeting has its order and none is in the floor.
// False when they cannot be, within bounds.
bool Lift(std::vector<Laid>& tubes, const std::vector<Meeting>& meetings, double radius_m) {
  double worst_m = 0.0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    worst_m = 0.0;
    for (const Meeting& m : meetings) {
      Laid &over = tubes[m.over], &under = tubes[m.under];
      const double missing_m =
          2 * radius_m + kGap_m - (over.HeightAt(m.at_over) - under.HeightAt(m.at_under));
      if (missing_m > 0) Push(&over, m.at_over, &under, m.at_under, missing_m);
      worst_m = std::max(worst_m, missing_m);
    }
    for (Laid& tube : tubes) {
      for (const Vector3& p : tube.line) {
        const double missing_m = radius_m - tube.HeightAt(p);
        if (missing_m > 0) Push(&tube, p, nullptr, p, missing_m);
        worst_m = std::max(worst_m, missing_m);
      }
    }
    if (worst_m < 0.2 * kSlack_m) break;
  }
  if (worst_m > kSlack_m) return false;
  return std::all_of(tubes.begin(), tubes.end(),
                     [](const Laid& tube) { return tube.lift.tail<2>().norm() < kMaxTilt; });
}

// The lifted tubes, lowest point at `floor_m`; nothing when exact rotation makes any two
// interpenetrate or one reach over the walls.
std::optional<std::vector<PileTube>> Build(const Order& order, const std::vector<Laid>& ring,
                                           double floor_m) {
  std::vector<PileTube> tubes;
  for (const Laid& laid : ring) {
    PileTube tube = laid.flat;
    tube.centerline_N = Transformed(Translation(0, 0, floor_m) * laid.X_NFlat(), tube.centerline_N);
    if (!InsideWalls(order, tube.centerline_N)) return std::nullopt;
    for (const PileTube& other : tubes) {
      const double gap_m = ClosestOfLines(tube.centerline_N, other.centerline_N).distance_m -
                           2 * order.part.radius_m;
      if (gap_m < -kSlack_m) return std::nullopt;
    }
    tubes.push_back(tube);
  }
  return tubes;
}

// Sizes of the rings that `count` tubes are laid in, each 3 to 7 (fewer than three: one ring, which
// cannot close).
std::vector<int> DrawRings(int count, RandomStream& stream) {
  const int min_rings = (count + 6) / 7;
  const int max_rings = std::max(min_rings, std::min(count / 3, min_rings + 1));
  const int rings =
      min_rings +
      static_cast<int>(stream.Index(static_cast<std::uint32_t>(max_rings - min_rings + 1)));
  std::vector<int> sizes(static_cast<std::size_t>(rings), count / rings);
  for (int i = 0; i < count % rings; ++i) ++sizes[static_cast<std::size_t>(i)];
  return sizes;
}

std::optional<std::vector<PileTube>> LayRing(const Order& order, std::vector<Laid>& ring,
                                             double floor_m, const RandomStream& stream) {
  for (int layout = 0; layout < kLayouts; ++layout) {
    RandomStream draws = stream.Fork("layout", static_cast<std::uint64_t>(layout));
    PlaceRing(order, ring, draws);
    const std::vector<Meeting> meetings = FindMeetings(ring);
    if (ring.size() >= 3 && !AllCovered(meetings, ring.size())) continue;
    if (!Lift(ring, meetings, order.part.radius_m)) continue;
    if (auto tubes = Build(order, ring, floor_m)) return tubes;
  }
  return std::nullopt;
}

}  // namespace

SettleResult Thread(const Order& order, RandomStream stream) {
  SettleResult failed;
  failed.status = SettleStatus::kEscaped;
  failed.pile = EmptyPile(order);
  failed.reason = "no layout was found in which every tube lies under another";
  Pile pile = EmptyPile(order);
  double top_m = 0.0;
  for (const int size : DrawRings(order.count, stream)) {
    std::vector<Laid> ring(static_cast<std::size_t>(size));
    const std::size_t first = pile.tubes.size();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      RandomStream draws = stream.Fork("tube", first + i);
      const auto flat = LayAlone(order, static_cast<int>(first + i) + 1, draws);
      if (!flat) return failed;
      ring[i].flat = *flat;
    }
    const auto tubes = LayRing(order, ring, top_m, stream.Fork("ring", first));
    if (!tubes) return failed;
    for (const PileTube& tube : *tubes) {
      pile.tubes.push_back(tube);
      for (const Vector3& p : tube.centerline_N) {
        top_m = std::max(top_m, p.z() + order.part.radius_m);
      }
    }
  }
  return SettlePile(pile, order.physics);
}

}  // namespace tubetwin::arrange
