#include <algorithm>

#include "models/base/error.h"
#include "models/base/text.h"
#include "planner/resolution/strategies.h"

namespace tubetwin {

const std::vector<ResolutionStrategy>& ResolutionStrategies() {
  static const std::vector<ResolutionStrategy> strategies = {
      {"none", "puts them back at once", nullptr},
      {"plus45", "tilts about the load torque", MakePlus45},
      {"plus45_minus45", "tilts about it in both senses", MakePlus45Minus45},
      {"perpendicular", "tilts about the axis across it in both senses", MakePerpendicular},
      {"putback", "lowers, rests and lifts again", MakePutback},
  };
  return strategies;
}

namespace {

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const ResolutionStrategy& strategy : ResolutionStrategies()) names.push_back(strategy.name);
  return names;
}

}  // namespace

const ResolutionStrategy& ResolutionStrategyOf(const std::string& name) {
  const auto& all = ResolutionStrategies();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const ResolutionStrategy& s) { return s.name == name; });
  if (found == all.end()) {
    throw Error(ErrorKind::kConfig, "resolution.strategy: there is no strategy '" + name +
                                        "'; there are " + Join(Names()));
  }
  return *found;
}

void ResolutionConfig::Visit(ConfigVisitor& v) {
  std::vector<std::string> helps;
  for (const ResolutionStrategy& s : ResolutionStrategies()) helps.push_back(s.name + " " + s.help);
  const std::string doc = "what is done when several tubes hang in the fingers: " + Join(helps);
  v.Choice("strategy", doc.c_str(), strategy, Names());
  v.Field("angle_deg", "tilt", angle_deg, {5, 60});
  v.Field("speed_deg_s", "speed of the tilt", speed_deg_s, {1, 90});
}

}  // namespace tubetwin
