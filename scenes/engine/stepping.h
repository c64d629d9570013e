#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace tubetwin {

/// What became of some steps. diverged: a coordinate became huge or not a number, or the mass
/// matrix singular; overflow: the engine had no memory for a contact. Either way the data is no
/// longer physics; restore a snapshot or throw it away.
enum class StepStatus { kOk, kDiverged, kOverflow };
const char* ToString(StepStatus status);

/// Advances by `steps` time steps; stops at the first that is not kOk. Throws Error(kInternal) on a
/// fatal engine error.
[[nodiscard]] StepStatus Step(const mjModel& model, mjData& data, int steps = 1);

/// What Step would say about the data as it is (the engine's warning counters and bad numbers).
[[nodiscard]] StepStatus StatusOf(const mjData& data);

/// Everything that the next step depends on (mjSTATE_INTEGRATION). Restoring gives bit-identical
/// steps on the same machine; bodies are stored awake.
class Snapshot {
 public:
  Snapshot() = default;
  Snapshot(const mjModel& model, const mjData& data);
  bool empty() const { return state_.empty(); }
  /// Puts the state back, clears warnings and recomputes what derives from it (mj_forward).
  /// Precondition: same model (or a copy of it) as at construction.
  void Restore(const mjModel& model, mjData& data) const;

 private:
  std::vector<mjtNum> state_;
};

}  // namespace tubetwin
