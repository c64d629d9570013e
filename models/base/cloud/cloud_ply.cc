#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "models/base/cloud/cloud.h"
#include "models/base/cloud/cloud_file.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

enum class Scalar { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

struct ScalarName {
  const char* name;
  Scalar scalar;
  std::size_t size;
};
constexpr ScalarName kScalars[] = {
    {"char", Scalar::kI8, 1},    {"int8", Scalar::kI8, 1},     {"uchar", Scalar::kU8, 1},
    {"uint8", Scalar::kU8, 1},   {"short", Scalar::kI16, 2},   {"int16", Scalar::kI16, 2},
    {"ushort", Scalar::kU16, 2}, {"uint16", Scalar::kU16, 2},  {"int", Scalar::kI32, 4},
    {"int32", Scalar::kI32, 4},  {"uint", Scalar::kU32, 4},    {"uint32", Scalar::kU32, 4},
    {"float", Scalar::kF32, 4},  {"float32", Scalar::kF32, 4}, {"double", Scalar::kF64, 8},
    {"float64", Scalar::kF64, 8}};

struct Property {
  std::string name;
  ScalarName type = kScalars[0];
  std::size_t offset = 0;  ///< In a binary record.
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
  bool has_list = false;
  std::size_t record_size = 0;

  int Find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return static_cast<int>(i);
    }
    return -1;
  }
};

struct PlyHeader {
  bool binary = true;
  std::optional<double> unit_m;  ///< From a comment.
  bool frame_S = false;
  std::vector<Element> elements;

  const Element* Find(std::string_view name) const {
    for (const Element& element : elements) {
      if (element.name == name) return &element;
    }
    return nullptr;
  }
};

