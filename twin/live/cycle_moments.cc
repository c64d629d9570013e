#include "twin/live/cycle_moments.h"

#include <cmath>

namespace tubetwin {
namespace {

constexpr double kOverRim_m = 0.10;
/// Register steps are 0.4 mm: what is less is no command to close or open.
constexpr double kCommandStep_m = 0.001;

}  // namespace

const std::vector<std::string>& CycleMoments::Names() {
  static const std::vector<std::string> names = {"scan", "reach", "close", "held",
                                                 "lift", "carry", "open"};
  return names;
}

CycleMoments::CycleMoments(const CellModel& model, const Bin& bin) : model_(model), bin_(bin) {}

std::vector<std::string> CycleMoments::After(const Look& look) {
  std::vector<std::string> out;
  const auto came = [&](const char* name) {
    out.emplace_back(name);
    ++counts_[name];
  };
  const Vector3 p_NE =
      bin_.X_BN.inverse() * (FlangePose(model_.arm, look.q) * model_.layout.X_FE).translation();
  const bool low = p_NE.z() < bin_.wall_m() + kOverRim_m;
  const bool over_bin =
      std::abs(p_NE.x()) < bin_.half_x_m() && std::abs(p_NE.y()) < bin_.half_y_m();
  const bool held = look.fingers_in_use && look.fingers.object == GripperObject::kContactClosing;
  for (std::uint64_t n = last_.scans; n < look.scans; ++n) came("scan");
  if (low && !low_ && over_bin && !held) came("reach");
  if (look.fingers_in_use && last_.fingers_in_use) {
    const double change_m = look.fingers.requested_m - last_.fingers.requested_m;
    if (change_m < -kCommandStep_m && low) came("close");
    if (held && !held_) came("held");
    if (change_m > kCommandStep_m) came("open");
  }
  if (held && held_ && !low && low_) came("lift");
  if (held && held_ && !over_bin && over_bin_) came("carry");
  low_ = low;
  over_bin_ = over_bin;
  held_ = held;
  last_ = look;
  return out;
}

int CycleMoments::count(const std::string& name) const {
  const auto found = counts_.find(name);
  return found == counts_.end() ? 0 : found->second;
}

}  // namespace tubetwin
