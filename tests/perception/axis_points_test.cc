#include "perception/fragment/axis_points.h"

#include <limits>

#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"

namespace tubetwin {
namespace {

/// Float coordinates at half a metre are exact to 0.03 um; over windows of 3.5 mm that turns a
/// normal by some 1e-4.
constexpr double kRounding_rad = 5e-4;

/// A bin without walls in view and everything above z = -1 as foreground would still cut the floor;
/// surfaces of these tests lie well above it.
Bin WideBin() {
  Bin bin;
  bin.size_m = {3.0, 3.0, 0.2};
  return bin;
}

/// The plane n.p = d (frame S) as a camera of focal length `focal_px` sees it, noise-free.
OrganizedCloud PlaneCloud(int width, int height, double focal_px, const Vector3& n_S, double d,
                          const RigidTransform& X_NS) {
  OrganizedCloud cloud;
  cloud.width = width;
  cloud.height = height;
  cloud.X_NS = X_NS;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vector3 ray((column - 0.5 * (width - 1)) / focal_px,
                        (row - 0.5 * (height - 1)) / focal_px, 1.0);
      cloud.p_SP.push_back((d / n_S.dot(ray) * ray).cast<float>());
    }
  }
  return cloud;
}

std::vector<SurfacePoint> PointsOf(const OrganizedCloud& cloud, double radius_m, ViewImage* depths,
                                   double pitch_m = 0.0007) {
  const ViewRaster raster = MakeViewRaster(cloud, pitch_m);
  ViewImage image = MakeEmptyImage(raster);
  std::vector<SurfacePoint> out;
  for (int band = 0; band * kRowsPerBand < raster.block_rows(); ++band) {
    const auto part = ExtractSurfaceBand(raster, Foreground(WideBin(), 0.3), radius_m, band, image);
    out.insert(out.end(), part.points.begin(), part.points.end());
  }
  if (depths != nullptr) *depths = image;
  return out;
}

TEST_CASE("Normals of a plane are exact at every incidence, for every block size", "[unit]") {
  const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, 0.6));
  for (const double focal_px : {700.0, 1267.0, 2534.0}) {
    for (const double tilt : {0.0, 0.5, 1.0, 1.2}) {
      const Vector3 n_S = RotY(tilt) * RotX(0.1) * -Vector3::UnitZ();
      const auto cloud = PlaneCloud(150, 130, focal_px, n_S, n_S.z() * 0.5, X_NS);
      const auto points = PointsOf(cloud, 0.0125, nullptr);
      INFO("focal length " << focal_px << " px, tilt " << tilt);
      REQUIRE(points.size() > 100);
      double worst = 0.0;
      for (const SurfacePoint& p : points) {
        const Vector3 n_N = X_NS.linear() * n_S;
        worst = std::max(worst, p.n_N.cast<double>().cross(n_N).norm());
        worst = std::max(worst, 1.0 - p.n_N.cast<double>().dot(n_N));
        const Vector3 ray = (p.p_N.cast<double>() - X_NS.translation()).normalized();
        worst = std::max(worst, std::abs(p.weight + n_N.dot(ray)));
        worst = std::max(worst, (p.p_N - 0.0125f * p.n_N - p.a_N).cast<double>().norm() / 0.0125);
      }
      CHECK(worst < kRounding_rad);
    }
  }
}

TEST_CASE("Axis points of a tube lie on its axis", "[unit]") {
  ToyScene scene;
  scene.bin = WideBin();
  scene.tubes_N = {{{-0.1, 0.02, 0.10}, {0.1, -0.03, 0.12}}};
  ToyCamera camera;
  camera.sigma_m = 0.0;
  const RigidTransform X_NS = LookDown({0.05, 0.02, 0.55});
  const auto points =
      PointsOf(ToyScan(scene, camera, X_NS, RandomStream(1, 0, "noise")), 0.0125, nullptr);
  REQUIRE(points.size() > 2000);
  std::vector<double> off;
  for (const SurfacePoint& p : points) {
    off.push_back(Closest(scene.tubes_N[0], p.a_N.cast<double>()).distance_m);
  }
  std::sort(off.begin(), off.end());
  // Windows are even in the image, not on the tube: they turn normals by half a degree, more at
  // the silhouettes, where they end.
  CHECK(off[off.size() / 2] < 0.0001);
  CHECK(off[off.size() * 95 / 100] < 0.0012);
}

TEST_CASE("Cells of the depth image hold the nearest and farthest return of their pixels",
          "[unit]") {
  const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, 0.6));
  RandomStream stream(4, 0, "cells");
  for (const double focal_px : {700.0, 1267.0, 2534.0}) {
    OrganizedCloud cloud = PlaneCloud(147, 141, focal_px, -Vector3::UnitZ(), -0.5, X_NS);
    for (auto& p : cloud.p_SP) {
      const double u = stream.Uniform();
      if (u < 0.2) p = InvalidPoint();
      if (u > 0.9) p *= 0.9f;
    }
    ViewImage image;
    PointsOf(cloud, 0.0125, &image);
    const int pixels = static_cast<int>(std::lround(focal_px / image.fx));
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        float near = std::numeric_limits<float>::infinity(), far = 0.0f;
        // Blocks that stick out of the image do not count.
        const int block = pixels / kBlocksPerCell;
        for (int j = row * pixels; j < std::min((row + 1) * pixels, 141 / block * block); ++j) {
          for (int i = column * pixels; i < std::min((column + 1) * pixels, 147 / block * block);
               ++i) {
            const float z = cloud.p_SP[static_cast<std::size_t>(j * 147 + i)].z();
            if (!(z > 0)) continue;
            near = std::min(near, z);
            far = std::max(far, z);
          }
        }
        const std::size_t k = image.Index(column, row);
        if (far == 0.0f) {
          CHECK(!(image.z_near[k] == image.z_near[k]));
        } else if (image.z_near[k] != near || image.z_far[k] != far) {
          FAIL("cell " << column << ", " << row);
        }
      }
    }
  }
}

TEST_CASE("Foreground ends at floor and walls and begins again outside", "[unit]") {
  const Bin bin;
  const Foreground foreground(bin, 0.3);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(foreground.Contains(0.0f, 0.0f, 0.004f));
  CHECK_FALSE(foreground.Contains(0.0f, 0.0f, 0.002f));
  CHECK_FALSE(foreground.Contains(0.384f, 0.0f, 0.05f));
  CHECK_FALSE(foreground.Contains(0.395f, 0.0f, 0.092f));
  CHECK(foreground.Contains(0.395f, 0.0f, 0.093f));
  CHECK(foreground.Contains(0.41f, 0.0f, 0.05f));
  CHECK_FALSE(foreground.Contains(0.70f, 0.0f, 0.05f));
  CHECK_FALSE(foreground.Contains(0.0f, 0.0f, 0.30f));
  CHECK_FALSE(foreground.Contains(nan, nan, nan));
}

}  // namespace
}  // namespace tubetwin
