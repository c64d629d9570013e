#include <cstring>

#include "models/base/cloud/cloud.h"
#include "models/base/cloud/cloud_file.h"
#include "models/base/cloud/packed_cloud.h"
#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

void CheckShape(const OrganizedCloud& cloud) {
  const std::size_t n = cloud.size();
  TT_CHECK(n > 0 && static_cast<std::size_t>(cloud.width) * cloud.height == n);
  TT_CHECK(cloud.intensity.empty() || cloud.intensity.size() == n);
  TT_CHECK(cloud.label.empty() || cloud.label.size() == n);
}

constexpr int kPackedLevel = 6;  // Higher ones take much longer for a percent less.

struct PcdRecord {
  float x, y, z;
};

void FillPcd(const OrganizedCloud& cloud, std::size_t i, char* out) {
  const Eigen::Vector3f& p = cloud.p_SP[i];
  const PcdRecord record = {p.x(), p.y(), p.z()};
  std::memcpy(out, &record, sizeof record);
  out += sizeof record;
  if (!cloud.intensity.empty()) {
    std::memcpy(out, &cloud.intensity[i], 4);
    out += 4;
  }
  if (!cloud.label.empty()) std::memcpy(out, &cloud.label[i], 4);
}

void FillPly(const OrganizedCloud& cloud, std::size_t i, char* out) {
  const Eigen::Vector3f& p = cloud.p_SP[i];
  const Eigen::Vector3f stored = IsValid(p) ? p : Eigen::Vector3f(0, 0, 0);
  std::memcpy(out, stored.data(), 12);
  out += 12;
  if (!cloud.intensity.empty()) {
    std::memcpy(out, &cloud.intensity[i], 4);
    out += 4;
  }
  if (!cloud.label.empty()) std::memcpy(out, &cloud.label[i], 4);
}

void FillPhoxiPly(const OrganizedCloud& cloud, std::size_t i, char* out) {
  const Eigen::Vector3f& p = cloud.p_SP[i];
  const Eigen::Vector3f stored_mm = IsValid(p)
                                        ? Eigen::Vector3f((1000.0 * p.cast<double>()).cast<float>())
                                        : Eigen::Vector3f(0, 0, 0);
  std::memcpy(out, stored_mm.data(), 12);
  const float texture = cloud.intensity.empty() ? 0.0f : cloud.intensity[i];
  std::memcpy(out + 12, &texture, 4);
}

/// Focal length in pixels of the pinhole that an organised cloud fits; 0 when nothing tells it.
double FittedFocal(const OrganizedCloud& cloud) {
  double along = 0, square = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.p_SP[i];
    if (!IsValid(p) || !(p.z() > 0)) continue;
    const double column = static_cast<double>(i % cloud.width) + 0.5 - 0.5 * cloud.width;
    const double row = static_cast<double>(i / cloud.width) + 0.5 - 0.5 * cloud.height;
    const double x = p.x() / p.z(), y = p.y() / p.z();
    along += column * x + row * y;
    square += x * x + y * y;
  }
  return square > 0 ? along / square : 0.0;
}

template <class T>
void Append(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

constexpr int kDistortions = 14;

/// PhoXi's elements camera and phoxi_frame_params.
void AddFrameHeader(std::string& header, const std::string& camera_type) {
  header += "element camera 1\n";
  for (const char* name : {"view_p", "x_axis", "y_axis", "z_axis"}) {
    for (const char axis : {'x', 'y', 'z'}) {
      header += "property " + camera_type + " " + name + axis + "\n";
    }
  }
  header +=
      "element phoxi_frame_params 1\nproperty uint frame_width\nproperty uint frame_height\n"
      "property uint frame_index\nproperty float frame_start_time\nproperty float frame_duration\n"
      "property float frame_computation_duration\nproperty float frame_transfer_duration\n"
      "property int total_scan_count\n";
}

template <class T>
void AddCamera(const RigidTransform& X_NS, std::string& trailer) {
  const Matrix3 R_NS = X_NS.linear();
  for (int r = 0; r < 3; ++r) Append(trailer, static_cast<T>(X_NS.translation()[r]));
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) Append(trailer, static_cast<T>(R_NS(r, c)));
  }
}

void AddFrameParameters(const OrganizedCloud& cloud, std::uint32_t frame_index,
                        std::string& trailer) {
  Append(trailer, static_cast<std::uint32_t>(cloud.width));
  Append(trailer, static_cast<std::uint32_t>(cloud.height));
  Append(trailer, frame_index);
  for (int i = 0; i < 4; ++i) Append(trailer, 0.0f);
  Append(trailer, std::int32_t{1});
}

void AddPinholeHeader(std::string& header) {
  const auto numbered = [&](const char* element, const char* name, int count) {
    header += std::string("element ") + element + " 1\n";
    for (int i = 0; i < count; ++i) {
      header += std::string("property float ") + name + std::to_string(i) + "\n";
    }
  };
  numbered("camera_matrix", "cm", 9);
  numbered("distortion_matrix", "dm", kDistortions);
  header +=
      "element camera_resolution 1\nproperty uint width\nproperty uint height\n"
      "element frame_binning 1\nproperty uint horizontal\nproperty uint vertical\n";
}

