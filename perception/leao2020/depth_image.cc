#include "perception/leao2020/depth_image.h"

#include <limits>

#include "perception/view/view_raster.h"

namespace tubetwin {

ViewImage MakeDepthImage(const OrganizedCloud& cloud, double block_m) {
  const ViewRaster raster = MakeViewRaster(cloud, block_m);
  ViewImage image = MakeEmptyImage(raster);
  const auto cells = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.z_near.assign(cells, std::numeric_limits<float>::quiet_NaN());
  image.z_far = image.z_near;
  const int side = kBlocksPerCell * raster.block;
  for (int row = 0; row < image.height * side && row < raster.height; ++row) {
    const Eigen::Vector3f* pixel =
        raster.pixels_S() + static_cast<std::size_t>(row) * static_cast<std::size_t>(raster.width);
    for (int column = 0; column < image.width * side && column < raster.width; ++column) {
      const float z = pixel[column].z();
      if (!(z >= kNearest_m)) continue;
      const std::size_t cell = image.Index(column / side, row / side);
      // Written so that a NaN is replaced.
      if (!(image.z_near[cell] <= z)) image.z_near[cell] = z;
      if (!(image.z_far[cell] >= z)) image.z_far[cell] = z;
    }
  }
  return image;
}

}  // namespace tubetwin
