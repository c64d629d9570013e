#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "models/base/error.h"

namespace tubetwin {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

/// Appends to bytes; little-endian. What cell recordings and their export are written with.
class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}

  void U8(std::uint8_t v) { out_.push_back(static_cast<char>(v)); }
  void U16(std::uint16_t v) { Raw(&v, sizeof v); }
  void U32(std::uint32_t v) { Raw(&v, sizeof v); }
  void U64(std::uint64_t v) { Raw(&v, sizeof v); }
  void I64(std::int64_t v) { Raw(&v, sizeof v); }
  void F64(double v) { Raw(&v, sizeof v); }
  void Raw(const void* data, std::size_t size) {
    out_.append(static_cast<const char*>(data), size);
  }
  /// Seven bits a byte, lowest first: small numbers take one.
  void Varint(std::uint64_t v) {
    while (v >= 0x80) {
      U8(static_cast<std::uint8_t>(v | 0x80));
      v >>= 7;
    }
    U8(static_cast<std::uint8_t>(v));
  }
  void Signed(std::int64_t v) { Varint(ZigZag(v)); }
  void Text(std::string_view text) {
    Varint(text.size());
    Raw(text.data(), text.size());
  }

  /// 0, -1, 1, -2 ... as 0, 1, 2, 3 ...
  static std::uint64_t ZigZag(std::int64_t v) {
    return (static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63);
  }

 private:
  std::string& out_;
};

/// Reads bytes that ByteWriter wrote, or anything. A view: bytes must outlive it. Every function
/// throws Error(kBadData) "SOURCE: byte N of it: WHAT" when the bytes end before what is asked for.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string source)
      : bytes_(bytes), source_(std::move(source)) {}

  bool AtEnd() const { return at_ == bytes_.size(); }
  std::size_t position() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  std::uint8_t U8() { return static_cast<std::uint8_t>(*Take(1)); }
  std::uint16_t U16() { return Number<std::uint16_t>(); }
  std::uint32_t U32() { return Number<std::uint32_t>(); }
  std::uint64_t U64() { return Number<std::uint64_t>(); }
  std::int64_t I64() { return Number<std::int64_t>(); }
  double F64() { return Number<double>(); }
  std::uint64_t Varint() {
    std::uint64_t v = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t byte = U8();
      v |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if ((byte & 0x80) == 0) return v;
    }
    Fail("a number does not end");
  }
  std::int64_t Signed() { return UnZigZag(Varint()); }
  /// A number of things of at least `min_bytes` each that the rest must hold.
  std::size_t Count(std::size_t min_bytes) {
    const std::uint64_t count = Varint();
    if (count > left() / min_bytes) {
      Fail("a count of " + std::to_string(count) + ", but only " + std::to_string(left()) +
           " bytes are left");
    }
    return static_cast<std::size_t>(count);
  }
  std::string Text() {
    const std::size_t size = Count(1);
    return std::string(Take(size), size);
  }
  /// The next `size` bytes.
  const char* Take(std::size_t size) {
    if (size > left()) {
      Fail(std::to_string(size) + " bytes are needed, " + std::to_string(left()) + " are left");
    }
    const char* data = bytes_.data() + at_;
    at_ += size;
    return data;
  }

  static std::int64_t UnZigZag(std::uint64_t v) {
    return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(ErrorKind::kBadData, source_ + ": byte " + std::to_string(at_) + " of it: " + what);
  }

 private:
  template <typename T>
  T Number() {
    T v;
    std::memcpy(&v, Take(sizeof v), sizeof v);
    return v;
  }

  std::string_view bytes_;
  std::string source_;
  std::size_t at_ = 0;
};

}  // namespace tubetwin
