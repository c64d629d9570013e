// What PCL writes, in each of its formats, is read as PCL meant it.

#include <cmath>

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "models/base/cloud/cloud.h"
#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

pcl::PCLPointCloud2 SomePclCloud(int width, int height) {
  RandomStream stream(3, 0, "pcl");
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud(width, height);
  cloud.is_dense = false;
  for (auto& p : cloud) {
    // Rounded, so that the compression finds what repeats.
    const auto number = [&] { return static_cast<float>(stream.Index(100)) / 100.0f + 0.1f; };
    p.x = number();
    p.y = number();
    p.z = stream.Uniform() < 0.2 ? std::nanf("") : number();
    p.rgb = number();
  }
  pcl::PCLPointCloud2 out;
  pcl::toPCLPointCloud2(cloud, out);
  return out;
}

void CheckAsPcl(const pcl::PCLPointCloud2& written, const std::string& path, float tolerance) {
  INFO(path);
  pcl::PointCloud<pcl::PointXYZ> expected;
  pcl::fromPCLPointCloud2(written, expected);
  const OrganizedCloud read = ReadCloud(path);
  REQUIRE(read.size() == expected.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    const Eigen::Vector3f p = expected[i].getVector3fMap();
    if (p.allFinite() ? !((read.p_SP[i] - p).norm() <= tolerance) : IsValid(read.p_SP[i])) {
      FAIL("point " << i << ": " << read.p_SP[i].transpose() << ", not " << p.transpose());
    }
  }
}

TEST_CASE("What PCL writes is read as PCL meant it", "[unit]") {
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = SomePclCloud(64, 48);
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf turn = Eigen::Quaternionf::Identity();
  constexpr float kSixDigits = 1e-5f;
  pcl::PCDWriter pcd;
  REQUIRE(pcd.writeBinaryCompressed(folder / "c.pcd", cloud, origin, turn) == 0);
  REQUIRE(pcd.writeBinary(folder / "b.pcd", cloud, origin, turn) == 0);
  REQUIRE(pcd.writeASCII(folder / "a.pcd", cloud, origin, turn, 6) == 0);
  CheckAsPcl(cloud, folder / "c.pcd", 0.0f);
  CheckAsPcl(cloud, folder / "b.pcd", 0.0f);
  CheckAsPcl(cloud, folder / "a.pcd", kSixDigits);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) {
    CHECK(ReadCloud(folder / name).width == 64);
    CHECK(ReadCloud(folder / name).height == 48);
  }
  pcl::PLYWriter ply;
  REQUIRE(ply.writeBinary(folder / "b.ply", cloud, origin, turn, true) == 0);
  REQUIRE(ply.writeASCII(folder / "a.ply", cloud, origin, turn, 6, true) == 0);
  CheckAsPcl(cloud, folder / "b.ply", 0.0f);
  CheckAsPcl(cloud, folder / "a.ply", kSixDigits);
}

}  // namespace
}  // namespace tubetwin
