#include <algorithm>
#include <cmath>
#include <optional>

#include "models/base/cloud/cloud.h"
#include "models/base/cloud/cloud_file.h"
#include "models/base/cloud/ply_header.h"
#include "models/base/cloud/ply_rows.h"
#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

/// What comments say; any other comment is nobody's.
struct Notes {
  std::optional<double> unit_m;
  bool frame_S = false;
};

Notes ReadNotes(const CloudFile& file, const PlyHeader& header, bool unit_given) {
  Notes notes;
  for (const std::vector<std::string>& note : header.notes) {
    const std::vector<std::string_view> words(note.begin(), note.end());
    if (const auto unit_m = UnitOfComment(words)) notes.unit_m = unit_m;
    // Nothing but a unit that is not known: metres would be wrong without a word.
    if (words.size() == 2 && words[0] == "units" && !MetresPer(words[1]) && !unit_given) {
      throw Error(ErrorKind::kBadData, file.path() + ": comment units is " + Quoted(words[1]) +
                                           ", allowed are " + Join(LengthUnits()) +
                                           "; --units says another");
    }
    if (words.size() > 1 && words[0] == "frame") notes.frame_S = words[1] == "S";
  }
  return notes;
}

/// The element with the points; x y z are needed from here on.
PlyElement& RequireVertex(const CloudFile& file, PlyHeader& header) {
  PlyElement* vertex = header.Find("vertex");
  if (vertex == nullptr || vertex->count < 1) {
    std::vector<std::string> names;
    for (const PlyElement& element : header.elements) {
      names.push_back(element.name + " " + std::to_string(element.count));
    }
    file.FailLine("there is no element 'vertex' with at least one row, the header has: " +
                  Printable(Join(names).substr(0, 200)));
  }
  for (const char* name : {"x", "y", "z"}) {
    const int i = vertex->Need(name);
    if (i < 0) {
      std::vector<std::string> names;
      for (const PlyProperty& property : vertex->properties) names.push_back(property.name);
      file.FailLine("element 'vertex' lacks property '" + std::string(name) +
                    "', it has: " + Printable(Join(names, " ").substr(0, 200)));
    }
    const PlyProperty& property = vertex->properties[static_cast<std::size_t>(i)];
    if (property.count || (property.type.kind == 'F' && property.type.size == 2)) {
      file.FailLine("property '" + std::string(name) +
                    "' is a list or a half float, allowed is "
                    "any other number");
    }
  }
  return *vertex;
}

/// Index of a property that is as WritePly() writes it, or -1.
int NeedOwn(PlyElement& vertex, std::string_view name, bool floating) {
  const int i = vertex.Find(name);
  if (i < 0) return -1;
  const PlyProperty& property = vertex.properties[static_cast<std::size_t>(i)];
  const bool own = floating ? property.type.kind == 'F' && property.type.size >= 4
                            : property.type.kind == 'U' || property.type.kind == 'I';
  return own && !property.count ? vertex.Need(name) : -1;
}

RigidTransform ParseCamera(const CloudFile& file, const PlyElement& camera,
                           const std::vector<double>& values, double unit_m) {
  Eigen::Matrix<double, 3, 4> columns;  // x, y, z axis and position of the camera.
  static const char* kNames[4] = {"x_axis", "y_axis", "z_axis", "view_p"};
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      const int i = camera.Find(std::string(kNames[c]) + "xyz"[r]);
      columns(r, c) = values[i];
    }
  }
  const Matrix3 R = columns.leftCols<3>();
  constexpr double kRotationTolerance = 1e-3;  // Float axes of a calibrated scanner are far better.
  const double defect = (R.transpose() * R - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(defect < kRotationTolerance) || R.determinant() < 0 || !columns.allFinite()) {
    throw Error(ErrorKind::kBadData,
                file.path() + ": element 'camera': the axes are no rotation (defect " +
                    Number(defect) + ", allowed is " + Number(kRotationTolerance) + ")");
  }
  return MakeTransform(Eigen::Quaterniond(R).normalized().toRotationMatrix(),
                       columns.col(3) * unit_m);
}

/// Whether an element `camera` is one as PhoXi, PCL and WritePly() have it; others are nobody's.
bool NeedCamera(PlyElement& camera) {
  for (const char* name : {"view_p", "x_axis", "y_axis", "z_axis"}) {
    for (const char axis : {'x', 'y', 'z'}) {
      if (camera.Need(std::string(name) + axis) < 0) return false;
    }
  }
  return true;
}

