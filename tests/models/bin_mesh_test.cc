#include "models/mesh/bin_mesh.h"

#include "tests/support/catch.h"
#include "tests/support/tube_mesh.h"

namespace tubetwin {
namespace {

// Samples lie on the planes: only their rounding to single steps of area moves the middle.
constexpr double kExact_m = 0.0005;

Mesh MovedBy(const RigidTransform& X, Mesh mesh) {
  for (Vector3& v : mesh.vertices) v = X * v;
  return mesh;
}

void CheckNoBin(const Mesh& mesh, BinVerdict verdict, const std::string& said) {
  const MeshBin bin = FindBinOfMesh(mesh);
  INFO(bin.reason);
  CHECK(static_cast<int>(bin.verdict) == static_cast<int>(verdict));
  CHECK_THAT(bin.reason, Catch::Contains(said));
}

TEST_CASE("The inner box of a bin is found however it stands", "[unit]") {
  for (const double wall_m : {0.0, 0.003, 0.02}) {
    for (const double yaw_deg : {0.0, 20.0, 77.0, 90.0}) {
      const RigidTransform X = MakeTransform(RotZ(Radians(yaw_deg)), Vector3(0.3, -0.2, 0.4));
      const MeshBin bin = FindBinOfMesh(MovedBy(X, MakeBinMesh({0.8, 0.6, 0.2}, wall_m)));
      INFO("wall " << wall_m << " yaw " << yaw_deg << ": " << bin.reason);
      REQUIRE(bin.verdict == BinVerdict::kBin);
      CHECK(bin.size_m[0] == Approx(0.8).margin(kExact_m));
      CHECK(bin.size_m[1] == Approx(0.6).margin(kExact_m));
      CHECK(bin.size_m[2] == Approx(0.2).margin(kExact_m));
      CHECK((bin.X_MN.translation() - X.translation()).norm() < kExact_m);
      CHECK(std::abs(bin.X_MN.linear().col(0).dot(X.linear().col(0))) > 0.99999);
      CHECK(bin.X_MN.linear().col(2).z() == Approx(1.0));
    }
  }
}

TEST_CASE("The long side is x, and leaning walls count at half height", "[unit]") {
  const MeshBin turned = FindBinOfMesh(MakeBinMesh({0.4, 0.6, 0.1}, 0.01));
  REQUIRE(turned.verdict == BinVerdict::kBin);
  CHECK(turned.size_m[0] == Approx(0.6).margin(kExact_m));
  CHECK(std::abs(turned.X_MN.linear().col(0).y()) > 0.99999);
  // Each wall leans outwards by 5 mm over its height.
  const MeshBin leaning = FindBinOfMesh(MakeBinMesh({0.6, 0.4, 0.2}, 0.01, 0.005));
  INFO(leaning.reason);
  REQUIRE(leaning.verdict == BinVerdict::kBin);
  CHECK(leaning.size_m[0] == Approx(0.605).margin(kExact_m));
}

TEST_CASE("What is no box-shaped, open, empty bin is refused with the reason", "[unit]") {
  const Mesh bin = MakeBinMesh({0.6, 0.4, 0.2}, 0.01);
  CheckNoBin(MakeBoxMesh(Vector3::Zero(), {0.3, 0.2, 0.1}), BinVerdict::kNoFloor, "z point up");
  CheckNoBin(Together(bin, MakeBoxMesh({0.1, 0, 0.1}, {0.01, 0.18, 0.09})), BinVerdict::kNotEmpty,
             "something stands between its walls");
  CheckNoBin(Together(bin, MakeBoxMesh({0, 0, 0.2}, {0.29, 0.19, 0.002})), BinVerdict::kNotEmpty,
             "closes it");
  CheckNoBin(MakeBinMesh({0.6, 0.4, 0.2}, 0.01, 0.05), BinVerdict::kNoBox, "leans by");
  CheckNoBin(MakeBinMesh({0.08, 0.06, 0.05}, 0.005), BinVerdict::kWrongSize, "100 mm to 3 m");
  Mesh gap = MakeBinMesh({0.6, 0.4, 0.2}, 0.0);
  gap.faces.erase(gap.faces.begin() + 2, gap.faces.begin() + 4);  // One wall of a sheet.
  CheckNoBin(gap, BinVerdict::kNoWall, "wall at");
  const MeshBin tube = FindBinOfMesh(MakeTubeMesh({Vector3(0, 0, 0), Vector3(0, 0, 0.3)}, 0.2));
  CHECK(tube.verdict != BinVerdict::kBin);
}

}  // namespace
}  // namespace tubetwin
