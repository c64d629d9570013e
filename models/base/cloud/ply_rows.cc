#include "models/base/cloud/ply_rows.h"

#include <algorithm>
#include <cmath>

#include "models/base/cloud/column_number.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// Lines of text data that hold no numbers.
bool IsNote(std::string_view word) {
  return word.starts_with('#') || word == "comment" || word == "obj_info";
}

std::string_view WordAt(const std::string& text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && !IsBlank(text[end])) ++end;
  return std::string_view(text).substr(at, end - at);
}

}  // namespace

PlyRows::PlyRows(CloudFile& file, const PlyHeader& header)
    : file_(file), header_(header), begin_(file.position()) {
  if (!header.text()) return;
  text_ = file.ReadRest();
  free_lines_ = WordsAddUp();
}

bool PlyRows::WordsAddUp() const {
  double needed = 0;
  for (const PlyElement& element : header_.elements) {
    for (const PlyProperty& property : element.properties) {
      if (property.count && element.count > 0) return false;
    }
    needed += static_cast<double>(element.count) * static_cast<double>(element.properties.size());
  }
  double words = 0;
  bool in_word = false;
  for (const char c : text_) {
    const bool blank = IsBlank(c);
    words += !blank && !in_word;
    in_word = !blank;
  }
  return words == needed;
}

void PlyRows::RequireRoom(const PlyElement& element) const {
  constexpr std::int64_t kMaxRows = 2147483647;
  const std::uint64_t left = header_.text() ? text_.size() - at_ : file_.size() - file_.position();
  const std::uint64_t row = std::max<std::uint64_t>(element.SmallestRow(header_.text()), 1);
  // The last word of a text needs nothing behind it.
  if (element.count <= kMaxRows && static_cast<std::uint64_t>(element.count) <= (left + 1) / row) {
    return;
  }
  file_.FailByte(file_.size() - left,
                 "count of element " + Quoted(element.name) + " is " +
                     std::to_string(element.count) + ", the " + std::to_string(left) +
                     " bytes of data that follow hold at most " + std::to_string((left + 1) / row) +
                     ": the file is cut off");
}

void PlyRows::Read(const PlyElement& element, std::int64_t row, PlyRow& out) {
  out.values.assign(element.properties.size(), 0.0);
  out.lists.resize(element.properties.size());
  header_.text() ? ReadText(element, row, out) : ReadBinary(element, out);
}

void PlyRows::Skip(const PlyElement& element) {
  if (element.properties.empty()) return;
  PlyRow row;
  for (std::int64_t i = 0; i < element.count; ++i) Read(element, i, row);
}

double PlyRows::BinaryNumber(const PlyType& type) {
  char bytes[8];
  file_.ReadBytes(bytes, static_cast<std::size_t>(type.size));
  if (header_.format == PlyFormat::kBigEndian) std::reverse(bytes, bytes + type.size);
  return ColumnNumber(bytes, type.kind, type.size);
}

void PlyRows::ReadBinary(const PlyElement& element, PlyRow& out) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (!property.count) {
      out.values[i] = BinaryNumber(property.type);
      continue;
    }
    const std::uint64_t before = file_.position();
    const double count = BinaryNumber(*property.count);
    const double bytes = count * property.type.size;
    if (!(count >= 0) || count != std::floor(count) ||
        bytes > static_cast<double>(file_.size() - file_.position())) {
      file_.FailByte(before, "element " + Quoted(element.name) + ", property " +
                                 Quoted(property.name) + ": a list of " + Number(count) +
                                 " numbers, the file has " +
                                 std::to_string(file_.size() - file_.position()) + " bytes more");
    }
    std::vector<double>& list = out.lists[i];
    list.resize(property.needed ? static_cast<std::size_t>(count) : 0);
    for (double& value : list) value = BinaryNumber(property.type);
    if (!property.needed) file_.SkipBytes(static_cast<std::uint64_t>(bytes));
  }
}

void PlyRows::ReadText(const PlyElement& element, std::int64_t row, PlyRow& out) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::string_view word = NextWord(element, row, property);
    if (!property.count) {
      if (property.needed) out.values[i] = TextNumber(word, element, row, property);
      continue;
    }
    const double count = TextNumber(word, element, row, property);
    const auto left = static_cast<double>(text_.size() - at_);
    if (!(count >= 0) || count != std::floor(count) || count > left) {
      Fail(element, row, property.name, "is a list of " + Quoted(word) + " numbers");
    }
    std::vector<double>& list = out.lists[i];
    list.clear();
    for (double k = 0; k < count; ++k) {
      const std::string_view item = NextWord(element, row, property);
      if (property.needed) list.push_back(TextNumber(item, element, row, property));
    }
  }
  if (!free_lines_) RequireLineEnd(element, row);
}

std::string_view PlyRows::NextWord(const PlyElement& element, std::int64_t row,
                                   const PlyProperty& of) {
  while (true) {
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
    if (at_ == text_.size()) Fail(element, row, of.name, "is missing: the data ends");
    const std::string_view word = WordAt(text_, at_);
    if (!IsNote(word)) {
      at_ += word.size();
      return word;
    }
    at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
  }
}

double PlyRows::TextNumber(std::string_view word, const PlyElement& element, std::int64_t row,
                           const PlyProperty& of) const {
  if (const auto value = ParseNumber(word)) return *value;
  const bool comma = word.find(',') != std::string_view::npos;
  Fail(element, row, of.name,
       "is " + Quoted(word) + ", no number" +
           (comma ? ": numbers are written with a point and set apart by blanks" : ""));
}

/// A line that goes on has more columns than the header says, and every later row would be wrong.
void PlyRows::RequireLineEnd(const PlyElement& element, std::int64_t row) {
  while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  if (at_ == text_.size() || IsBlank(text_[at_]) || element.properties.empty()) return;
  const std::string_view word = WordAt(text_, at_);
  if (IsNote(word)) return;
  file_.FailByte(begin_ + at_, "element " + Quoted(element.name) + ", row " + std::to_string(row) +
                                   ": the line goes on with " + Quoted(word) +
                                   ", the header says " +
                                   std::to_string(element.properties.size()) + " properties");
}

void PlyRows::Fail(const PlyElement& element, std::int64_t row, const std::string& name,
                   const std::string& problem) const {
  file_.FailByte(begin_ + at_, "element " + Quoted(element.name) + ", row " + std::to_string(row) +
                                   ", property " + Quoted(name) + ": " + problem);
}

}  // namespace tubetwin
