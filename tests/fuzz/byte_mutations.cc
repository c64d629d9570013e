// A decoder's fuzz target without a fuzzer: seeded mutations of the corpus, or the corpus as files.
//   NAME_mutations COUNT [SEED]     COUNT mutated inputs
//   NAME_mutations --corpus FOLDER  the inputs that mutations start from

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "models/base/files.h"
#include "models/base/random.h"
#include "tests/fuzz/byte_target.h"

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

int Run(int argc, char** argv) {
  const std::vector<std::string> corpus = ByteCorpus();
  if (argc == 3 && std::strcmp(argv[1], "--corpus") == 0) {
    for (std::size_t i = 0; i < corpus.size(); ++i) {
      WriteFileAtomically(std::string(argv[2]) + "/" + std::to_string(i), corpus[i]);
    }
    return 0;
  }
  const int count = argc > 1 ? std::atoi(argv[1]) : 0;
  if (count <= 0) {
    std::fprintf(stderr, "usage: %s COUNT [SEED] | --corpus FOLDER\n", argv[0]);
    return 64;
  }
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1);
  const auto inputs = static_cast<std::uint32_t>(corpus.size());
  for (const std::string& bytes : corpus) TryBytes(bytes);
  for (int i = 0; i < count; ++i) {
    RandomStream stream(seed, static_cast<std::uint64_t>(i), "byte mutation");
    TryBytes(Mutated(corpus[stream.Index(inputs)], corpus[stream.Index(inputs)], stream));
  }
  std::printf("%d mutated inputs decoded or refused\n", count);
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) { return tubetwin::Run(argc, argv); }
