#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "models/base/frames.h"

namespace tubetwin {

/// Labels of a labelled cloud; for scoring only, the pipeline never reads them.
inline constexpr std::uint32_t kLabelNone = 0;       ///< No return, or a mixed point.
inline constexpr std::uint32_t kLabelCell = 1;       ///< Bin, tray, arm.
inline constexpr std::uint32_t kLabelFirstTube = 2;  ///< 2 + k for the pile's k-th tube.

/// One scan: points in raster order of the camera image, row by row from the top left.
/// An unorganised cloud has height 1. Frame S, metres; invalid points are NaN in all three.
struct OrganizedCloud {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> p_SP;  ///< [height * width]
  std::vector<float> intensity;       ///< [height * width] or empty; 0..1
  std::vector<std::uint32_t> label;   ///< [height * width] or empty
  /// Pose of the scanner in the bin as the pipeline believes it (PCD VIEWPOINT).
  RigidTransform X_NS = RigidTransform::Identity();

  std::size_t size() const { return p_SP.size(); }
  bool organized() const { return height > 1; }
};

inline bool IsValid(const Eigen::Vector3f& p) { return p.x() == p.x(); }
inline Eigen::Vector3f InvalidPoint() {
  return Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
}

/// Reads PCD 0.5 to 0.7, binary, binary_compressed or ascii, with fields x y z, of any number type
/// and at any place. Fields `intensity` (F) and `label` (U) are read where they are as WritePcd
/// writes them; what stands in any other column, and bytes behind the data, stop nothing. Lengths
/// (points and VIEWPOINT) are in `unit_m` metres where given, else as a comment "# units mm" says,
/// else in metres. Throws Error(kMissing) when the file does not exist and Error(kBadData) naming
/// file, byte or line, field, value and what is allowed when the header or the data is wrong,
/// before allocating anything that the file's own size cannot fill.
OrganizedCloud ReadPcd(const std::string& path, std::optional<double> unit_m = std::nullopt);

/// Writes binary PCD 0.7 atomically (temporary file, then rename). Throws Error(kCannotCreate |
/// kIo).
void WritePcd(const OrganizedCloud& cloud, const std::string& path);

/// Writes binary little-endian PLY in metres: vertex x y z [intensity] [label] in raster order and
/// frame S (invalid points 0 0 0, as PhoXi writes them), then PhoXi's elements in their order:
/// `camera` (X_NS: position and axes of S), `phoxi_frame_params` (width and height) and, for an
/// organised cloud, `camera_matrix` (pinhole with square pixels and central principal point, fitted
/// to the points; pixel centres are whole numbers), `distortion_matrix` (zero), `camera_resolution`
/// and `frame_binning` (1). Throws like WritePcd.
void WritePly(const OrganizedCloud& cloud, const std::string& path);

/// Writes PLY as PhoXi Control saves a frame in camera space: millimetres without comments, vertex
/// x y z Texture32 (the intensity, or 0) with invalid points 0 0 0, `camera` identity, then the
/// elements of WritePly; labels and X_NS are not stored. Read back, each coordinate is within one
/// rounding of float32. Throws like WritePcd.
void WritePhoxiPly(const OrganizedCloud& cloud, std::uint32_t frame_index, const std::string& path);

/// WritePly where the name ends in .ply (any case), WritePcd packed by zstd for .pcd.zst, else
/// WritePcd. Throws like WritePcd.
void WriteCloud(const OrganizedCloud& cloud, const std::string& path);

/// Reads ascii or binary PLY of either byte order: x y z of the element `vertex`, of any number
/// type and at any place; `intensity` (floating) and `label` (whole numbers) where they are as
/// WritePly writes them. What stands in other properties and elements, lists too, stops nothing.
/// Units: `unit_m` metres where given; else as a comment says ("units mm"); else millimetres with
/// PhoXi's element `phoxi_frame_params`; else metres. With `comment frame S` (our own files)
/// vertices are in S and `camera` is X_NS; otherwise vertices and camera share the file's frame,
/// which becomes N, and points are moved into S. The cloud is unorganised without frame parameters,
/// and where these say another number of points: scanner software leaves out those it did not
/// measure. Throws like ReadPcd.
OrganizedCloud ReadPly(const std::string& path, std::optional<double> unit_m = std::nullopt);

/// ReadPcd or ReadPly by the ending .pcd or .ply (any case). Throws Error(kBadData) for another.
OrganizedCloud ReadCloud(const std::string& path, std::optional<double> unit_m = std::nullopt);

}  // namespace tubetwin
