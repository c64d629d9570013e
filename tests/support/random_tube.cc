#include "tests/support/random_tube.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "models/base/random.h"

namespace tubetwin {
namespace {

/// A line with the bends that were drawn, in rings' centres.
struct Sweep {
  Polyline line;
  std::string text;
};

Sweep DrawLine(RandomStream& stream, double radius_m, double length_m, double last_m) {
  const int bends = static_cast<int>(stream.Index(5));
  const double ring_deg = stream.Uniform(3.0, 12.0);
  std::ostringstream text;
  Sweep out;
  Matrix3 R = Matrix3::Identity();
  Vector3 p = Vector3::Zero();
  out.line.push_back(p);
  const auto straight = [&](double piece_m) {
    p += piece_m * R.col(0);
    out.line.push_back(p);
  };
  for (int i = 0; i < bends; ++i) {
    const double angle = Radians(stream.Uniform(10.0, 120.0));
    const double bend_m = radius_m * stream.Uniform(1.8, 10.0);
    straight(length_m / (bends + 1.0) * stream.Uniform(0.3, 1.0));
    R = R * RotX(stream.Uniform(0.0, 2.0 * kPi));
    const int rings = std::max(2, static_cast<int>(std::ceil(Degrees(angle) / ring_deg)));
    // Chords between points of the arc.
    const double chord_m = 2.0 * bend_m * std::sin(0.5 * angle / rings);
    for (int k = 0; k < rings; ++k) {
      R = R * RotZ(0.5 * angle / rings);
      straight(chord_m);
      R = R * RotZ(0.5 * angle / rings);
    }
    text << " bend " << Degrees(angle) << " deg R " << 1e3 * bend_m << " mm";
  }
  straight(std::max(last_m, length_m / (bends + 1.0)));
  out.text = text.str();
  return out;
}

bool TouchesItself(const Polyline& line, double radius_m) {
  const Polyline fine = Resample(line, 0.5 * radius_m);
  const std::vector<double> at = ArcLengths(fine);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    for (std::size_t k = i + 1; k < fine.size(); ++k) {
      // Both sides of the tightest bend are 3.6 radii apart after half a turn.
      if (at[k] - at[i] > 5.0 * radius_m && (fine[k] - fine[i]).norm() < 2.6 * radius_m) {
        return true;
      }
    }
  }
  return false;
}

/// Rings before the end, in metres from it, with their radius in shares of the tube's.
struct ProfileStep {
  double before_m, share;
};

/// Shoulders are as good as upright, but rings have to follow one another.
constexpr double kShoulder_m = 1e-5;

std::vector<ProfileStep> ProfileOf(TubeFeature feature, RandomStream& stream, double r,
                                   double length_m, std::ostringstream& text) {
  switch (feature) {
    case TubeFeature::kNone:
      return {};
    case TubeFeature::kTaper: {
      const double share = stream.Uniform(0.75, 1.25);
      text << " taper to " << share;
      return {{length_m, 1.0}, {0.0, share}};
    }
    case TubeFeature::kSpigot: {
      const double share = stream.Uniform(0.7, 0.93), long_m = r * stream.Uniform(0.6, 4.0);
      text << " spigot " << share << " over " << 1e3 * long_m << " mm";
      return {{long_m + kShoulder_m, 1.0}, {long_m, share}, {0.0, share}};
    }
    case TubeFeature::kFlange: {
      const double share = stream.Uniform(1.2, 2.4), long_m = stream.Uniform(0.001, 0.004);
      text << " flange " << share << " over " << 1e3 * long_m << " mm";
      return {{long_m + kShoulder_m, 1.0}, {long_m, share}, {0.0, share}};
    }
    case TubeFeature::kBead: {
      const double high = stream.Uniform(0.04, 0.15), long_m = r * stream.Uniform(0.3, 1.0);
      const double after_m = stream.Uniform() < 0.5 ? 0.0 : r * stream.Uniform(0.2, 1.5);
      text << " bead " << high << " over " << 1e3 * long_m << " mm, " << 1e3 * after_m
           << " mm before the end";
      std::vector<ProfileStep> rings;
      constexpr int kRings = 8;
      for (int i = 0; i <= kRings; ++i) {
        const double share = static_cast<double>(i) / kRings;
        rings.push_back({after_m + long_m * (1.0 - share), 1.0 + high * std::sin(kPi * share)});
      }
      if (after_m > 0.0) rings.push_back({0.0, 1.0});
      return rings;
    }
  }
  return {};
}

/// Puts the rings into the last straight piece, or, for a taper, over the whole line.
std::vector<double> AddRings(const std::vector<ProfileStep>& rings, double r, TubeFeature feature,
                             Polyline& line) {
  if (feature == TubeFeature::kTaper) {
    std::vector<double> radii = ArcLengths(line);
    const double length_m = radii.back();
    for (double& s : radii) s = r * (1.0 + (rings.back().share - 1.0) * s / length_m);
    return radii;
  }
  std::vector<double> radii(line.size(), r);
  if (rings.empty()) return radii;
  const Vector3 end = line.back();
  const Vector3 t = (end - line[line.size() - 2]).normalized();
  line.pop_back();
  radii.pop_back();
  for (const ProfileStep& ring : rings) {
    line.push_back(end - ring.before_m * t);
    radii.push_back(r * ring.share);
  }
  return radii;
}

}  // namespace

