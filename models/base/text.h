#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tubetwin {

/// The entry of `known` with the smallest edit distance to `name`; empty when `known` is empty.
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c".
std::string Join(const std::vector<std::string>& parts, std::string_view separator = ", ");

/// Shortest decimal text that reads back as the same double ("0.25", "1e-05").
std::string Number(double value);

/// A number as programs print it, in whatever language and compiler: "+0.4", "nan", "-nan(ind)",
/// "Infinity", and Microsoft's older "1.#QNAN", "-1.#IND00", "1.#INF". What lies beyond double's
/// range is infinite or 0. Nothing where the whole word is no such number.
std::optional<double> ParseNumber(std::string_view word);

/// Whether the bytes are well-formed UTF-8 without control characters: what TOML, JSON and a
/// terminal take as it is.
bool IsPlainUtf8(std::string_view text);

/// The text with every byte that breaks IsPlainUtf8 as \xNN: names of files may be any bytes.
std::string Printable(std::string_view text);

/// ASCII letters made small, all else as it is.
std::string LowerCase(std::string_view text);

}  // namespace tubetwin
