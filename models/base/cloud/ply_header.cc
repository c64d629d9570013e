#include "models/base/cloud/ply_header.h"

#include <algorithm>
#include <map>

#include "models/base/text.h"

namespace tubetwin {
namespace {

using Words = std::vector<std::string_view>;

PlyType TypeOf(std::string_view name) {
  static const std::map<std::string, PlyType> known = {
      {"char", {'I', 1}},    {"int8", {'I', 1}},  {"uchar", {'U', 1}},   {"uint8", {'U', 1}},
      {"bool", {'U', 1}},    {"short", {'I', 2}}, {"int16", {'I', 2}},   {"ushort", {'U', 2}},
      {"uint16", {'U', 2}},  {"half", {'F', 2}},  {"float16", {'F', 2}}, {"int", {'I', 4}},
      {"int32", {'I', 4}},   {"uint", {'U', 4}},  {"uint32", {'U', 4}},  {"float", {'F', 4}},
      {"float32", {'F', 4}}, {"int64", {'I', 8}}, {"uint64", {'U', 8}},  {"double", {'F', 8}},
      {"float64", {'F', 8}}};
  const auto found = known.find(LowerCase(name));
  return found == known.end() ? PlyType{'?', 0} : found->second;
}

PlyType RequireType(const CloudFile& file, const PlyHeader& header, std::string_view name,
                    std::string_view property) {
  const PlyType type = TypeOf(name);
  if (type.size == 0 && !header.text()) {
    file.FailLine("property " + Quoted(property) + " has type " + Quoted(name) +
                  ", allowed are char, uchar, bool, short, ushort, int, uint, float, double, and "
                  "int8 to int64, uint8 to uint64, float16 to float64");
  }
  return type;
}

void ParseProperty(const CloudFile& file, const Words& words, PlyHeader& header) {
  if (header.elements.empty()) file.FailLine("property stands before any element");
  std::vector<PlyProperty>& properties = header.elements.back().properties;
  const bool list = words.size() > 1 && LowerCase(words[1]) == "list";
  constexpr std::size_t kMaxProperties = 1024;
  if (words.size() < (list ? 5u : 3u) || properties.size() == kMaxProperties) {
    file.FailLine(
        "a property needs a type and a name, a list two types and a name; an element has "
        "at most 1024");
  }
  PlyProperty property;
  property.name = words[list ? 4 : 2];
  property.type = RequireType(file, header, words[list ? 3 : 1], property.name);
  if (list) property.count = RequireType(file, header, words[2], property.name);
  properties.push_back(std::move(property));
}

void ParseElement(const CloudFile& file, const Words& words, PlyHeader& header) {
  if (words.size() < 3) file.FailLine("element needs a name and a count");
  if (words[1] == "vertex" && header.Find("vertex") != nullptr) {
    file.FailLine("element 'vertex' is given twice");
  }
  constexpr std::int64_t kMaxCount = std::int64_t{1} << 62;
  PlyElement element;
  element.name = words[1];
  element.count =
      HeaderInteger(file, "count of element " + Quoted(words[1]), words[2], 0, kMaxCount);
  header.elements.push_back(std::move(element));
}

PlyFormat ParseFormat(const CloudFile& file, const Words& words) {
  const std::string format = words.size() < 2 ? "" : LowerCase(words[1]);
  if (format == "ascii") return PlyFormat::kAscii;
  if (format == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (format == "binary_big_endian") return PlyFormat::kBigEndian;
  file.FailLine("format is " + Quoted(words.size() < 2 ? "" : words[1]) +
                ", allowed are ascii, binary_little_endian, binary_big_endian");
}

}  // namespace

int PlyElement::Find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (LowerCase(properties[i].name) == LowerCase(property)) return static_cast<int>(i);
  }
  return -1;
}

int PlyElement::Need(std::string_view property) {
  const int i = Find(property);
  if (i >= 0) properties[static_cast<std::size_t>(i)].needed = true;
  return i;
}

std::uint64_t PlyElement::SmallestRow(bool text) const {
  // A word of text and what sets it apart from the next take two bytes.
  if (text) return 2 * properties.size();
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) {
    bytes += static_cast<std::uint64_t>(p.count ? p.count->size : p.type.size);
  }
  return bytes;
}

PlyElement* PlyHeader::Find(std::string_view name) {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const PlyElement& element) { return element.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader ReadPlyHeader(CloudFile& file) {
  const std::string first = file.HeaderLine();
  const Words magic = SplitWords(first);
  if (magic.size() != 1 || LowerCase(magic[0]) != "ply") {
    file.FailLine("the first line is not 'ply': no PLY file");
  }
  PlyHeader header;
  bool format_seen = false;
  while (true) {
    const std::string line = file.HeaderLine();
    const Words words = SplitWords(line);
    if (words.empty() || words[0][0] == '#' || words[0].starts_with("//")) continue;
    const std::string key = LowerCase(words[0]);
    if (key == "comment" || key == "obj_info") {
      header.notes.emplace_back(words.begin() + 1, words.end());
    } else if (key == "format") {
      header.format = ParseFormat(file, words);
      format_seen = true;
    } else if (key == "element") {
      if (!format_seen) file.FailLine("element stands before format");
      ParseElement(file, words, header);
    } else if (key == "property") {
      ParseProperty(file, words, header);
    } else if (key == "end_header") {
      if (!format_seen) file.FailLine("the header ends without a line format");
      return header;
    } else if (!header.text() || !format_seen) {
      // In text it may be a comment that was not called one: rows are held against the properties.
      file.FailLine(Quoted(words[0]) +
                    " is no PLY header entry, allowed are format, comment, obj_info, element, "
                    "property, end_header");
    }
  }
}

}  // namespace tubetwin
