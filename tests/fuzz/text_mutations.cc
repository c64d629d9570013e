// The fuzz target of a reader of files without a fuzzer: seeded mutations of the corpus, words and
// lines among them, or the corpus itself as files.
//   NAME_mutations COUNT [SEED [FILE]]  COUNT mutated files; each is written to FILE before it is
//                                       tried, so FILE is what killed the process
//   NAME_mutations --corpus FOLDER      the files that mutations start from

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "models/base/files.h"
#include "models/base/random.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {
namespace {

std::size_t Place(const std::string& text, RandomStream& stream) {
  return stream.Index(static_cast<std::uint32_t>(text.size() + 1));
}

/// Puts a value that breaks careless readers where a word stands.
void ReplaceWord(std::string& text, RandomStream& stream) {
  static const char* const kWords[] = {"-1",
                                       "0",
                                       "1",
                                       "2147483647",
                                       "2147483648",
                                       "4294967296",
                                       "9223372036854775807",
                                       "18446744073709551616",
                                       "1e308",
                                       "-1e400",
                                       "nan",
                                       "-inf",
                                       "0x10",
                                       "F",
                                       "U",
                                       "binary",
                                       "ascii",
                                       "double",
                                       "char",
                                       "list",
                                       "x",
                                       "label",
                                       "intensity",
                                       "element",
                                       "property",
                                       "65536",
                                       "binary_compressed",
                                       "binary_big_endian",
                                       "1.#QNAN",
                                       "0,5",
                                       ";",
                                       "vertex",
                                       "facet",
                                       "endfacet",
                                       "tube,index,x,y,z",
                                       "\"",
                                       "mm",
                                       ""};
  const std::size_t at = Place(text, stream);
  const std::size_t begin = text.find_first_not_of(" \n", at);
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
  const char* const word = kWords[stream.Index(static_cast<std::uint32_t>(std::size(kWords)))];
  text.replace(begin, end - begin, word);
}

void MoveLine(std::string& text, RandomStream& stream, bool keep) {
  const std::size_t begin = text.find('\n', Place(text, stream));
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(text.find('\n', begin + 1), text.size());
  const std::string line = text.substr(begin, end - begin);
  if (!keep) text.erase(begin, end - begin);
  if (stream.Uniform() < 0.7) text.insert(std::min(Place(text, stream), text.size()), line);
}

std::string Mutated(std::string text, const std::string& other, RandomStream& stream) {
  const auto times = 1 + stream.Index(4);
  for (std::uint32_t k = 0; k < times; ++k) {
    const std::size_t at = Place(text, stream);
    switch (stream.Index(8)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(stream.Index(256));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << stream.Index(8)));
        break;
      case 2:
        text.erase(at, stream.Index(24));
        break;
      case 3:
        text.insert(at, stream.Index(24), static_cast<char>(stream.Index(256)));
        break;
      case 4:
        text.insert(at, other, Place(other, stream), stream.Index(40));
        break;
      case 5:
        text.resize(at);
        break;
      case 6:
        MoveLine(text, stream, stream.Uniform() < 0.5);
        break;
      default:
        ReplaceWord(text, stream);
    }
  }
  return text;
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
    std::fprintf(stderr, "usage: %s COUNT [SEED [FILE]] | --corpus FOLDER\n", argv[0]);
    return 64;
  }
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 1);
  const auto files = static_cast<std::uint32_t>(corpus.size());
  for (const std::string& text : corpus) TryBytes(text);
  for (int i = 0; i < count; ++i) {
    RandomStream stream(seed, static_cast<std::uint64_t>(i), "text mutation");
    const std::string text =
        Mutated(corpus[stream.Index(files)], corpus[stream.Index(files)], stream);
    if (argc > 3) WriteFileAtomically(argv[3], text);
    TryBytes(text);
  }
  std::printf("%d mutated files read or refused\n", count);
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) { return tubetwin::Run(argc, argv); }