template <class T>
double LoadAs(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double Load(const char* bytes, Scalar scalar) {
  switch (scalar) {
    case Scalar::kI8:
      return LoadAs<std::int8_t>(bytes);
    case Scalar::kU8:
      return LoadAs<std::uint8_t>(bytes);
    case Scalar::kI16:
      return LoadAs<std::int16_t>(bytes);
    case Scalar::kU16:
      return LoadAs<std::uint16_t>(bytes);
    case Scalar::kI32:
      return LoadAs<std::int32_t>(bytes);
    case Scalar::kU32:
      return LoadAs<std::uint32_t>(bytes);
    case Scalar::kF32:
      return LoadAs<float>(bytes);
    case Scalar::kF64:
      return LoadAs<double>(bytes);
  }
  return 0.0;
}

void ParseComment(const CloudFile& file, const std::vector<std::string_view>& words,
                  PlyHeader& header) {
  if (words.size() < 3) return;
  if (words[1] == "units") {
    if (words[2] != "m" && words[2] != "mm") {
      file.FailLine("comment units is '" + std::string(words[2]) + "', allowed are m, mm");
    }
    header.unit_m = words[2] == "m" ? 1.0 : 0.001;
  }
  if (words[1] == "frame") header.frame_S = words[2] == "S";
}

void ParseProperty(const CloudFile& file, const std::vector<std::string_view>& words,
                   PlyHeader& header) {
  if (header.elements.empty()) file.FailLine("property stands before any element");
  Element& element = header.elements.back();
  if (words.size() > 1 && words[1] == "list") {
    element.has_list = true;
    return;
  }
  constexpr std::size_t kMaxProperties = 256;
  if (words.size() != 3 || element.properties.size() == kMaxProperties) {
    file.FailLine("a property needs a type and a name, at most 256 per element");
  }
  for (const ScalarName& scalar : kScalars) {
    if (words[1] != scalar.name) continue;
    element.properties.push_back({std::string(words[2]), scalar, element.record_size});
    element.record_size += scalar.size;
    return;
  }
  file.FailLine("property '" + std::string(words[2]) + "' has type '" + std::string(words[1]) +
                "', allowed are char, uchar, short, ushort, int, uint, float, double");
}

void ParseFormat(const CloudFile& file, const std::vector<std::string_view>& words,
                 PlyHeader& header) {
  if (words.size() < 2 || (words[1] != "ascii" && words[1] != "binary_little_endian")) {
    file.FailLine("format is '" + std::string(words.size() < 2 ? "" : words[1]) +
                  "', allowed are ascii, binary_little_endian");
  }
  header.binary = words[1] != "ascii";
}

PlyHeader ReadHeader(CloudFile& file) {
  if (file.HeaderLine() != "ply") file.FailLine("the first line is not 'ply': no PLY file");
  PlyHeader header;
  bool format_seen = false;
  for (bool done = false; !done;) {
    const std::string line = file.HeaderLine();
    const std::vector<std::string_view> words = SplitWords(line);
    if (words.empty() || words[0] == "obj_info") continue;
    if (words[0] == "comment") {
      ParseComment(file, words, header);
    } else if (words[0] == "format") {
      ParseFormat(file, words, header);
      format_seen = true;
    } else if (words[0] == "element") {
      if (words.size() != 3) file.FailLine("element needs a name and a count");
      constexpr std::int64_t kMaxCount = std::int64_t{1} << 62;
      const std::string name(words[1]);
      if (header.Find(name) != nullptr) file.FailLine("element '" + name + "' is given twice");
      header.elements.push_back({name, 0, {}, false, 0});
      header.elements.back().count =
          HeaderInteger(file, "count of element '" + name + "'", words[2], 0, kMaxCount);
    } else if (words[0] == "property") {
      ParseProperty(file, words, header);
    } else if (words[0] == "end_header") {
      done = true;
    } else {
      file.FailLine("'" + std::string(words[0].substr(0, 40)) + "' is no PLY header entry");
    }
  }
  if (!format_seen) file.FailLine("the header ends without a line format");
  return header;
}

void RequireVertex(const CloudFile& file, const PlyHeader& header) {
  const Element* vertex = header.Find("vertex");
  if (vertex == nullptr || vertex != &header.elements.front() || vertex->has_list) {
    file.FailLine("the first element must be 'vertex', without lists");
  }
  for (const char* name : {"x", "y", "z", "intensity"}) {
    const int i = vertex->Find(name);
    if (i < 0 && name[0] != 'i') {
      file.FailLine("element 'vertex' lacks property '" + std::string(name) + "'");
    }
    if (i >= 0 && vertex->properties[i].type.scalar != Scalar::kF32 &&
        vertex->properties[i].type.scalar != Scalar::kF64) {
      file.FailLine("property '" + std::string(name) + "' has type '" +
                    vertex->properties[i].type.name + "', allowed are float, double");
    }
  }
  const int label = vertex->Find("label");
  if (label >= 0 && (vertex->properties[label].type.scalar == Scalar::kF32 ||
                     vertex->properties[label].type.scalar == Scalar::kF64)) {
    file.FailLine("property 'label' has type '" + std::string(vertex->properties[label].type.name) +
                  "', allowed are whole-number types");
  }
  constexpr std::int64_t kMaxVertices = 2147483647;
  if (vertex->count < 1 || vertex->count > kMaxVertices) {
    file.FailLine("count of element 'vertex' is " + std::to_string(vertex->count) +
                  ", allowed are 1 to 2147483647");
  }
  // What the header claims against what the file holds, before anything is allocated. In text, a
  // number and what separates it from the next take at least two bytes.
  const std::uint64_t left = file.size() - file.position();
  const std::uint64_t min_bytes =
      header.binary ? vertex->record_size : 2 * vertex->properties.size();
  if (static_cast<std::uint64_t>(vertex->count) > (left + 1) / min_bytes) {
    file.FailByte(file.position(), "count of element 'vertex' is " + std::to_string(vertex->count) +
                                       ", the " + std::to_string(left) +
                                       " bytes of data that follow hold at most " +
                                       std::to_string((left + 1) / min_bytes));
  }
}

/// Reads rows of either format as numbers.
class RowReader {
 public:
  RowReader(CloudFile& file, bool binary) : file_(file), binary_(binary) {
    if (binary_) return;
    begin_ = file.position();
    text_.resize(file.size() - begin_);
    file.ReadBytes(text_.data(), text_.size());
  }

  void Read(const Element& element, std::int64_t row, std::vector<double>& values) {
    values.resize(element.properties.size());
    if (binary_) {
      record_.resize(element.record_size);
      file_.ReadBytes(record_.data(), record_.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] =
            Load(record_.data() + element.properties[i].offset, element.properties[i].type.scalar);
      }
      return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
      const auto [stop, code] =
          std::from_chars(text_.data() + at_, text_.data() + text_.size(), values[i]);
      if (code != std::errc()) {
        file_.FailByte(begin_ + at_, "element '" + element.name + "', row " + std::to_string(row) +
                                         ", property '" + element.properties[i].name +
                                         "': no number");
      }
      at_ = static_cast<std::size_t>(stop - text_.data());
    }
  }

 private:
  CloudFile& file_;
  bool binary_;
  std::vector<char> record_;
  std::string text_;
  std::uint64_t begin_ = 0;
  std::size_t at_ = 0;
};

