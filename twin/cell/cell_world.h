#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "models/base/time.h"
#include "models/cell_model.h"
#include "models/physics.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/pile.h"
#include "scenes/tube_body.h"
#include "twin/cell/pad_contacts.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin {

/// The cell as one MuJoCo world, W = B: plate, bin on its plinth, tray, arm with sensor, scanner
/// and gripper, and the pile's tubes where the pile says. Between steps everything that derives
/// from positions and speeds (poses, contacts, bias forces) is that of the present state. The arm
/// stands at HomePosition() and the gripper is open at the start; from then on nothing is set but
/// motor torques and the gripper's servo.
class CellWorld {
 public:
  CellWorld(const Pile& pile, const CellModel& model, const RoundPhysics& physics);

  TimeNs now() const { return kControlPeriod * steps_; }
  mjModel& model() const { return *model_; }
  mjData& data() const { return *data_; }
  const GripperSpec& gripper() const { return gripper_; }

  /// Recomputes forces for the controls that are set, without stepping; once, at the start.
  void Refresh();
  /// Finishes the step whose controls were set, and begins the next (mj_step2, mj_step1). Throws
  /// Error(kInternal) naming the time when the world diverges or the engine runs out of memory.
  void Step();

  /// Wakes sleeping tubes: from here on a restored world goes the same way as this one.
  void WakeAll();
  /// The engine's state and time, and back, all tubes awake. After WakeAll the steps from a
  /// restored state are bit by bit those of the world it was taken from. Restore throws
  /// Error(kBadData) when the state is that of another world.
  Json State() const;
  void Restore(const JsonView& state);

  /// All that a ray can hit now, tubes labelled by their index in the pile.
  ScanGeometry Geometry() const;
  /// The compiled model as XML text; it reloads and compiles.
  std::string Xml() const;

  /// The pile's tubes, in its order.
  const std::vector<TubeBody>& tubes() const { return tubes_; }
  /// Index in tubes() of the tube that a geom belongs to, -1 for none.
  int TubeOfGeom(int geom) const { return tube_of_geom_[geom]; }

 private:
  /// Throws Error(kBadData) naming the number of a state that no cell reaches.
  void RequireSane(const JsonView& integration) const;
  void SetAwake(const std::vector<double>& integration);

  void CompileWithStart(const JointVector& q_home);
  void MapGeoms(const Pile& pile);

  std::int64_t steps_ = 0;
  MjSpec spec_;
  MjModel model_;
  MjData data_;
  GripperSpec gripper_;
  std::optional<PadContacts> pad_contacts_;
  std::vector<TubeBody> tubes_;
  std::vector<int> tube_of_geom_;
  float tube_albedo_ = 0, tube_gloss_ = 0;
};

/// Arm position at the start: E over the middle of the bin at carry height, tool vertical. Throws
/// Error(kConfig) when the layout puts that out of reach.
JointVector HomePosition(const CellModel& model, const Bin& bin);

}  // namespace tubetwin