void ReadVertices(PlyRows& rows, PlyElement& vertex, double unit_m, OrganizedCloud& cloud) {
  const int x = vertex.Find("x"), y = vertex.Find("y"), z = vertex.Find("z");
  const int intensity = NeedOwn(vertex, "intensity", true), label = NeedOwn(vertex, "label", false);
  const auto n = static_cast<std::size_t>(vertex.count);
  cloud.p_SP.resize(n);
  if (intensity >= 0) cloud.intensity.resize(n);
  if (label >= 0) cloud.label.resize(n);
  PlyRow row;
  for (std::size_t i = 0; i < n; ++i) {
    rows.Read(vertex, static_cast<std::int64_t>(i), row);
    const Vector3 p(row.values[x], row.values[y], row.values[z]);
    cloud.p_SP[i] = p.isZero(0.0) ? InvalidPoint() : Eigen::Vector3f((p * unit_m).cast<float>());
    if (intensity >= 0) cloud.intensity[i] = static_cast<float>(row.values[intensity]);
    if (label >= 0) {
      cloud.label[i] = static_cast<std::uint32_t>(std::clamp(row.values[label], 0.0, 4294967295.0));
    }
  }
}

/// What the file says besides the points.
struct PlyView {
  std::optional<RigidTransform> X_camera;
  double width = 0, height = 0;  ///< 0: not said.
};

/// Reads the elements in the file's order, up to the last that says something.
PlyView ReadElements(CloudFile& file, PlyHeader& header, double unit_m, OrganizedCloud& cloud) {
  PlyElement& vertex = RequireVertex(file, header);
  PlyElement* camera = header.Find("camera");
  PlyElement* frame = header.Find("phoxi_frame_params");
  if (camera != nullptr && (camera->count < 1 || !NeedCamera(*camera))) camera = nullptr;
  if (frame != nullptr &&
      (frame->count < 1 || frame->Need("frame_width") < 0 || frame->Need("frame_height") < 0)) {
    frame = nullptr;
  }
  const PlyElement* last = std::max({&vertex, camera, frame});  // They lie in one vector.
  PlyView view;
  PlyRows rows(file, header);
  PlyRow row;
  for (PlyElement& element : header.elements) {
    if (&element == &vertex) {
      rows.RequireRoom(vertex);
      ReadVertices(rows, vertex, unit_m, cloud);
    } else if (&element == camera || &element == frame) {
      for (std::int64_t i = 0; i < element.count; ++i) rows.Read(element, i, row);
      if (&element == camera) view.X_camera = ParseCamera(file, element, row.values, unit_m);
      if (&element == frame) {
        view.width = row.values[static_cast<std::size_t>(element.Find("frame_width"))];
        view.height = row.values[static_cast<std::size_t>(element.Find("frame_height"))];
      }
    } else {
      rows.Skip(element);
    }
    if (&element == last) break;
  }
  return view;
}

}  // namespace

OrganizedCloud ReadPly(const std::string& path, std::optional<double> given_unit_m) {
  CloudFile file(path, "PLY file");
  PlyHeader header = ReadPlyHeader(file);
  const Notes notes = ReadNotes(file, header, given_unit_m.has_value());
  const bool phoxi = header.Find("phoxi_frame_params") != nullptr;
  const double unit_m = given_unit_m.value_or(notes.unit_m.value_or(phoxi ? 0.001 : 1.0));
  OrganizedCloud cloud;
  const PlyView view = ReadElements(file, header, unit_m, cloud);
  const bool whole = view.width >= 1 && view.height >= 1 &&
                     view.width * view.height == static_cast<double>(cloud.size());
  cloud.width = whole ? static_cast<int>(view.width) : static_cast<int>(cloud.size());
  cloud.height = whole ? static_cast<int>(view.height) : 1;
  cloud.X_NS = view.X_camera.value_or(RigidTransform::Identity());
  if (view.X_camera && !notes.frame_S) {
    const Eigen::Isometry3f X_SN = cloud.X_NS.inverse().cast<float>();
    for (Eigen::Vector3f& p : cloud.p_SP) p = X_SN * p;
  }
  FinishPoints(file, cloud);
  return cloud;
}

OrganizedCloud ReadCloud(const std::string& path, std::optional<double> unit_m) {
  const std::string ending = CloudEnding(path);
  if (ending == ".pcd" || ending == ".pcd.zst") return ReadPcd(path, unit_m);
  if (ending == ".ply" || ending == ".ply.zst") return ReadPly(path, unit_m);
  throw Error(ErrorKind::kBadData, path + ": the ending is '" + ending +
                                       "', allowed are .pcd, .ply, .pcd.zst, .ply.zst");
}

}  // namespace tubetwin
