// Seeded damage to texts: bytes, lines, and words or tokens, after which much of a text still
// parses.

#include <algorithm>
#include <iterator>

#include "tests/fuzz/mutations.h"

namespace tubetwin {
namespace {

std::size_t Place(const std::string& text, RandomStream& stream) {
  return stream.Index(static_cast<std::uint32_t>(text.size() + 1));
}

/// Values that break careless readers.
// clang-format off
constexpr const char* kWords[] = {"-1", "0", "1", "2147483647", "2147483648", "4294967296",
    "9223372036854775807", "18446744073709551616", "1e308", "-1e400", "nan", "-inf", "0x10",
    "F", "U", "binary", "ascii", "double", "char", "list", "x", "label", "intensity", "element",
    "property", "65536", "binary_compressed", "binary_big_endian", "1.#QNAN", "0,5", ";",
    "vertex", "facet", "endfacet", "tube,index,x,y,z", "\"", "mm", "1e300", "1e-320", "-0.0",
    "null", "true", "[]", "{}", "[[[[[[[[[[", "{\"a\":", "\"x\"", "\"a\\nb\"",
    "\"\\u001b[31m\"", "1979-05-27", "\'\'\'", ""};
// clang-format on

/// Puts a value that breaks careless readers where a word stands.
void ReplaceWord(std::string& text, RandomStream& stream) {
  const std::size_t at = Place(text, stream);
  // Words as tables have them, or the tokens of JSON and TOML: much of a text still parses then.
  const char* const around = stream.Uniform() < 0.5 ? " \n" : " \t\n,:;=[]{}()";
  const std::size_t begin = text.find_first_not_of(around, at);
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(text.find_first_of(around, begin), text.size());
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

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) { return tubetwin::RunMutations(argc, argv, tubetwin::Mutated); }
