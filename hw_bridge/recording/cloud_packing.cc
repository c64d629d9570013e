#include "hw_bridge/recording/cloud_packing.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "hw_bridge/recording/byte_stream.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr std::uint8_t kHasIntensity = 1, kHasLabel = 2;
constexpr int kFactorSamples = 32;  ///< Points that vote for a ray.

/// Floats as integers in the same order, so that neighbours differ by little.
std::uint32_t Ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
float FromOrdered(std::uint32_t ordered) {
  return std::bit_cast<float>(ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered);
}

std::uint32_t ZigZag32(std::uint32_t difference) {
  return (difference << 1) ^ (difference & 0x80000000u ? 0xffffffffu : 0u);
}
std::uint32_t UnZigZag32(std::uint32_t v) { return (v >> 1) ^ (v & 1u ? 0xffffffffu : 0u); }

/// Numbers written so that all lowest bytes come first, then all second ones.
class Planes {
 public:
  explicit Planes(std::size_t count) { values_.reserve(count); }
  void Add(float value, float expected) { Add(Ordered(value) - Ordered(expected)); }
  void Add(std::uint32_t difference) { values_.push_back(ZigZag32(difference)); }
  void Write(ByteWriter& out) const {
    std::string plane(values_.size(), '\0');
    for (int b = 0; b < 4; ++b) {
      for (std::size_t i = 0; i < values_.size(); ++i) {
        plane[i] = static_cast<char>(values_[i] >> (8 * b));
      }
      out.Raw(plane.data(), plane.size());
    }
  }

 private:
  std::vector<std::uint32_t> values_;
};

class PlaneReader {
 public:
  PlaneReader(std::size_t count, ByteReader& in) : count_(count), data_(in.Take(4 * count)) {}
  std::uint32_t Next() {
    std::uint32_t v = 0;
    for (std::size_t b = 0; b < 4; ++b) {
      v |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(data_[b * count_ + at_]))
           << (8 * b);
    }
    ++at_;
    return UnZigZag32(v);
  }
  float Next(float expected) { return FromOrdered(Ordered(expected) + Next()); }

 private:
  std::size_t count_, at_ = 0;
  const char* data_;
};

/// The depth that is expected from the pixels read before: the mean of left and upper neighbour,
/// one of them, or the last valid one.
class DepthGuess {
 public:
  explicit DepthGuess(int width) : upper_(static_cast<std::size_t>(width), 0.0f) {}
  float Guess(int column) const {
    const float up = upper_[static_cast<std::size_t>(column)];
    if (left_ != 0.0f && up != 0.0f) return 0.5f * (left_ + up);
    return left_ != 0.0f ? left_ : up != 0.0f ? up : last_;
  }
  void BeginRow() { left_ = 0.0f; }
  void Valid(int column, float z) {
    left_ = last_ = upper_[static_cast<std::size_t>(column)] = std::isfinite(z) ? z : 0.0f;
  }
  void Invalid(int column) { left_ = upper_[static_cast<std::size_t>(column)] = 0.0f; }

 private:
  std::vector<float> upper_;
  float left_ = 0.0f, last_ = 0.0f;
};

/// Slope of the ray through one column (axis 0) or row (axis 1): the float that times the depth
/// gives the coordinate of most of its points.
class Slope {
 public:
  explicit Slope(int axis) : axis_(axis) {}
  void Vote(const Eigen::Vector3f& p_S) {
    if (votes_ == kFactorSamples || !(p_S.z() > 0)) return;
    if (votes_++ == 0) {
      const float first = p_S[axis_] / p_S.z();
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      candidates_ = {first, std::nextafter(first, -kInfinity), std::nextafter(first, kInfinity)};
    }
    for (std::size_t i = 0; i < 3; ++i) hits_[i] += candidates_[i] * p_S.z() == p_S[axis_] ? 1 : 0;
  }
  float best() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < 3; ++i) best = hits_[i] > hits_[best] ? i : best;
    return std::isfinite(candidates_[best]) ? candidates_[best] : 0.0f;
  }

 private:
  int axis_;
  int votes_ = 0;
  std::array<float, 3> candidates_ = {};
  std::array<int, 3> hits_ = {};
};

struct Slopes {
  std::vector<float> column, row;
};

Slopes FindSlopes(const OrganizedCloud& cloud) {
  std::vector<Slope> column(static_cast<std::size_t>(cloud.width), Slope(0));
  std::vector<Slope> row(static_cast<std::size_t>(cloud.height), Slope(1));
  std::size_t i = 0;
  for (Slope& of_row : row) {
    for (Slope& of_column : column) {
      const Eigen::Vector3f& p = cloud.p_SP[i++];
      if (!IsValid(p)) continue;
      of_column.Vote(p);
      of_row.Vote(p);
    }
  }
  Slopes out;
  for (const Slope& slope : column) out.column.push_back(slope.best());
  for (const Slope& slope : row) out.row.push_back(slope.best());
  return out;
}

void WriteHead(const OrganizedCloud& cloud, ByteWriter& out) {
  out.U32(static_cast<std::uint32_t>(cloud.width));
  out.U32(static_cast<std::uint32_t>(cloud.height));
  out.U8((cloud.intensity.empty() ? 0 : kHasIntensity) | (cloud.label.empty() ? 0 : kHasLabel));
  out.Raw(cloud.X_NS.matrix().data(), 16 * sizeof(double));
}