const char* ToString(TubeFeature feature) {
  static const char* const kNames[] = {"none", "spigot", "bead", "flange", "taper"};
  return kNames[static_cast<int>(feature)];
}

RandomTube MakeRandomTube(std::uint64_t seed, TubeFeature feature) {
  RandomStream stream(seed, static_cast<std::uint64_t>(feature), "random tube");
  RandomTube out;
  std::ostringstream text;
  out.radius_m =
      stream.Index(3) == 0 ? stream.Uniform(0.008, 0.030) : stream.Uniform(0.0032, 0.008);
  const double r = out.radius_m;
  const double length_m = std::max(14.0 * r, stream.Uniform(0.08, 0.6));
  Sweep sweep;
  do {
    sweep = DrawLine(stream, r, length_m, 6.0 * r);
  } while (TouchesItself(sweep.line, r) || Length(sweep.line) > 1.8);
  out.line = sweep.line;
  TubeMeshOptions options;
  options.sides = 10 + static_cast<int>(stream.Index(39));
  const bool plain_ends = feature != TubeFeature::kNone;
  options.ends = static_cast<TubeMeshOptions::Ends>(stream.Index(plain_ends ? 2 : 3));
  if (options.ends != TubeMeshOptions::Ends::kRound && stream.Uniform() < 0.5) {
    options.bore_m = r * stream.Uniform(0.3, 0.68);
  }
  text << ToString(feature) << " seed " << seed << ": r " << 1e3 * r << " mm, L "
       << 1e3 * Length(out.line) << " mm, " << options.sides << " sides, ends "
       << static_cast<int>(options.ends) << ", bore " << 1e3 * options.bore_m << " mm"
       << sweep.text;
  const std::vector<ProfileStep> rings = ProfileOf(feature, stream, r, Length(out.line), text);
  options.radii_m = AddRings(rings, r, feature, out.line);
  const Vector3 axis(stream.Normal(), stream.Normal(), stream.Normal());
  const Matrix3 R =
      Eigen::AngleAxisd(stream.Uniform(0.0, 2.0 * kPi), axis.normalized()).toRotationMatrix();
  const Vector3 p(stream.Uniform(-1, 1), stream.Uniform(-1, 1), stream.Uniform(-1, 1));
  for (Vector3& node : out.line) node = R * node + p;
  out.mesh = MakeTubeMesh(out.line, r, options);
  const std::pair<const char*, double> units[] = {
      {"mm", 1e3}, {"cm", 1e2}, {"in", 1.0 / 0.0254}, {"m", 1.0}};
  const auto& unit = units[stream.Index(4)];
  out.unit = unit.first;
  out.scale = unit.second;
  out.text = text.str() + ", " + out.unit;
  return out;
}

}  // namespace tubetwin
