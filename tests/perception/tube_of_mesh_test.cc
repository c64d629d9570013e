#include "perception/part_import/tube_of_mesh.h"

#include "models/part.h"
#include "scenes/pile.h"
#include "tests/support/catch.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

using Ends = TubeMeshOptions::Ends;

// What an import must keep to; the worst seen is 0.5 % and 0.2 %.
constexpr double kLengthShare = 0.01, kRadiusShare = 0.02;
// The axis lies in the tube's own axis but for mitred corners, which it rounds.
constexpr double kAxis_m = 0.0015;

const Polyline kStraight = {Vector3(0, 0, 0), Vector3(0.4, 0, 0)};

/// Both tubes in one surface, as a weld would leave them.
Mesh Welded(const Mesh& a, const Mesh& b) {
  Mesh out = Together(a, b);
  out.faces.push_back({0, static_cast<int>(a.vertices.size()), 1});
  return out;
}

Mesh WindingMixed(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    std::swap(mesh.faces[i][0], mesh.faces[i][1]);
  }
  return mesh;
}

void CheckTube(const Mesh& mesh, const Polyline& line, double radius_m) {
  const MeshTube tube = FindTubeOfMesh(mesh, Parallelism{});
  INFO(tube.reason);
  REQUIRE(tube.verdict == MeshVerdict::kTube);
  CHECK(tube.length_m == Approx(Length(line)).epsilon(kLengthShare));
  CHECK(tube.radius_m == Approx(radius_m).epsilon(kRadiusShare));
  double off_m = 0.0;
  for (const Vector3& p : tube.line) off_m = std::max(off_m, Closest(line, p).distance_m);
  CHECK(off_m < kAxis_m);
}

void CheckNoTube(const Mesh& mesh, MeshVerdict verdict, const std::string& said) {
  const MeshTube tube = FindTubeOfMesh(mesh, Parallelism{});
  INFO(tube.reason);
  CHECK(static_cast<int>(tube.verdict) == static_cast<int>(verdict));
  CHECK_THAT(tube.reason, Catch::Contains(said));
}

TEST_CASE("Length and radius of the mesh of every shipped part are found", "[perception]") {
  for (const std::string& name : PartNames()) {
    const Part part = LoadPart(name);
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      RandomStream stream(seed, 0, "shape of " + name);
      const Polyline line = DrawShape(part, stream);
      TubeMeshOptions closed, open, rounded, hollow;
      open.ends = Ends::kOpen;
      open.sides = 12;
      rounded.ends = Ends::kRound;
      hollow.bore_m = part.radius_m - (seed == 0 ? 0.0010 : 0.0060);
      for (const TubeMeshOptions& options : {closed, open, rounded, hollow}) {
        INFO(name << " seed " << seed << " ends " << static_cast<int>(options.ends) << " bore "
                  << options.bore_m);
        CheckTube(MakeTubeMesh(line, part.radius_m, options), line, part.radius_m);
      }
    }
  }
}

TEST_CASE("Tubes at the ends of the allowed sizes are found", "[perception]") {
  const Polyline thin = {Vector3(0, 0, 0), Vector3(0, 0.6, 0)};
  CheckTube(MakeTubeMesh(thin, 0.003), thin, 0.003);
  const Polyline fat = {Vector3(0, 0, 0), Vector3(0, 0, 0.2)};
  CheckTube(MakeTubeMesh(fat, 0.04), fat, 0.04);
}

TEST_CASE("How a file winds its faces and what lies in a tube do not matter", "[perception]") {
  CheckTube(WindingMixed(MakeTubeMesh(kStraight, 0.01)), kStraight, 0.01);
  TubeMeshOptions loose;  // An inner wall that touches the outer one nowhere.
  loose.ends = Ends::kOpen;
  loose.bore_m = 0.009;
  CheckTube(MakeTubeMesh(kStraight, 0.01, loose), kStraight, 0.01);
  CHECK(FindTubeOfMesh(MakeTubeMesh(kStraight, 0.01, loose), Parallelism{}).length_m > 0.0);
}

