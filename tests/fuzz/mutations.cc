#include "tests/fuzz/mutations.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "models/base/files.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {

int RunMutations(int argc, char** argv, const Mutation& mutated) {
  const std::vector<std::string> corpus = ByteCorpus();
  if (argc == 3 && std::strcmp(argv[1], "--corpus") == 0) {
    for (std::size_t i = 0; i < corpus.size(); ++i) {
      WriteFileAtomically(std::string(argv[2]) + "/" + std::to_string(i), corpus[i]);
    }
    return 0;
  }
  const int count = argc > 1 ? std::atoi(argv[1]) : 0;
  if (count <= 0) {
    std::fprintf(stderr, "usage: %s COUNT [SEED [FILE]] | --corpus FOLDER\n", argv[0]);
    return 64;
  }
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1);
  const auto inputs = static_cast<std::uint32_t>(corpus.size());
  for (const std::string& input : corpus) TryBytes(input);
  for (int i = 0; i < count; ++i) {
    RandomStream stream(seed, static_cast<std::uint64_t>(i), "mutation");
    const std::string input =
        mutated(corpus[stream.Index(inputs)], corpus[stream.Index(inputs)], stream);
    if (argc > 3) WriteMessageFile(argv[3], input);
    TryBytes(input);
  }
  std::printf("%d mutated inputs read or refused\n", count);
  return 0;
}

}  // namespace tubetwin
