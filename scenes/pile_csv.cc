#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "models/base/foreign/length_unit.h"
#include "models/base/text.h"
#include "scenes/pile_text.h"
#include "scenes/text_lines.h"

namespace tubetwin {
namespace {

constexpr const char kCsvHeader[] = "tube,index,x,y,z";
constexpr int kMaxCsvTubes = 1000, kMaxCsvNodes = 10000;

using Fields = std::vector<std::string>;

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// A line's fields without blanks and quotes around them. A separator within quotes is none; blanks
/// as separators count once.
Fields SplitFields(std::string_view line, char separator) {
  Fields fields;
  std::string field;
  bool quoted = false;
  const auto add = [&] {
    if (separator != ' ' || !field.empty()) fields.emplace_back(Trimmed(field));
    field.clear();
  };
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == separator || (separator == ' ' && c == '\t'))) {
      add();
    } else {
      field += c;
    }
  }
  add();
  return fields;
}

/// The columns that are read, by their place in a line; and what else the header says.
struct Columns {
  enum { kTube, kIndex, kX, kY, kZ, kRadius, kCount };
  int at[kCount] = {-1, -1, -1, -1, -1, -1};
  std::optional<double> unit_m[kCount];  ///< "x_mm" or "x [mm]".
  std::size_t count = 0;
  char separator = ',';
};
constexpr const char* kColumnNames[Columns::kCount] = {"tube", "index", "x", "y", "z", "radius"};

/// Splits "x_mm", "x [mm]" or "x (mm)" into name and unit; any other name is whole.
std::pair<std::string, std::optional<double>> NameAndUnit(const std::string& field) {
  const std::string low = LowerCase(field);
  const std::size_t cut = low.find_first_of("_[( ");
  if (cut == std::string::npos) return {low, std::nullopt};
  std::string unit;
  for (const char c : low.substr(cut)) {
    if (std::string_view("_[]() ").find(c) == std::string_view::npos) unit += c;
  }
  if (const auto unit_m = MetresPer(unit)) return {low.substr(0, cut), unit_m};
  return {low, std::nullopt};
}

Columns ParseHeader(const TextLines& lines, std::optional<char> said) {
  const std::string_view line = lines.line();
  Columns columns;
  columns.separator = ' ';
  for (const char c : {',', '\t', ';'}) {
    if (line.find(c) != std::string_view::npos) columns.separator = c;
  }
  if (said) columns.separator = *said;
  const Fields names = SplitFields(line, columns.separator);
  columns.count = names.size();
  for (int k = 0; k < Columns::kCount; ++k) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto [name, unit_m] = NameAndUnit(names[i]);
      if (name != kColumnNames[k]) continue;
      if (columns.at[k] >= 0) {
        lines.Fail("header names '" + name + "' twice; allowed: " + kCsvHeader + " once each");
      }
      columns.at[k] = static_cast<int>(i);
      columns.unit_m[k] = unit_m;
    }
  }
  for (int k = 0; k < Columns::kRadius; ++k) {
    if (columns.at[k] >= 0) continue;
    lines.Fail("header is '" + Printable(line.substr(0, 60)) + "' and lacks '" + kColumnNames[k] +
               "'; allowed: columns " + kCsvHeader + " in any order, and others");
  }
  const auto& unit = columns.unit_m;
  if (unit[Columns::kX] != unit[Columns::kY] || unit[Columns::kX] != unit[Columns::kZ]) {
    lines.Fail("header gives x, y and z different units; allowed: one");
  }
  return columns;
}

/// A number that may have a decimal comma: where commas separate no columns, or in quotes.
std::string WithPoint(const std::string& field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string::npos || comma != field.rfind(',') ||
      field.find('.') != std::string::npos) {
    return field;
  }
  std::string out = field;
  out[comma] = '.';
  return out;
}

struct Row {
  int line = 0, index = 0;
  Vector3 p = Vector3::Zero();
  double radius = 0.0;
};
struct RowsOfTube {
  int id = 0;
  std::vector<Row> rows;
};

/// One row's fields, as many as the header has; empty where the line holds nothing but separators,
/// as spreadsheets leave them.
Fields RowFields(const TextLines& lines, const Columns& columns) {
  Fields fields = SplitFields(lines.line(), columns.separator);
  if (std::all_of(fields.begin(), fields.end(), [](auto& field) { return field.empty(); })) {
    return {};
  }
  while (fields.size() > columns.count && fields.back().empty()) fields.pop_back();
  if (fields.size() == columns.count) return fields;
  std::string problem = "has " + std::to_string(fields.size()) + " fields; the header has " +
                        std::to_string(columns.count);
  if (columns.separator == ',' && fields.size() > columns.count) {
    problem += ". Decimal commas? Set columns apart by ';' then, or write points";
  }
  lines.Fail(problem);
}

