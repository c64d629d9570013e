#include "hw_bridge/base/random.h"

#include <cmath>

#include <Random123/philox.h>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/frames.h"

namespace tubetwin {
namespace {

// FNV-1a with a finaliser (splitmix64): keys need only be distinct and well spread.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
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
    r123::Philox4x32 philox;
    const r123::Philox4x32::ctr_type counter = {
        {static_cast<std::uint32_t>(counter_), static_cast<std::uint32_t>(counter_ >> 32), 0, 0}};
    const r123::Philox4x32::key_type key = {
        {static_cast<std::uint32_t>(key_), static_cast<std::uint32_t>(key_ >> 32)}};
    const auto out = philox(counter, key);
    for (int i = 0; i < 4; ++i) block_[i] = out[i];
    ++counter_;
    used_ = 0;
  }
  return block_[used_++];
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