void AddPinhole(const OrganizedCloud& cloud, std::string& trailer) {
  const auto focal_px = static_cast<float>(FittedFocal(cloud));
  const float centre_x = 0.5f * (cloud.width - 1), centre_y = 0.5f * (cloud.height - 1);
  for (const float v : {focal_px, 0.0f, centre_x, 0.0f, focal_px, centre_y, 0.0f, 0.0f, 1.0f}) {
    Append(trailer, v);
  }
  for (int i = 0; i < kDistortions; ++i) Append(trailer, 0.0f);
  for (const int v : {cloud.width, cloud.height, 1, 1}) {
    Append(trailer, static_cast<std::uint32_t>(v));
  }
}

std::string PcdHeaderText(const OrganizedCloud& cloud) {
  CheckShape(cloud);
  const bool intensity = !cloud.intensity.empty(), label = !cloud.label.empty();
  const auto q = QuaternionWxyz(cloud.X_NS.linear());
  const Vector3 p_NS = cloud.X_NS.translation();
  std::string view;
  for (const double v : {p_NS.x(), p_NS.y(), p_NS.z(), q[0], q[1], q[2], q[3]}) {
    view += " " + Number(v);
  }
  const std::string i4 = intensity ? " 4" : "", l4 = label ? " 4" : "";
  const std::string i1 = intensity ? " 1" : "", l1 = label ? " 1" : "";
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z" +
         std::string(intensity ? " intensity" : "") + (label ? " label" : "") + "\nSIZE 4 4 4" +
         i4 + l4 + "\nTYPE F F F" + (intensity ? " F" : "") + (label ? " U" : "") +
         "\nCOUNT 1 1 1" + i1 + l1 + "\nWIDTH " + std::to_string(cloud.width) + "\nHEIGHT " +
         std::to_string(cloud.height) + "\nVIEWPOINT" + view + "\nPOINTS " +
         std::to_string(cloud.size()) + "\nDATA binary\n";
}

std::size_t PcdRecordSize(const OrganizedCloud& cloud) {
  return 12 + (cloud.intensity.empty() ? 0 : 4) + (cloud.label.empty() ? 0 : 4);
}

}  // namespace

void WritePcd(const OrganizedCloud& cloud, const std::string& path) {
  WriteRecords(path, PcdHeaderText(cloud), cloud.size(), PcdRecordSize(cloud), "", FillPcd, cloud);
}

void WritePackedPcd(const OrganizedCloud& cloud, const std::string& path) {
  std::string content = PcdHeaderText(cloud);
  const std::size_t head = content.size(), record_size = PcdRecordSize(cloud);
  content.resize(head + cloud.size() * record_size);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    FillPcd(cloud, i, content.data() + head + i * record_size);
  }
  WriteFileAtomically(path, Compressed(content, kPackedLevel));
}

void WritePly(const OrganizedCloud& cloud, const std::string& path) {
  CheckShape(cloud);
  std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment units m\n"
      "comment frame S (x right, y down, z forward); camera is the pose of S in the bin\n"
      "element vertex " +
      std::to_string(cloud.size()) + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!cloud.intensity.empty()) header += "property float intensity\n";
  if (!cloud.label.empty()) header += "property uint label\n";
  AddFrameHeader(header, "double");
  if (cloud.organized()) AddPinholeHeader(header);
  header += "end_header\n";
  std::string trailer;
  AddCamera<double>(cloud.X_NS, trailer);
  AddFrameParameters(cloud, 0, trailer);
  if (cloud.organized()) AddPinhole(cloud, trailer);
  const std::size_t record_size =
      12 + (cloud.intensity.empty() ? 0 : 4) + (cloud.label.empty() ? 0 : 4);
  WriteRecords(path, header, cloud.size(), record_size, trailer, FillPly, cloud);
}

void WritePhoxiPly(const OrganizedCloud& cloud, std::uint32_t frame_index,
                   const std::string& path) {
  CheckShape(cloud);
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(cloud.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float Texture32\n";
  AddFrameHeader(header, "float");
  AddPinholeHeader(header);
  header += "end_header\n";
  std::string trailer;
  AddCamera<float>(RigidTransform::Identity(), trailer);
  AddFrameParameters(cloud, frame_index, trailer);
  AddPinhole(cloud, trailer);
  WriteRecords(path, header, cloud.size(), 16, trailer, FillPhoxiPly, cloud);
}

void WriteCloud(const OrganizedCloud& cloud, const std::string& path) {
  const std::string ending = CloudEnding(path);
  if (ending == ".ply") return WritePly(cloud, path);
  if (ending == ".pcd.zst") return WritePackedPcd(cloud, path);
  WritePcd(cloud, path);
}

}  // namespace tubetwin
