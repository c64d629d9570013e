#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hw_bridge/codecs/gvsp.h"
#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// What a scanner tells of each pixel, in the order in which its parts are sent.
enum class ScanComponent {
  kIntensity,   ///< Mono10: the cloud's intensity, 0..1023; all 0 when the cloud has none.
  kRange,       ///< Coord3D_ABC32f: x y z in mm, or Coord3D_C32f: z only. Empty pixels are 0.
  kConfidence,  ///< Confidence8: see ConfidenceOf. Empty pixels are 0, all others 1 to 255.
  kMapA,        ///< Coord3D_A32f and kMapB, Coord3D_B32f: column and row of the pixel. With these
  kMapB,        ///< x = z (A - centre_u) / focal_px, y = z (B - centre_v) / focal_px.
  kNormal,      ///< Coord3D_ABC32f or Coord3D_AC8, see NormalsOf; unknown ones are 0 0 1.
};
inline constexpr std::size_t kScanComponents = 6;

struct ScanComponentInfo {
  const char* name;  ///< In GenICam.
  std::uint16_t id;  ///< ComponentIDValue. Ascending.
  GvspData data;
  std::uint32_t pixel_format;  ///< As shipped.
};
const ScanComponentInfo& InfoOf(ScanComponent component);

/// What the emulated scanner's optics are. The defaults are those of a PhoXi S at half size.
struct ScanOptics {
  double focal_px = 1267.0;     ///< At the cloud's size; principal point at its centre.
  double sweet_spot_m = 0.442;  ///< Where depth is best,
  double sigma_m = 0.00005;     ///< and its standard deviation there.
};

/// How the surface lies around each point: the plane that fits best through its neighbours, up to
/// `radius` pixels away and not across a jump of depth.
struct PointSurface {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< Towards the camera; 0 0 0: unknown.
  float off_m = 0;                                   ///< Of the point from that plane.
};
std::vector<PointSurface> SurfacesOf(const OrganizedCloud& cloud, const ScanOptics& optics,
                                     int radius);

/// How sure a point is, 1 to 255: the scanner's sigma at its best against what is expected of this
/// point, which grows with the distance squared and the incidence, or what its neighbours
/// contradict when that is more. 1 where the neighbours tell nothing.
std::uint8_t ConfidenceOf(const Eigen::Vector3f& p_SP, const PointSurface& surface,
                          const ScanOptics& optics);

/// The component's bytes, row by row, little-endian. `normals_radius`: of SurfacesOf for kNormal;
/// 0: all are unknown.
std::vector<std::byte> ComponentBytes(const OrganizedCloud& cloud, ScanComponent component,
                                      std::uint32_t pixel_format, const ScanOptics& optics,
                                      int normals_radius);

}  // namespace tubetwin
