#include "models/base/cloud/packed_cloud.h"

#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

OrganizedCloud SomeCloud() {
  RandomStream stream(7, 0, "packed cloud");
  OrganizedCloud cloud;
  cloud.width = 40;
  cloud.height = 30;
  for (int i = 0; i < cloud.width * cloud.height; ++i) {
    cloud.p_SP.push_back(i % 5 == 0
                             ? InvalidPoint()
                             : Eigen::Vector3d(stream.Uniform(-0.2, 0.2), stream.Uniform(-0.2, 0.2),
                                               stream.Uniform(0.3, 0.6))
                                   .cast<float>());
    cloud.intensity.push_back(static_cast<float>(stream.Uniform()));
    cloud.label.push_back(static_cast<std::uint32_t>(i));
  }
  cloud.X_NS = MakeTransform(RotX(kPi), Vector3(0.1, 0.2, 0.8));
  return cloud;
}

void CheckSame(const OrganizedCloud& a, const OrganizedCloud& b) {
  REQUIRE(a.width == b.width);
  REQUIRE(a.height == b.height);
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(IsValid(a.p_SP[i]) == IsValid(b.p_SP[i]));
    if (IsValid(a.p_SP[i])) REQUIRE(a.p_SP[i] == b.p_SP[i]);
  }
  CHECK(a.intensity == b.intensity);
  CHECK(a.label == b.label);
  CHECK(a.X_NS.isApprox(b.X_NS, 1e-12));
}

TEST_CASE("A packed cloud reads back bit by bit and unpacks to the PCD itself", "[unit]") {
  const TemporaryFolder folder;
  const OrganizedCloud cloud = SomeCloud();
  WritePackedPcd(cloud, folder / "a.pcd.zst");
  CheckSame(cloud, ReadCloud(folder / "a.pcd.zst"));
  WritePcd(cloud, folder / "a.pcd");
  const std::string packed = ReadFile(folder / "a.pcd.zst");
  CHECK(packed.size() < ReadFile(folder / "a.pcd").size());
  CHECK(DecompressedFile(packed, 1 << 20, "a") == ReadFile(folder / "a.pcd"));
  // What somebody else packed is read as well, in any spelling.
  WritePly(cloud, folder / "b.ply");
  WriteFileAtomically(folder / "b.PLY.ZST", Compressed(ReadFile(folder / "b.ply"), 19));
  CheckSame(cloud, ReadCloud(folder / "b.PLY.ZST"));
}

TEST_CASE("A damaged packed cloud is refused with its reason", "[unit]") {
  const TemporaryFolder folder;
  WritePackedPcd(SomeCloud(), folder / "a.pcd.zst");
  const std::string good = ReadFile(folder / "a.pcd.zst");
  const auto refused = [&](const std::string& content, const std::string& said) {
    try {
      WriteFileAtomically(folder / "bad.pcd.zst", content);
      ReadCloud(folder / "bad.pcd.zst");
      FAIL("not refused: " + said);
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::kBadData);
      CHECK_THAT(e.what(), Contains("bad.pcd.zst") && Contains(said));
    }
  };
  refused("VERSION 0.7", "no zstd frame");
  refused(good.substr(0, good.size() / 2), "damaged");
  std::string flipped = good;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
  refused(flipped, "damaged");
  constexpr int kTooLarge = 257 * 1024 * 1024;
  refused(Compressed(std::string(kTooLarge, ' ')),
          "unpacks to 269484032 bytes, allowed are up to 268435456");
  refused(Compressed("no header\n"), "bad.pcd.zst:1");
}

TEST_CASE("Another ending is refused with those that are known", "[unit]") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "a.xyz.zst", "x");
  try {
    ReadCloud(folder / "a.xyz.zst");
    FAIL("not refused");
  } catch (const Error& e) {
    CHECK_THAT(e.what(), Contains("the ending is '.xyz.zst', allowed are .pcd, .ply, .pcd.zst"));
  }
}

}  // namespace
}  // namespace tubetwin
