#pragma once

#include <string>
#include <string_view>

namespace tubetwin {

/// Lines of a pile's text with their numbers, for errors. Lines end in LF, CR LF or CR; a byte
/// order mark is skipped. Internal to the readers of piles. Views stay valid as long as the text.
class TextLines {
 public:
  TextLines(std::string_view text, const std::string& source);

  /// Goes to the next line that is not blank; false at the end.
  bool Next();
  /// Next(); throws Error(kBadData) where the file ends instead.
  void Need(const std::string& what);
  std::string_view line() const { return line_; }  ///< Without blanks at its end.
  int number() const { return number_; }           ///< From 1.

  /// Throws Error(kBadData) "SOURCE: line N: problem"; `number` 0: the current line.
  [[noreturn]] void Fail(const std::string& problem, int number = 0) const;
  /// A finite number. Throws like Fail.
  double AsNumber(std::string_view field, const std::string& name) const;
  /// A whole number; "3.0" is one. Throws like Fail.
  int AsInteger(std::string_view field, const std::string& name, int low, int high) const;

 private:
  std::string_view rest_;
  std::string source_;
  std::string_view line_;
  int number_ = 0;
};

}  // namespace tubetwin
