#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/arm/arm.h"
#include "models/base/joint.h"
#include "models/bin.h"
#include "models/layout.h"

namespace tubetwin {

/// Distances of arm, tool, scanner housing, gripper and fingers against bin, tray, base, cell plate
/// and each other (FCL, primitive shapes). Pairs that the joints hold apart or together
/// (neighbours) are left out. The fingers stand where `opening_m` puts them. Immutable after
/// construction; const calls are thread safe.
class ClearanceChecker {
 public:
  /// `arm` must outlive this; layout and bin are copied.
  ClearanceChecker(const ArmModel& arm, const CellLayout& layout, const Bin& bin);
  ~ClearanceChecker();

  /// The nearest pair of a kind.
  struct Nearest {
    double clearance_m = 0.0;  ///< Smallest signed distance; negative or zero means contact.
    std::string moving;        ///< Names of the pair, for messages; empty when nothing is near.
    std::string obstacle;
  };
  struct Result : Nearest {  ///< Over all pairs.
    Nearest fingers;         ///< The fingers against the bin's floor and walls only.
    Nearest others;          ///< Every pair but those.
  };
  /// Smallest clearances at q, at most `enough_m` (search stops there). `opening_m`: gripper.
  Result Check(const JointVector& q, double opening_m, double enough_m = 0.05) const;

  /// Boxes and capsules of the moving bodies, for the twin's collision and looks: one list.
  struct Shape {
    enum class Kind { kBox, kCapsule, kCylinder, kSphere } kind = Kind::kBox;
    std::string name;
    int link = 0;  ///< 0 base, 1..6 links, 7 flange (tool, scanner).
    RigidTransform X_LinkShape = RigidTransform::Identity();
    Vector3 size_m =
        Vector3::Zero();  ///< box: half sizes; capsule, cylinder: radius, half length (z).
    bool scanner = false;
  };
  static std::vector<Shape> ArmShapes(const ArmModel& arm, const CellLayout& layout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