void WriteMask(const OrganizedCloud& cloud, ByteWriter& out) {
  std::string mask((cloud.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (IsValid(cloud.p_SP[i])) mask[i / 8] = static_cast<char>(mask[i / 8] | (1 << (i % 8)));
  }
  out.Raw(mask.data(), mask.size());
}

void WritePoints(const OrganizedCloud& cloud, const Slopes& slopes, ByteWriter& out) {
  Planes x(cloud.size()), y(cloud.size()), z(cloud.size());
  DepthGuess guess(cloud.width);
  std::size_t i = 0;
  for (int row = 0; row < cloud.height; ++row) {
    guess.BeginRow();
    for (int column = 0; column < cloud.width; ++column) {
      const Eigen::Vector3f& p = cloud.p_SP[i++];
      if (!IsValid(p)) {
        guess.Invalid(column);
        continue;
      }
      z.Add(p.z(), guess.Guess(column));
      x.Add(p.x(), slopes.column[static_cast<std::size_t>(column)] * p.z());
      y.Add(p.y(), slopes.row[static_cast<std::size_t>(row)] * p.z());
      guess.Valid(column, p.z());
    }
  }
  z.Write(out);
  x.Write(out);
  y.Write(out);
}

void ReadPoints(const char* mask, const Slopes& slopes, std::size_t valid, ByteReader& in,
                OrganizedCloud& cloud) {
  PlaneReader z(valid, in), x(valid, in), y(valid, in);
  DepthGuess guess(cloud.width);
  std::size_t i = 0;
  for (int row = 0; row < cloud.height; ++row) {
    guess.BeginRow();
    for (int column = 0; column < cloud.width; ++column, ++i) {
      if ((mask[i / 8] >> (i % 8) & 1) == 0) {
        guess.Invalid(column);
        continue;
      }
      Eigen::Vector3f& p = cloud.p_SP[i];
      p.z() = z.Next(guess.Guess(column));
      p.x() = x.Next(slopes.column[static_cast<std::size_t>(column)] * p.z());
      p.y() = y.Next(slopes.row[static_cast<std::size_t>(row)] * p.z());
      guess.Valid(column, p.z());
    }
  }
}

std::vector<float> ReadFloats(std::size_t count, ByteReader& in) {
  const char* data = in.Take(count * sizeof(float));  // Before room for them is made.
  std::vector<float> out(count);
  if (count > 0) std::memcpy(out.data(), data, count * sizeof(float));
  return out;
}

}  // namespace

std::string PackCloud(const OrganizedCloud& cloud) {
  const std::size_t count = cloud.size();
  TT_CHECK(cloud.width >= 0 && cloud.height >= 0 && count <= kMaxCloudPixels);
  TT_CHECK(static_cast<std::size_t>(cloud.width) * static_cast<std::size_t>(cloud.height) == count);
  TT_CHECK(cloud.intensity.empty() || cloud.intensity.size() == count);
  TT_CHECK(cloud.label.empty() || cloud.label.size() == count);
  std::string bytes;
  ByteWriter out(bytes);
  WriteHead(cloud, out);
  WriteMask(cloud, out);
  const Slopes slopes = FindSlopes(cloud);
  out.Raw(slopes.column.data(), slopes.column.size() * sizeof(float));
  out.Raw(slopes.row.data(), slopes.row.size() * sizeof(float));
  WritePoints(cloud, slopes, out);
  Planes intensity(cloud.intensity.size()), label(cloud.label.size());
  float before = 0.0f;
  for (const float value : cloud.intensity) {
    intensity.Add(value, before);
    before = value;
  }
  std::uint32_t label_before = 0;
  for (const std::uint32_t value : cloud.label) {
    label.Add(value - label_before);
    label_before = value;
  }
  intensity.Write(out);
  label.Write(out);
  return bytes;
}

OrganizedCloud UnpackCloud(std::string_view bytes, const std::string& source) {
  ByteReader in(bytes, source);
  const std::uint64_t width = in.U32(), height = in.U32();
  const std::uint8_t flags = in.U8();
  if (width > kMaxCloudPixels || height > kMaxCloudPixels || width * height > kMaxCloudPixels) {
    in.Fail("a cloud of " + std::to_string(width) + " x " + std::to_string(height) +
            " points, at most " + std::to_string(kMaxCloudPixels) + " are allowed");
  }
  if (flags > (kHasIntensity | kHasLabel)) in.Fail("unknown contents of a cloud");
  OrganizedCloud cloud;
  cloud.width = static_cast<int>(width);
  cloud.height = static_cast<int>(height);
  std::memcpy(cloud.X_NS.matrix().data(), in.Take(16 * sizeof(double)), 16 * sizeof(double));
  const std::size_t count = width * height;
  const char* mask = in.Take((count + 7) / 8);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < count; ++i) valid += mask[i / 8] >> (i % 8) & 1;
  Slopes slopes;
  slopes.column = ReadFloats(width, in);
  slopes.row = ReadFloats(height, in);
  if (in.left() < 12 * valid) in.Fail("fewer points than are marked as valid");
  cloud.p_SP.assign(count, InvalidPoint());
  ReadPoints(mask, slopes, valid, in, cloud);
  if (flags & kHasIntensity) {
    PlaneReader planes(count, in);
    cloud.intensity.resize(count);
    float before = 0.0f;
    for (float& value : cloud.intensity) value = before = planes.Next(before);
  }
  if (flags & kHasLabel) {
    PlaneReader planes(count, in);
    cloud.label.resize(count);
    std::uint32_t before = 0;
    for (std::uint32_t& value : cloud.label) value = before += planes.Next();
  }
  if (!in.AtEnd()) in.Fail("bytes after the cloud's end");
  return cloud;
}

}  // namespace tubetwin
