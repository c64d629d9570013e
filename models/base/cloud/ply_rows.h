#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/cloud/ply_header.h"

namespace tubetwin {

/// One row of an element: what PlyElement::Need() asked for, by the index of its property.
struct PlyRow {
  std::vector<double> values;              ///< Of single numbers.
  std::vector<std::vector<double>> lists;  ///< Of lists.
};

/// Reads the rows of a PLY file one after the other, in the header's order. What nobody needs is
/// passed over, whatever it holds. Internal to the readers of clouds and meshes. One thread.
class PlyRows {
 public:
  /// Both must outlive this object; the header's data comes next in `file`.
  PlyRows(CloudFile& file, const PlyHeader& header);

  /// Throws Error(kBadData) when the file cannot hold all rows of the element that comes next, or
  /// when they are more than 2^31 - 1: before anything is allocated for them.
  void RequireRoom(const PlyElement& element) const;
  /// Throws Error(kBadData) naming byte, element, row and property where the data ends or holds no
  /// number.
  void Read(const PlyElement& element, std::int64_t row, PlyRow& out);
  /// Passes over all rows of an element. Throws like Read.
  void Skip(const PlyElement& element);

 private:
  void ReadBinary(const PlyElement& element, PlyRow& out);
  void ReadText(const PlyElement& element, std::int64_t row, PlyRow& out);
  double BinaryNumber(const PlyType& type);
  std::string_view NextWord(const PlyElement& element, std::int64_t row, const PlyProperty& of);
  double TextNumber(std::string_view word, const PlyElement& element, std::int64_t row,
                    const PlyProperty& of) const;
  void RequireLineEnd(const PlyElement& element, std::int64_t row);
  bool WordsAddUp() const;
  [[noreturn]] void Fail(const PlyElement& element, std::int64_t row, const std::string& name,
                         const std::string& problem) const;

  CloudFile& file_;
  const PlyHeader& header_;
  std::string text_;
  std::uint64_t begin_ = 0;  ///< Byte of the file where text_ begins.
  std::size_t at_ = 0;
  bool free_lines_ = false;  ///< Rows need not end where lines do: the words are as many as needed.
};

}  // namespace tubetwin
