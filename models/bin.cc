#include "models/bin.h"

#include <charconv>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr std::array<Range, 3> kAllowed_m = {Range{0.1, 3.0}, Range{0.1, 3.0}, Range{0.01, 1.0}};

}  // namespace

Json ToJson(const Bin& bin) {
  Json json;
  json["size_m"] = bin.size_m;
  json["X_BN"] = ToJson(bin.X_BN);
  return json;
}

Bin BinFromJson(const JsonView& view) {
  Bin bin;
  const JsonView size = view.Field("size_m");
  if (size.Size() != 3) {
    size.Fail("has " + std::to_string(size.Size()) +
              " numbers; allowed: 3 (long side, short side, wall height)");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    bin.size_m[i] = size.Item(i).AsNumber(kAllowed_m[i].low, kAllowed_m[i].high);
  }
  if (const auto X_BN = view.Optional("X_BN")) bin.X_BN = TransformFromJson(*X_BN);
  return bin;
}

std::array<double, 3> ParseBinSize(const std::string& text) {
  std::array<double, 3> size_m{};
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  for (std::size_t i = 0; i < 3 && good; ++i) {
    if (i > 0) good = at != end && *at++ == ',';
    if (!good) break;
    const auto [next, error] = std::from_chars(at, end, size_m[i]);
    // Written so that NaN fails.
    good =
        error == std::errc() && size_m[i] >= kAllowed_m[i].low && size_m[i] <= kAllowed_m[i].high;
    at = next;
  }
  if (!good || at != end) {
    throw Error(ErrorKind::kUsage, "bin size '" + text +
                                       "' is not X,Y,Z in metres; allowed: three numbers, 0.1 to "
                                       "3, 0.1 to 3 and 0.01 to 1, for example 0.80,0.60,0.09");
  }
  return size_m;
}

}  // namespace tubetwin
