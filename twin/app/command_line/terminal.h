#pragma once

#include <string>
#include <string_view>

#include "models/base/json_fwd.h"

namespace tubetwin {

/// What a person or another program may be shown of a text into which files and devices wrote:
/// control characters but for line breaks and tabs as \u001b, so that JSON and TOML stay what they
/// are, and bytes that are no UTF-8 as \xNN. All that the program prints goes through here.
std::string ForTerminal(std::string_view text);

/// Prints on standard output, as printf does, through ForTerminal.
[[gnu::format(printf, 1, 2)]] void Print(const char* format, ...);

/// A document as text, indented, with a line break. Names of files in it may be any bytes.
std::string JsonText(const Json& json);
/// The same on standard output, through ForTerminal.
void PrintJson(const Json& json);

/// "tubetwin: TEXT" on standard error, through ForTerminal, in at most four lines.
void Complain(const std::string& text);

}  // namespace tubetwin