std::vector<RowsOfTube> ReadRows(TextLines& lines, const Columns& columns) {
  std::vector<RowsOfTube> tubes;
  std::map<int, std::size_t> place;
  while (lines.Next()) {
    if (lines.line().starts_with('#')) continue;
    const Fields fields = RowFields(lines, columns);
    if (fields.empty()) continue;
    const auto field = [&](int k) { return fields[static_cast<std::size_t>(columns.at[k])]; };
    const auto number = [&](int k) { return lines.AsNumber(WithPoint(field(k)), kColumnNames[k]); };
    Row row;
    row.line = lines.number();
    const int id =
        lines.AsInteger(field(Columns::kTube), "tube", 0, std::numeric_limits<int>::max());
    row.index = lines.AsInteger(field(Columns::kIndex), "index", 0, kMaxCsvNodes);
    row.p = {number(Columns::kX), number(Columns::kY), number(Columns::kZ)};
    if (columns.at[Columns::kRadius] >= 0) {
      row.radius = number(Columns::kRadius);
      if (!(row.radius > 0)) lines.Fail("radius is " + Number(row.radius) + "; allowed: above 0");
    }
    const auto [found, added] = place.emplace(id, tubes.size());
    if (added) {
      if (tubes.size() >= kMaxCsvTubes) lines.Fail("more than 1000 tubes");
      tubes.push_back({id, {}});
    }
    tubes[found->second].rows.push_back(row);
  }
  return tubes;
}

/// Rows in the order of their indices, which count from `first` without a gap. True when they came
/// so.
bool SortRows(const TextLines& lines, int first, RowsOfTube& tube) {
  const auto before = [](const Row& a, const Row& b) { return a.index < b.index; };
  const bool sorted = std::is_sorted(tube.rows.begin(), tube.rows.end(), before);
  std::stable_sort(tube.rows.begin(), tube.rows.end(), before);
  for (std::size_t i = 0; i < tube.rows.size(); ++i) {
    const Row& row = tube.rows[i];
    const int expected = first + static_cast<int>(i);
    if (row.index != expected) {
      lines.Fail("index of tube " + std::to_string(tube.id) + " is " + std::to_string(row.index) +
                     (row.index < expected ? ", which it had before"
                                           : ", and it has no " + std::to_string(expected)) +
                     "; allowed: each from " + std::to_string(first) + " on once",
                 row.line);
    }
    if (row.radius != tube.rows[0].radius) {
      lines.Fail("radius of tube " + std::to_string(tube.id) + " is " + Number(row.radius) +
                     ", at its first point " + Number(tube.rows[0].radius) + "; allowed: one",
                 row.line);
    }
  }
  return sorted;
}

}  // namespace

std::vector<TextTube> ParsePileCsv(const std::string& text, const std::string& source,
                                   std::optional<double> unit_m) {
  TextLines lines(text, source);
  std::optional<char> separator;
  do {
    lines.Need(std::string("the header ") + kCsvHeader);
    // Excel's own way to name it.
    if (lines.line().starts_with("sep=") && lines.line().size() == 5) separator = lines.line()[4];
  } while (lines.line().starts_with('#') || lines.line().starts_with("sep="));
  const Columns columns = ParseHeader(lines, separator);
  std::vector<RowsOfTube> read = ReadRows(lines, columns);
  int first = 1;
  for (const RowsOfTube& tube : read) {
    for (const Row& row : tube.rows) first = std::min(first, row.index);
  }
  bool sorted = true;
  for (RowsOfTube& tube : read) sorted = SortRows(lines, first, tube) && sorted;
  if (!sorted) {
    std::sort(read.begin(), read.end(), [](auto& a, auto& b) { return a.id < b.id; });
  }
  const double scale = unit_m.value_or(columns.unit_m[Columns::kX].value_or(1.0));
  const double radius_scale = columns.unit_m[Columns::kRadius].value_or(scale);
  std::vector<TextTube> tubes;
  for (const RowsOfTube& tube : read) {
    tubes.push_back({tube.id, {}, radius_scale * tube.rows[0].radius});
    for (const Row& row : tube.rows) tubes.back().centerline_N.push_back(scale * row.p);
  }
  return tubes;
}

}  // namespace tubetwin
