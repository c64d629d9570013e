#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace tubetwin {

/// One thing that was judged before anything runs: a part against gripper, sensor and scanner, a
/// cell against its bin. Texts are for people, with units, without a trailing full stop.
struct Finding {
  enum class Verdict { kOk, kDoubtful, kImpossible };  ///< From good to bad.
  Verdict verdict = Verdict::kOk;
  std::string what;     ///< What was judged: "weight for the sensor".
  std::string found;    ///< The value: "0.54 N = 21 counts".
  std::string allowed;  ///< What it is measured by: "at least 10 counts".
  std::string remedy;   ///< What to do; empty where all is well.
};

/// "ok", "doubtful", "impossible".
inline const char* ToString(Finding::Verdict verdict) {
  switch (verdict) {
    case Finding::Verdict::kOk:
      return "ok";
    case Finding::Verdict::kDoubtful:
      return "doubtful";
    case Finding::Verdict::kImpossible:
      return "impossible";
  }
  return "impossible";
}

/// The worst verdict of all; kOk for none.
inline Finding::Verdict WorstOf(const std::vector<Finding>& findings) {
  Finding::Verdict worst = Finding::Verdict::kOk;
  for (const Finding& finding : findings) worst = std::max(worst, finding.verdict);
  return worst;
}

}  // namespace tubetwin