RigidTransform ParseCamera(const CloudFile& file, const Element& camera,
                           const std::vector<double>& values, double unit_m) {
  Eigen::Matrix<double, 3, 4> columns;  // x, y, z axis and position of the camera.
  static const char* kNames[4] = {"x_axis", "y_axis", "z_axis", "view_p"};
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      const int i = camera.Find(std::string(kNames[c]) + "xyz"[r]);
      if (i < 0) {
        file.FailLine("element 'camera' lacks property '" + std::string(kNames[c]) + "xyz"[r] +
                      "'");
      }
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

void ReadVertices(RowReader& rows, const Element& vertex, double unit_m, OrganizedCloud& cloud) {
  const int x = vertex.Find("x"), y = vertex.Find("y"), z = vertex.Find("z");
  const int intensity = vertex.Find("intensity"), label = vertex.Find("label");
  const auto n = static_cast<std::size_t>(vertex.count);
  cloud.p_SP.resize(n);
  if (intensity >= 0) cloud.intensity.resize(n);
  if (label >= 0) cloud.label.resize(n);
  std::vector<double> row;
  for (std::size_t i = 0; i < n; ++i) {
    rows.Read(vertex, static_cast<std::int64_t>(i), row);
    const Vector3 p(row[x], row[y], row[z]);
    cloud.p_SP[i] = p.isZero(0.0) ? InvalidPoint() : Eigen::Vector3f((p * unit_m).cast<float>());
    if (intensity >= 0) cloud.intensity[i] = static_cast<float>(row[intensity]);
    if (label >= 0)
      cloud.label[i] = static_cast<std::uint32_t>(std::clamp(row[label], 0.0, 4294967295.0));
  }
}

struct PlyTail {
  std::optional<RigidTransform> X_camera;
  std::optional<std::pair<double, double>> size;  ///< Width, height.
};

PlyTail ReadTail(const CloudFile& file, RowReader& rows, const PlyHeader& header, double unit_m) {
  PlyTail tail;
  std::vector<double> row;
  for (std::size_t e = 1; e < header.elements.size(); ++e) {
    const Element& element = header.elements[e];
    if (element.has_list) break;  // Faces; what PhoXi adds comes before them or not at all.
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (element.properties.empty()) break;
      rows.Read(element, i, row);
      if (element.name == "camera") tail.X_camera = ParseCamera(file, element, row, unit_m);
      const int width = element.Find("frame_width"), height = element.Find("frame_height");
      if (element.name == "phoxi_frame_params" && width >= 0 && height >= 0) {
        tail.size = {row[width], row[height]};
      }
    }
  }
  return tail;
}

}  // namespace

OrganizedCloud ReadPly(const std::string& path) {
  CloudFile file(path);
  const PlyHeader header = ReadHeader(file);
  RequireVertex(file, header);
  const bool phoxi = header.Find("phoxi_frame_params") != nullptr;
  const double unit_m = header.unit_m.value_or(phoxi ? 0.001 : 1.0);
  OrganizedCloud cloud;
  RowReader rows(file, header.binary);
  ReadVertices(rows, header.elements.front(), unit_m, cloud);
  const PlyTail tail = ReadTail(file, rows, header, unit_m);
  cloud.width = static_cast<int>(cloud.size());
  cloud.height = 1;
  if (tail.size) {
    const auto [width, height] = *tail.size;
    if (width < 1 || height < 1 || width * height != static_cast<double>(cloud.size())) {
      throw Error(ErrorKind::kBadData, path + ": frame_width x frame_height is " + Number(width) +
                                           " x " + Number(height) + ", the file has " +
                                           std::to_string(cloud.size()) + " vertices");
    }
    cloud.width = static_cast<int>(width);
    cloud.height = static_cast<int>(height);
  }
  cloud.X_NS = tail.X_camera.value_or(RigidTransform::Identity());
  if (tail.X_camera && !header.frame_S) {
    const Eigen::Isometry3f X_SN = cloud.X_NS.inverse().cast<float>();
    for (Eigen::Vector3f& p : cloud.p_SP) p = X_SN * p;
  }
  FinishPoints(file, cloud);
  return cloud;
}

OrganizedCloud ReadCloud(const std::string& path) {
  const std::string ending = CloudEnding(path);
  if (ending == ".pcd" || ending == ".pcd.zst") return ReadPcd(path);
  if (ending == ".ply" || ending == ".ply.zst") return ReadPly(path);
  throw Error(ErrorKind::kBadData, path + ": the ending is '" + ending +
                                       "', allowed are .pcd, .ply, .pcd.zst, .ply.zst");
}

}  // namespace tubetwin
