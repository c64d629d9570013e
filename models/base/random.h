#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tubetwin {

/// Counter-based random stream (Philox4x32-10, Random123): a pure function of its key and of how
/// many numbers were drawn, so results never depend on threads, shards, hosts or the clock. A
/// stream is a value; copy it to replay it. Not thread safe: give each thread its own stream.
class RandomStream {
 public:
  /// Stream of one purpose within one round of one campaign.
  RandomStream(std::uint64_t campaign_seed, std::uint64_t round, std::string_view purpose);

  /// An independent stream below this one; does not consume numbers of this one.
  RandomStream Fork(std::string_view purpose, std::uint64_t index = 0) const;

  std::uint32_t NextBits();                 ///< 32 random bits.
  double Uniform();                         ///< [0, 1), 53 bits.
  double Uniform(double low, double high);  ///< [low, high).
  double Normal();                          ///< Mean 0, sigma 1 (Box-Muller, no cache).
  double Normal(double mean, double sigma) { return mean + sigma * Normal(); }
  /// Four words of the endless table that belongs to this stream, in any order; draws nothing.
  /// Other numbers than NextBits gives.
  std::array<std::uint32_t, 4> Block(std::uint64_t index) const;
  /// 32-bit words drawn so far, and a stream of the same key from which `words` were drawn.
  std::uint64_t drawn() const { return 4 * counter_ - (4 - static_cast<std::uint64_t>(used_)); }
  RandomStream After(std::uint64_t words) const;
  /// Integer in [0, n). Precondition: n > 0.
  std::uint32_t Index(std::uint32_t n);

  // UniformRandomBitGenerator, for std and Boost distributions.
  using result_type = std::uint32_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xffffffffu; }
  result_type operator()() { return NextBits(); }

 private:
  RandomStream(std::uint64_t key) : key_(key) {}
  std::uint64_t key_ = 0;
  std::uint64_t counter_ = 0;  ///< Blocks drawn.
  std::uint32_t block_[4] = {};
  int used_ = 4;  ///< Words of block_ already given out.
};

}  // namespace tubetwin
