#include "models/base/config/nesting.h"

namespace tubetwin::config_internal {
namespace {

/// Walks over a TOML text, past comments and quoted texts. What is no valid TOML may be read
/// otherwise than a parser would, but a parser ends there.
class Walker {
 public:
  explicit Walker(std::string_view toml) : rest_(toml) {}

  std::optional<int> FindDeep() {
    while (!rest_.empty()) {
      const char c = rest_.front();
      if (c == '#') {
        SkipTo(rest_.find('\n'));
      } else if (c == '"' || c == '\'') {
        SkipText(c);
      } else {
        Count(c);
        rest_.remove_prefix(1);
      }
      if (brackets_ > kDeepestNesting || parts_ > kDeepestNesting) return line_;
    }
    return std::nullopt;
  }

 private:
  void Count(char c) {
    if (c == '\n') ++line_;
    if (c == '[' || c == '{') ++brackets_;
    if ((c == ']' || c == '}') && brackets_ > 0) --brackets_;
    if (c == '.') ++parts_;
    // A key ends here, or a value does.
    if (std::string_view("=,\n[]{}").find(c) != std::string_view::npos) parts_ = 1;
  }

  void SkipTo(std::size_t at) {
    const std::string_view skipped = rest_.substr(0, at);
    for (const char c : skipped) line_ += c == '\n' ? 1 : 0;
    rest_.remove_prefix(skipped.size());
  }

  /// Past a text in quotes, which three of them in a row let run over lines.
  void SkipText(char quote) {
    const bool long_text = rest_.size() >= 3 && rest_[1] == quote && rest_[2] == quote;
    std::size_t at = long_text ? 3 : 1;
    for (; at < rest_.size(); ++at) {
      if (quote == '"' && rest_[at] == '\\') {
        ++at;
      } else if (!long_text && rest_[at] == '\n') {
        break;
      } else if (rest_[at] == quote && (!long_text || EndsLongText(at, quote))) {
        at += long_text ? 3 : 1;
        // Up to two quotes may stand before the three that end it.
        for (int more = 0; long_text && more < 2 && at < rest_.size() && rest_[at] == quote; ++more)
          ++at;
        break;
      }
    }
    SkipTo(at);
  }

  bool EndsLongText(std::size_t at, char quote) const {
    return at + 2 < rest_.size() && rest_[at + 1] == quote && rest_[at + 2] == quote;
  }

  std::string_view rest_;
  int line_ = 1, brackets_ = 0, parts_ = 1;
};

}  // namespace

std::optional<int> LineOfDeepNesting(std::string_view toml) { return Walker(toml).FindDeep(); }

}  // namespace tubetwin::config_internal
