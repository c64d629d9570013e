// Seeded damage to bytes: of messages, of files that hold no text.

#include <algorithm>

#include "tests/fuzz/mutations.h"

namespace tubetwin {
namespace {

std::string Mutated(std::string bytes, const std::string& other, RandomStream& stream) {
  const auto times = 1 + stream.Index(4);
  for (std::uint32_t k = 0; k < times; ++k) {
    const std::size_t at = stream.Index(static_cast<std::uint32_t>(bytes.size() + 1));
    switch (stream.Index(7)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(stream.Index(256));
        break;
      case 1:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << stream.Index(8)));
        break;
      case 2:
        bytes.erase(at, stream.Index(8));
        break;
      case 3:
        bytes.insert(at, stream.Index(8), static_cast<char>(stream.Index(256)));
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5:
        bytes += other;
        break;
      default:  // A word at its extremes.
        for (std::size_t i = at & ~std::size_t{3};
             i < std::min(bytes.size(), (at & ~std::size_t{3}) + 4); ++i) {
          bytes[i] = static_cast<char>(stream.Uniform() < 0.5 ? 0xff : 0x7f);
        }
    }
  }
  return bytes;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) { return tubetwin::RunMutations(argc, argv, tubetwin::Mutated); }
