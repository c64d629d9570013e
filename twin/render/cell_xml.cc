#include "twin/render/cell_xml.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "models/base/error.h"
#include "models/base/text.h"
#include "scenes/engine/engine_error.h"

namespace tubetwin {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{8} << 20;
constexpr int kMaxElements = 50000, kDeepestElement = 64;

/// What cells are built of. Not among them: include, asset, extension, model and all else by which
/// a file is opened or a small text becomes a large scene.
const std::set<std::string_view>& Elements() {
  static const std::set<std::string_view> known = {
      "mujoco",   "compiler",  "option",    "flag",     "size",    "visual",    "global",
      "map",      "headlight", "rgba",      "quality",  "scale",   "statistic", "body",
      "geom",     "joint",     "freejoint", "inertial", "site",    "light",     "camera",
      "force",    "torque",    "worldbody", "actuator", "general", "motor",     "position",
      "velocity", "fixed",     "weld",      "equality", "tendon",  "spatial",   "connect",
      "sensor",   "keyframe",  "key",       "pair",     "contact", "default",   "exclude",
      "jointpos", "jointvel",  "framepos",  "framequat"};
  return known;
}

/// Attributes by which one number takes memory or time, and the largest that is allowed.
struct Limit {
  std::string_view element, attribute;
  double most;
};
constexpr Limit kLimits[] = {{"size", "memory", 512 << 20},    {"size", "nkey", 100},
                             {"global", "offwidth", 8192},     {"global", "offheight", 8192},
                             {"quality", "shadowsize", 8192},  {"quality", "offsamples", 16},
                             {"quality", "numslices", 128},    {"quality", "numstacks", 128},
                             {"quality", "numquads", 16},      {"option", "iterations", 1000},
                             {"option", "ls_iterations", 1000}};

/// "16M" is 16 times 2^20; negative where it is no such number.
double Size(std::string_view text) {
  double value = -1.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return -1.0;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (unit.empty()) return value;
  const std::size_t power = std::string_view("KMGT").find(unit.front());
  if (unit.size() != 1 || power == std::string_view::npos) return -1.0;
  return value * static_cast<double>(std::uint64_t{1} << (10 * (power + 1)));
}

/// Looks at every element of an XML text.
class Checker {
 public:
  Checker(std::string_view xml, const std::string& source) : rest_(xml), source_(source) {}

  void Run() {
    if (rest_.size() > kMaxBytes) Fail("is longer than " + std::to_string(kMaxBytes) + " bytes");
    for (;;) {
      Skip(std::min(rest_.find('<'), rest_.size()));
      if (rest_.empty()) return;
      Skip(1);
      if (rest_.starts_with('/')) {
        --depth_;
        Skip(std::min(rest_.find('>'), rest_.size()));
      } else {
        Element();
      }
    }
  }

 private:
  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorKind::kBadData,
                source_ + ": cell_xml: line " + std::to_string(line_) + ": " + Printable(problem));
  }

  void Skip(std::size_t count) {
    for (const char c : rest_.substr(0, count)) line_ += c == '\n' ? 1 : 0;
    rest_.remove_prefix(count);
  }

  std::string_view Take(std::size_t count) {
    const std::string_view taken = rest_.substr(0, count);
    Skip(taken.size());
    return taken;
  }

  void Element() {
    const std::string_view name = Take(rest_.find_first_of(" \t\r\n/>"));
    if (!Elements().contains(name)) {
      Fail("element '" + std::string(name.substr(0, 40)) +
           "'; allowed: those that the program's own cells have, which name no files");
    }
    if (++count_ > kMaxElements)
      Fail("has more than " + std::to_string(kMaxElements) + " elements");
    if (++depth_ > kDeepestElement) {
      Fail("elements nest more than " + std::to_string(kDeepestElement) + " deep");
    }
    while (Attribute(name)) {
    }
  }

  /// One attribute, or the end of the element.
  bool Attribute(std::string_view element) {
    Skip(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    if (rest_.empty()) Fail("ends inside of an element");
    if (rest_.starts_with('/')) --depth_;
    if (rest_.starts_with('/') || rest_.starts_with('>')) {
      Skip(std::min(rest_.find('>'), rest_.size()));
      return false;
    }
    const std::string_view name = Take(rest_.find_first_of("= \t\r\n/>"));
    Skip(std::min(rest_.find_first_not_of("= \t\r\n"), rest_.size()));
    const char quote = rest_.empty() ? '\0' : rest_.front();
    if (quote != '"' && quote != '\'') Fail("attribute '" + std::string(name) + "' has no text");
    Skip(1);
    const std::string_view value = Take(rest_.find(quote));
    Skip(std::min<std::size_t>(1, rest_.size()));
    Judge(element, name, value);
    return true;
  }

  void Judge(std::string_view element, std::string_view name, std::string_view value) const {
    const std::string place =
        "attribute '" + std::string(name.substr(0, 40)) + "' of '" + std::string(element) + "'";
    if (name == "file" || name == "plugin" || (name.ends_with("dir") && name != "dir")) {
      Fail(place + " names files; a recording holds all that it needs");
    }
    for (const Limit& limit : kLimits) {
      if (limit.element != element || limit.attribute != name) continue;
      if (const double found = Size(value); !(found >= -1.0 && found <= limit.most)) {
        Fail(place + " is " + std::string(value.substr(0, 40)) + "; allowed: up to " +
             Number(limit.most));
      }
      return;
    }
    if (element == "size") Fail(place + "; allowed: memory and nkey");
  }

  std::string_view rest_;
  const std::string& source_;
  int line_ = 1, depth_ = 0, count_ = 0;
};

}  // namespace

MjSpec ParseCellXml(const std::string& xml, const std::string& source) {
  Checker(xml, source).Run();
  InitEngine();
  char error[512] = "";
  mjSpec* parsed = nullptr;
  GuardEngine([&] { parsed = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error); });
  if (parsed == nullptr) {
    throw Error(ErrorKind::kBadData, source + ": cell_xml: does not parse: " + Printable(error));
  }
  return MjSpec(parsed);
}

}  // namespace tubetwin
