#include "models/base/cloud/lzf.h"

#include "models/base/error.h"

namespace tubetwin {
namespace {

/// What is left to unpack, and what was unpacked.
class Stream {
 public:
  Stream(std::string_view packed, std::size_t size, const std::string& source)
      : packed_(packed), size_(size), source_(source) {
    if (size > packed.size() * kLzfLargestRatio) Fail("is too short");
    out_.reserve(size);
  }

  std::string Unpacked() {
    while (at_ < packed_.size()) {
      const std::size_t control = Next();
      if (control < 32) {
        Literal(control + 1);
      } else {
        Repeat(control);
      }
    }
    if (out_.size() != size_) Fail("ends early");
    return std::move(out_);
  }

 private:
  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorKind::kBadData, source_ + ": the compressed data (LZF, " +
                                         std::to_string(packed_.size()) + " bytes) " + problem +
                                         " at its byte " + std::to_string(at_) + ", after " +
                                         std::to_string(out_.size()) + " of " +
                                         std::to_string(size_) + " bytes: the file is damaged");
  }
  std::size_t Next() {
    if (at_ == packed_.size()) Fail("ends inside a run");
    return static_cast<unsigned char>(packed_[at_++]);
  }
  void Literal(std::size_t count) {
    if (count > packed_.size() - at_) Fail("ends inside a run");
    if (count > size_ - out_.size()) Fail("goes on");
    out_.append(packed_.substr(at_, count));
    at_ += count;
  }
  void Repeat(std::size_t control) {
    std::size_t count = (control >> 5) + 2;
    if (control >> 5 == 7) count += Next();
    const std::size_t distance = ((control & 0x1f) << 8 | Next()) + 1;
    if (distance > out_.size()) Fail("points before its beginning");
    if (count > size_ - out_.size()) Fail("goes on");
    // Byte by byte: a run may reach into what it writes.
    for (std::size_t i = 0; i < count; ++i) out_.push_back(out_[out_.size() - distance]);
  }

  std::string_view packed_;
  std::size_t size_;
  const std::string& source_;
  std::string out_;
  std::size_t at_ = 0;
};

}  // namespace

std::string LzfUnpacked(std::string_view packed, std::size_t size, const std::string& source) {
  return Stream(packed, size, source).Unpacked();
}

}  // namespace tubetwin
