#include "models/base/random.h"

#include <algorithm>
#include <cmath>

#include <Random123/philox.h>

#include "models/base/error.h"
#include "models/base/frames.h"

namespace tubetwin {
namespace {

// FNV-1a with a finaliser (splitmix64): keys need only be distinct and well spread.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Word 2 of the counter tells tables apart.
constexpr std::uint32_t kDrawn = 0, kTable = 1;

std::array<std::uint32_t, 4> Philox(std::uint64_t key, std::uint64_t counter, std::uint32_t table) {
  const r123::Philox4x32::ctr_type at = {
      {static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), table, 0}};
  const r123::Philox4x32::key_type with = {
      {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  const auto out = r123::Philox4x32()(at, with);
  return {out[0], out[1], out[2], out[3]};
}

std::uint64_t HashText(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325ull;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return Mix(h);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t campaign_seed, std::uint64_t round,
                           std::string_view purpose)
    : key_(Mix(Mix(Mix(campaign_seed) ^ round) ^ HashText(purpose))) {}

RandomStream RandomStream::Fork(std::string_view purpose, std::uint64_t index) const {
  return RandomStream(Mix(Mix(key_ ^ HashText(purpose)) ^ index));
}

std::uint32_t RandomStream::NextBits() {
  if (used_ == 4) {
    const auto block = Philox(key_, counter_++, kDrawn);
    std::copy(block.begin(), block.end(), block_);
    used_ = 0;
  }
  return block_[used_++];
}

RandomStream RandomStream::After(std::uint64_t words) const {
  RandomStream out(key_);
  out.counter_ = words / 4;
  for (std::uint64_t i = 0; i < words % 4; ++i) out.NextBits();
  return out;
}

std::array<std::uint32_t, 4> RandomStream::Block(std::uint64_t index) const {
  return Philox(key_, index, kTable);
}

double RandomStream::Uniform() {
  const std::uint64_t high = NextBits() >> 5;  // 27 bits
  const std::uint64_t low = NextBits() >> 6;   // 26 bits
  return static_cast<double>((high << 26) | low) * 0x1.0p-53;
}

double RandomStream::Uniform(double low, double high) { return low + (high - low) * Uniform(); }

double RandomStream::Normal() {
  const double u = 1.0 - Uniform();  // (0, 1]: the logarithm is finite.
  const double v = Uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

std::uint32_t RandomStream::Index(std::uint32_t n) {
  TT_CHECK(n > 0);
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(NextBits()) * n) >> 32);
}

}  // namespace tubetwin
