#pragma once

#include <map>
#include <string>
#include <vector>

#include "hw_bridge/cell/devices.h"
#include "models/arm/arm.h"
#include "models/base/time.h"
#include "models/bin.h"
#include "models/cell_model.h"

namespace tubetwin {

/// Moments of a pick cycle as they show on the devices, for fault scripts: "scan" (a trigger),
/// "reach" (the open fingers come within 0.1 m of the bin's rim), "close" (a command to close
/// there), "held" (the fingers have closed on something), "lift" (then within 0.1 m over the rim,
/// going up), "carry" (then outside the bin's outline), "open" (a command to open).
class CycleMoments {
 public:
  static const std::vector<std::string>& Names();

  /// `model` must outlive it.
  CycleMoments(const CellModel& model, const Bin& bin);

  /// What the devices show in one control period.
  struct Look {
    JointVector q = JointVector::Zero();
    GripperState fingers;
    bool fingers_in_use = false;  ///< Activated: what they do is the pipeline's.
    std::uint64_t scans = 0;      ///< Triggers so far.
  };
  /// The moments that came with this look, in order.
  std::vector<std::string> After(const Look& look);
  /// How often a moment has come.
  int count(const std::string& name) const;

 private:
  const CellModel& model_;
  Bin bin_;
  Look last_;
  bool low_ = false, over_bin_ = true, held_ = false;
  std::map<std::string, int> counts_;
};

}  // namespace tubetwin
