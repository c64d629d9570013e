#include "perception/part_import/tube_of_mesh.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "perception/fragment/local_radius.h"
#include "perception/part_import/mesh_axis.h"
#include "perception/part_import/wall_sections.h"

namespace tubetwin {
namespace {

constexpr int kRounds = 5;
/// The radius counts as found when it moves by less than this share.
constexpr double kSettled = 0.002;
constexpr double kLargestSpread = 0.10;
constexpr double kMinRound = 0.25;
constexpr double kShortest = 4.0;  ///< Least length in radii.
/// Parts end at 3 and 40 mm and at 2 m (models/part.h); a first look may be this much off.
constexpr double kThinnest_m = 0.003, kThickest_m = 0.04, kLongest_m = 2.0, kLeeway = 1.1;
/// Sections whose radius is this much off the median are counted as another radius.
constexpr double kOtherRadius = 0.05;
/// Sections of less wall say little of a radius, nor do those of rounded ends.
constexpr double kWholeSection = 0.8, kUprightWall = 0.2;
/// Surface further out than this many radii is not the tube's, and how much of that may be.
constexpr double kOutside = 1.15, kMaxOutside = 0.02;

std::string Mm(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * m);
  return text;
}

std::string Percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

MeshTube Refusal(MeshVerdict verdict, const std::string& reason) {
  MeshTube out;
  out.verdict = verdict;
  out.reason = reason;
  return out;
}

/// Value below which `share` of the weight lies. Sorts its argument.
double Quantile(std::vector<std::pair<double, double>>& value_and_weight, double share) {
  std::sort(value_and_weight.begin(), value_and_weight.end());
  double total = 0.0, sum = 0.0;
  for (const auto& [value, weight] : value_and_weight) total += weight;
  for (const auto& [value, weight] : value_and_weight) {
    sum += weight;
    if (sum >= share * total) return value;
  }
  return value_and_weight.back().first;
}

/// How a point of the surface lies about the axis, which is prolonged straight at both ends.
struct Place {
  double rho = 0.0;       ///< Distance from the prolonged axis.
  double distance = 0.0;  ///< Distance from the axis itself.
  double out = 0.0;       ///< Normal along the direction away from the axis.
  double along = 0.0;     ///< Normal along the axis.
  /// Rounded ends are none of it.
  bool wall() const { return out > 0.7 && std::abs(along) < 0.5; }
  bool bore() const { return out < -0.7; }
};

Place PlaceOf(const MeshPoint& point, const Polyline& line, double length_m, double window_m) {
  const ClosestOnLine foot = Closest(line, point.p);
  const Vector3 t = TangentAt(line, foot.s_m, window_m);
  Vector3 d = point.p - foot.point;
  Place place;
  place.distance = d.norm();
  if (foot.s_m <= 0.0 || foot.s_m >= length_m) d -= d.dot(t) * t;
  place.rho = d.norm();
  place.out = place.rho > 0.0 ? point.n.dot(d) / place.rho : 0.0;
  place.along = point.n.dot(t);
  return place;
}

/// Radius and radii of a mesh about an axis.
MeshTube Measure(const Mesh& mesh, const Polyline& line, double radius_m) {
  MeshTube tube;
  tube.line = line;
  tube.length_m = Length(line);
  const double window_m = 0.4 * radius_m;
  std::vector<std::pair<double, double>> corners, samples;  // Radius and area.
  double squares = 0.0;
  for (const MeshPoint& corner : FaceCorners(mesh)) {
    const Place place = PlaceOf(corner, line, tube.length_m, window_m);
    if (place.wall()) corners.emplace_back(place.rho, corner.area);
  }
  double bore = 0.0, total = 0.0;
  for (const MeshPoint& sample : SampleSurface(mesh, 20'000)) {
    const Place place = PlaceOf(sample, line, tube.length_m, window_m);
    total += sample.area;
    if (place.bore()) bore += sample.area;
    if (!place.wall()) continue;
    tube.wall.push_back(sample);
    samples.emplace_back(place.rho, sample.area);
  }
  if (corners.empty() || samples.empty()) return tube;
  tube.radius_m = Quantile(corners, 0.5);
  tube.radius_spread = (Quantile(samples, 0.90) - Quantile(samples, 0.10)) / tube.radius_m;
  for (const auto& [rho, area] : samples) {
    squares += (rho - tube.radius_m) * (rho - tube.radius_m);
    tube.max_m = std::max(tube.max_m, std::abs(rho - tube.radius_m));
  }
  tube.rms_m = std::sqrt(squares / static_cast<double>(samples.size()));
  tube.hollow = bore > 0.05 * total;
  return tube;
}

/// Least and largest radius along the axis, and how much of it has another radius than most.
void MeasureSections(const std::vector<WallSection>& sections, MeshTube& tube) {
  std::vector<double> radii;
  for (const WallSection& section : sections) {
    if (section.seen < kWholeSection || section.slope > kUprightWall) continue;
    radii.push_back(section.radius_m);
  }
  if (radii.empty()) return;
  std::sort(radii.begin(), radii.end());
  tube.min_radius_m = radii.front();
  tube.max_radius_m = radii.back();
  const double median = radii[radii.size() / 2];
  const auto other = std::count_if(radii.begin(), radii.end(), [&](double radius) {
    return std::abs(radius / median - 1.0) > kOtherRadius;
  });
  tube.other_radius_share = static_cast<double>(other) / static_cast<double>(radii.size());
}

/// Share of the surface that lies beyond the tube.
double ShareOutside(const Mesh& mesh, const MeshTube& tube) {
  constexpr int kSamples = 10'000;
  int outside = 0;
  for (const MeshPoint& sample : SampleSurface(mesh, kSamples)) {
    outside += Closest(tube.line, sample.p).distance_m > kOutside * tube.radius_m;
  }
  return static_cast<double>(outside) / kSamples;
}

/// Whether an end runs on into the tube elsewhere: the axis of a ring goes on over its own start.
/// That a tube touches itself makes no ring.
bool RunsIntoItself(const MeshTube& tube) {
  constexpr double kParallel = 0.9;
  const double away_m = kShortest * tube.radius_m, window_m = tube.radius_m;
  const auto runs_on = [&](const Polyline& rest, const Vector3& end, const Vector3& tangent) {
    const ClosestOnLine foot = Closest(rest, end);
    return foot.distance_m < 0.5 * tube.radius_m &&
           std::abs(TangentAt(rest, foot.s_m, window_m).dot(tangent)) > kParallel;
  };
  return runs_on(SubLine(tube.line, away_m, tube.length_m), tube.line.front(),
                 TangentAt(tube.line, 0.0, window_m)) ||
         runs_on(SubLine(tube.line, 0.0, tube.length_m - away_m), tube.line.back(),
                 TangentAt(tube.line, tube.length_m, window_m));
}

/// Whether a second axis is a branch. Shorter ones, and those about a flange's rim, are surface
/// outside of the tube.
bool LeadsAway(const Polyline& branch, const MeshTube& tube) {
  constexpr double kAway = 3.0;  // Radii.
  return Length(branch) >= kShortest * tube.radius_m &&
         std::any_of(branch.begin(), branch.end(), [&tube](const Vector3& p) {
           return Closest(tube.line, p).distance_m > kAway * tube.radius_m;
         });
}

MeshTube Judge(MeshTube tube, const std::vector<Polyline>& axes, const std::vector<Mesh>& pieces) {
  const auto refuse = [&tube](MeshVerdict verdict, const std::string& reason) {
    tube.verdict = verdict;
    tube.reason = reason;
  };
  const double r = tube.radius_m;
  if (axes.size() > 1 && LeadsAway(axes[1], tube)) {
    refuse(MeshVerdict::kBranches, "it branches: besides an axis of " + Mm(tube.length_m) +
                                       " there is one of " + Mm(Length(axes[1])) +
                                       "; a tube has one axis and two ends");
  } else if (RunsIntoItself(tube)) {
    refuse(MeshVerdict::kClosed, "it is a ring; a tube has two ends");
  } else if (tube.radius_spread > kLargestSpread) {
    refuse(MeshVerdict::kRadiusSpread, "its radius, " + Mm(r) + ", spreads by " +
                                           Percent(tube.radius_spread) +
                                           "; a tube's spreads by at most 10 %");
  } else if (tube.length_m < kShortest * r) {
    refuse(MeshVerdict::kNoAxis, "its axis is " + Mm(tube.length_m) + " long at a radius of " +
                                     Mm(r) + "; a tube is at least four radii long");
  } else if (const double outside = ShareOutside(pieces.front(), tube); outside > kMaxOutside) {
    refuse(MeshVerdict::kOtherSurface, Percent(outside) +
                                           " of its surface lies outside of the tube of radius " +
                                           Mm(r) + " that it otherwise is; at most 2 % may");
  } else {
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      for (const Vector3& v : pieces[i].vertices) {
        if (Closest(tube.line, v).distance_m <= kOutside * r) continue;
        refuse(MeshVerdict::kSeveralBodies,
               "it holds " + std::to_string(pieces.size()) +
                   " bodies that are not connected; export one tube alone");
        return tube;
      }
    }
  }
  return tube;
}

}  // namespace

