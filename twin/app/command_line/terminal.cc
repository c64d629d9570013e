#include "twin/app/command_line/terminal.h"

#include <cstdarg>
#include <cstdio>
#include <vector>

#include "models/base/json.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr int kMostLines = 4;

}  // namespace

std::string ForTerminal(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '\n' || byte == '\t' || (byte >= 0x20 && byte < 0x7f)) {
      out += text[i];
      continue;
    }
    // The upper control characters are two bytes in UTF-8.
    const bool upper = byte == 0xc2 && i + 1 < text.size() &&
                       (static_cast<unsigned char>(text[i + 1]) & 0xe0) == 0x80;
    if (byte < 0x80 || upper) {
      const unsigned code = upper ? static_cast<unsigned char>(text[++i]) : byte;
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", code);
      out += escape;
      continue;
    }
    // The rest of a run of bytes that are no ASCII: letters of other scripts, or damage.
    std::size_t end = i;
    while (end < text.size() && static_cast<unsigned char>(text[end]) >= 0x80 &&
           !(end > i && static_cast<unsigned char>(text[end]) == 0xc2)) {
      ++end;
    }
    out += Printable(text.substr(i, end - i));
    i = end - 1;
  }
  return out;
}

void Print(const char* format, ...) {
  std::va_list once, again;
  va_start(once, format);
  va_copy(again, once);
  const int size = std::vsnprintf(nullptr, 0, format, once);
  va_end(once);
  std::vector<char> text(static_cast<std::size_t>(size > 0 ? size : 0) + 1);
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  const std::string shown = ForTerminal({text.data(), text.size() - 1});
  std::fwrite(shown.data(), 1, shown.size(), stdout);
}

std::string JsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void PrintJson(const Json& json) { Print("%s", JsonText(json).c_str()); }

void Complain(const std::string& text) {
  std::size_t end = 0;
  for (int line = 0; line < kMostLines && end != std::string::npos; ++line) {
    end = text.find('\n', line == 0 ? 0 : end + 1);
  }
  std::fprintf(stderr, "tubetwin: %s\n", ForTerminal(text.substr(0, end)).c_str());
}

}  // namespace tubetwin