TEST_CASE("A tube that crosses its own end is no ring", "[perception]") {
  // A loop of 60 mm whose end passes through the straight piece that it began with.
  Polyline line = {Vector3(-0.15, 0, 0)};
  for (int i = 0; i <= 48; ++i) {
    const double angle = 1.5 * kPi * i / 48;
    line.push_back(0.06 * Vector3(std::sin(angle), 1.0 - std::cos(angle), 0));
  }
  line.push_back(Vector3(-0.06, 0, 0));
  CheckTube(MakeTubeMesh(line, 0.01), line, 0.01);
}

TEST_CASE("A hollow tube is called hollow, a full one is not", "[perception]") {
  TubeMeshOptions hollow;
  hollow.bore_m = 0.008;
  CHECK(FindTubeOfMesh(MakeTubeMesh(kStraight, 0.01, hollow), Parallelism{}).hollow);
  CHECK_FALSE(FindTubeOfMesh(MakeTubeMesh(kStraight, 0.01), Parallelism{}).hollow);
}

TEST_CASE("What is no tube is refused with the reason", "[perception]") {
  const Mesh tube = MakeTubeMesh(Resample(kStraight, 0.02), 0.01);
  CheckNoTube(MakeSphereMesh(Vector3::Zero(), 0.035), MeshVerdict::kNoAxis, "no axis");
  CheckNoTube(MakeBoxMesh(Vector3::Zero(), {0.2, 0.05, 0.03}), MeshVerdict::kNotRound,
              "0 % of its surface is round");
  CheckNoTube(MakeBoxMesh(Vector3::Zero(), {0.2, 0.01, 0.01}), MeshVerdict::kNotRound, "round");
  const Mesh leg = MakeTubeMesh({Vector3(0.2, 0.005, 0), Vector3(0.2, 0.15, 0)}, 0.01);
  CheckNoTube(Welded(tube, leg), MeshVerdict::kBranches, "branches");
  CheckNoTube(Together(tube, MakeTubeMesh({Vector3(0, 0.1, 0), Vector3(0.3, 0.1, 0)}, 0.01)),
              MeshVerdict::kSeveralBodies, "2 bodies");
  TubeMeshOptions cone;
  for (const double end_radius_m : {0.0125, 0.02}) {
    cone.end_radius_m = end_radius_m;
    CheckNoTube(MakeTubeMesh(Resample(kStraight, 0.02), 0.01, cone), MeshVerdict::kRadiusSpread,
                "spreads by");
  }
  Polyline circle;
  for (int i = 0; i <= 60; ++i) {
    circle.push_back(0.1 * Vector3(std::cos(kPi * i / 30), std::sin(kPi * i / 30), 0));
  }
  TubeMeshOptions open;
  open.ends = Ends::kOpen;
  CheckNoTube(MakeTubeMesh(circle, 0.01, open), MeshVerdict::kClosed, "ring");
  const Mesh flange = MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.005, 0, 0)}, 0.03);
  CheckNoTube(Welded(tube, flange), MeshVerdict::kOtherSurface, "outside of the tube");
  CheckNoTube(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0.05, 0, 0)}, 0.02), MeshVerdict::kNoAxis,
              "four radii");
}

TEST_CASE("A tube of no size that a part may have is refused before much is computed",
          "[perception]") {
  CheckNoTube(MakeTubeMesh(kStraight, 0.0005), MeshVerdict::kWrongSize, "3 to 40 mm");
  CheckNoTube(MakeTubeMesh(kStraight, 0.06), MeshVerdict::kWrongSize, "3 to 40 mm");
  CheckNoTube(MakeTubeMesh({Vector3(0, 0, 0), Vector3(2.5, 0, 0)}, 0.01), MeshVerdict::kWrongSize,
              "up to 2 m long");
}

TEST_CASE("The same mesh gives the same tube with one thread and with two", "[perception]") {
  const Mesh mesh = MakeTubeMesh(Resample(kStraight, 0.01), 0.01);
  const MeshTube one = FindTubeOfMesh(mesh, Parallelism{1}), two = FindTubeOfMesh(mesh, {2});
  CHECK(one.line == two.line);
  CHECK(one.radius_m == two.radius_m);
}

}  // namespace
}  // namespace tubetwin