MeshTube FindTubeOfMesh(const Mesh& mesh, Parallelism parallelism) {
  const std::vector<Mesh> pieces = ConnectedPieces(mesh);
  TT_CHECK(!pieces.empty());
  const Mesh& body = pieces.front();
  const LocalRadius local = FindLocalRadius(body);
  if (local.round_share < kMinRound) {
    return Refusal(MeshVerdict::kNotRound, "only " + Percent(local.round_share) +
                                               " of its surface is round; a tube's is but for its "
                                               "ends");
  }
  if (local.radius_m * kLeeway < kThinnest_m || local.radius_m > kThickest_m * kLeeway ||
      body.BoxSize().norm() > kLongest_m * kLeeway) {
    return Refusal(MeshVerdict::kWrongSize,
                   "it is round with a radius of " + Mm(local.radius_m) + " in a box of diagonal " +
                       Mm(body.BoxSize().norm()) +
                       "; a part has a radius of 3 to 40 mm and is up to 2 m long");
  }
  double radius_m = local.radius_m, area_m2 = 0.0;
  for (const MeshPoint& corner : FaceCorners(body)) area_m2 += corner.area;
  const std::vector<MeshPoint> surface =
      RoundSurface(local, SampleSurface(body, PointsForAxes(area_m2, radius_m)));
  MeshTube tube;
  std::vector<Polyline> axes;
  for (int round = 0; round < kRounds; ++round) {
    axes = FindAxes(surface, radius_m, parallelism);
    if (axes.empty()) break;
    tube = Measure(body, axes.front(), radius_m);
    if (!(tube.radius_m > 0.0)) break;
    const double change = std::abs(tube.radius_m / radius_m - 1.0);
    radius_m = tube.radius_m;
    if (change < kSettled) break;
  }
  if (axes.empty() || !(tube.radius_m > 0.0)) {
    if (local.high_m > 1.25 * local.low_m) {
      return Refusal(MeshVerdict::kRadiusSpread, "it is round with radii from " + Mm(local.low_m) +
                                                     " to " + Mm(local.high_m) +
                                                     "; a tube's radius spreads by at most 10 %");
    }
    return Refusal(MeshVerdict::kNoAxis,
                   "it is round with a radius of " + Mm(local.radius_m) +
                       ", but about no axis of at least four radii; that is no tube");
  }
  std::vector<MeshPoint> ends = FaceCorners(body);
  ends.insert(ends.end(), surface.begin(), surface.end());
  const SectionedAxis axis =
      CentreInSections(WallCutter(body), ends, axes.front(), radius_m, parallelism);
  if (axis.line.empty()) {
    return Refusal(MeshVerdict::kOpenWall,
                   "about its axis of " + Mm(tube.length_m) + " there is wall on less than " +
                       "60 % of the way around; a tube is closed all around");
  }
  tube = Measure(body, axis.line, radius_m);
  MeasureSections(axis.sections, tube);
  if (pieces.size() == 1) tube.volume_m3 = EnclosedVolume(body);
  return Judge(std::move(tube), axes, pieces);
}

}  // namespace tubetwin
