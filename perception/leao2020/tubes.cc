#include "perception/leao2020/tubes.h"

#include <algorithm>

namespace tubetwin {
namespace {

/// Distance of a centerline's nodes.
constexpr double kNode_m = 0.005;

void Append(PerceivedTube& tube, const Vector3& p_N, bool visible) {
  tube.centerline_N.push_back(p_N);
  tube.node_visible.push_back(visible ? 1 : 0);
}

/// Cylinders' axes and joints one after another. Ends that overlap meet halfway.
PerceivedTube MakeTube(const LeaoTube& chain, const std::vector<LeaoCylinder>& cylinders) {
  PerceivedTube tube;
  double hidden_m = 0.0;
  std::vector<Polyline> axes;
  for (const int entry : chain.ends) {
    const LeaoCylinder& c = cylinders[static_cast<std::size_t>(entry / 2)];
    const auto end = static_cast<std::size_t>(entry % 2);
    axes.push_back({c.end_N[end], c.end_N[1 - end]});
  }
  for (std::size_t i = 1; i < axes.size(); ++i) {
    Vector3& out = axes[i - 1][1];
    Vector3& in = axes[i][0];
    if ((in - out).dot(out - axes[i - 1][0]) < 0) out = in = 0.5 * (out + in);
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (i > 0) {
      const bool occluded = cylinders[static_cast<std::size_t>(chain.ends[i - 1] / 2)].segment !=
                            cylinders[static_cast<std::size_t>(chain.ends[i] / 2)].segment;
      const double joint_m = (axes[i][0] - axes[i - 1][1]).norm();
      if (occluded) hidden_m += joint_m;
      if (joint_m < 1e-6) {
        tube.centerline_N.pop_back();
        tube.node_visible.pop_back();
      } else {
        const Polyline bridge = Resample({axes[i - 1][1], axes[i][0]}, kNode_m);
        for (std::size_t k = 1; k + 1 < bridge.size(); ++k) Append(tube, bridge[k], !occluded);
      }
    }
    for (const Vector3& p : Resample(axes[i], kNode_m)) Append(tube, p, true);
  }
  tube.length_m = Length(tube.centerline_N);
  tube.visible_fraction = std::clamp(1.0 - hidden_m / tube.length_m, 0.0, 1.0);
  return tube;
}

}  // namespace

std::vector<PerceivedTube> MakeLeaoTubes(const std::vector<LeaoTube>& chains,
                                         const std::vector<LeaoCylinder>& cylinders,
                                         const Part& part, const Leao2020Config& config) {
  const double min_m =
      part.length_m * (part.is_hose() ? config.least_share_hose : config.least_share_rigid);
  std::vector<PerceivedTube> out;
  for (const LeaoTube& chain : chains) {
    if (chain.length_m < min_m) continue;
    PerceivedTube tube = MakeTube(chain, cylinders);
    const int occluded = CountOccludedJoints(chain, cylinders);
    tube.id = static_cast<int>(out.size());
    tube.radius_m = part.radius_m;
    tube.confidence = std::clamp(chain.length_m / part.length_m, 0.0, 1.0);
    tube.class_paper = occluded == 0   ? TubeClass::kFree
                       : occluded == 1 ? TubeClass::kWeak
                                       : TubeClass::kStrong;
    out.push_back(std::move(tube));
  }
  return out;
}

}  // namespace tubetwin
