// Forty random thin or bent tubes, and tubes with something at their end, as meshes in files.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "models/base/files.h"
#include "perception/part_import/tube_of_mesh.h"
#include "tests/support/catch.h"
#include "tests/support/random_tube.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

constexpr double kOff_m = 0.0005, kOff_deg = 1.0;

/// Largest distance between two axes, each from the other, and angle between their directions over
/// two radii.
struct Errors {
  double off_m = 0.0, angle_deg = 0.0;
  void Take(const Errors& other) {
    off_m = std::max(off_m, other.off_m);
    angle_deg = std::max(angle_deg, other.angle_deg);
  }
};

Errors Between(const Polyline& found, const Polyline& truth, double radius_m) {
  Errors out;
  const Polyline fine = Resample(truth, 0.25 * radius_m);
  for (const Vector3& p : Resample(found, 0.25 * radius_m)) {
    out.off_m = std::max(out.off_m, Closest(truth, p).distance_m);
  }
  const double window_m = 2.0 * radius_m;
  const std::vector<double> at = ArcLengths(fine);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const ClosestOnLine foot = Closest(found, fine[i]);
    out.off_m = std::max(out.off_m, foot.distance_m);
    const double cosine =
        std::abs(TangentAt(fine, at[i], window_m).dot(TangentAt(found, foot.s_m, window_m)));
    out.angle_deg = std::max(out.angle_deg, Degrees(std::acos(std::min(1.0, cosine))));
  }
  return out;
}

MeshTube FoundInFile(const RandomTube& tube) {
  const TemporaryFolder folder;
  const std::string path = folder / "tube.stl";
  WriteFileAtomically(path, BinaryStl(tube.mesh, tube.scale));
  Mesh mesh = ReadMesh(path);
  ScaleToMetres(mesh, tube.unit, path, "--units");
  return FindTubeOfMesh(mesh, Parallelism{2});
}

/// Why a tube with a feature may be refused: what is true of it.
bool TrueReason(TubeFeature feature, MeshVerdict verdict) {
  switch (feature) {
    case TubeFeature::kNone:
      return false;
    case TubeFeature::kSpigot:
    case TubeFeature::kTaper:
      return verdict == MeshVerdict::kRadiusSpread;
    case TubeFeature::kBead:
    case TubeFeature::kFlange:
      return verdict == MeshVerdict::kRadiusSpread || verdict == MeshVerdict::kOtherSurface;
  }
  return false;
}

void CheckMany(TubeFeature feature, std::uint64_t first, int count) {
  Errors worst;
  int accepted = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
    const RandomTube tube = MakeRandomTube(seed, feature);
    const MeshTube found = FoundInFile(tube);
    INFO(tube.text << "\n" << found.reason);
    if (found.verdict != MeshVerdict::kTube) {
      CHECK(TrueReason(feature, found.verdict));
      continue;
    }
    ++accepted;
    const Errors errors = Between(found.line, tube.line, tube.radius_m);
    CHECK(errors.off_m < kOff_m);
    CHECK(errors.angle_deg < kOff_deg);
    CHECK(found.radius_m == Approx(tube.radius_m).epsilon(0.05));
    worst.Take(errors);
  }
  std::printf("%s: %d of %d accepted, axis off by at most %.3f mm and %.2f degrees\n",
              ToString(feature), accepted, count, 1e3 * worst.off_m, worst.angle_deg);
}

/// TUBETWIN_TUBES=N: N of each in place of the number below.
int Count(int usual) {
  const char* more = std::getenv("TUBETWIN_TUBES");
  return more != nullptr ? std::atoi(more) : usual;
}

TEST_CASE("The axis of forty random thin or bent tubes is found", "[perception]") {
  CheckMany(TubeFeature::kNone, 1, Count(40));
}

TEST_CASE("Spigot, bead, flange and taper bend no axis, or are refused for what they are",
          "[perception]") {
  for (const TubeFeature feature :
       {TubeFeature::kSpigot, TubeFeature::kBead, TubeFeature::kFlange, TubeFeature::kTaper}) {
    CheckMany(feature, 1, Count(5));
  }
}

}  // namespace
}  // namespace tubetwin
