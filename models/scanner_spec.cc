#include "models/scanner_spec.h"

namespace tubetwin {
namespace {

/// Camera (side -1) or projector (side +1) in the housing, each turned towards the other.
RigidTransform AperturePose(const ScannerSpec& spec, double side) {
  return MakeTransform(RotY(-side * Radians(spec.toe_in_deg)),
                       Vector3(0.5 * side * spec.baseline_m, 0, 0));
}

}  // namespace

RigidTransform HousingPose(const ScannerSpec& spec) { return AperturePose(spec, -1).inverse(); }

RigidTransform ProjectorPose(const ScannerSpec& spec) {
  return HousingPose(spec) * AperturePose(spec, +1);
}

}  // namespace tubetwin
