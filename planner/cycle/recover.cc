#include <cmath>
#include <optional>
#include <vector>

#include "planner/cycle/round_steps.h"
#include "planner/pick/tool_path.h"

namespace tubetwin {
namespace {

constexpr double kRetreatSpeed_m_s = 0.1, kRetreatAcceleration_m_s2 = 0.5;
constexpr double kOverRim_m = 0.10;    ///< Down to here what hangs cannot touch the pile.
constexpr double kOverFloor_m = 0.05;  ///< The lowest that the fingers go to let something go.
/// And in steps from there on, where the tool does not fit between the walls: what hangs falls so
/// far then, onto its like.
constexpr double kHigher_m = 0.07;
constexpr double kLowerSpeed_m_s = 0.05;
constexpr double kRest_s = 0.5;

/// Faults that a person at the cell can look into. After a lost link nobody knows where the arm is.
bool MayBeAcknowledged(WaitOutcome::Status status) {
  return status == WaitOutcome::Status::kProtectiveStop ||
         status == WaitOutcome::Status::kEmergencyStop || status == WaitOutcome::Status::kFault;
}

RigidTransform AtHeight(RigidTransform X_BE, double z_m) {
  X_BE.translation().z() = z_m;
  return X_BE;
}

bool IsOverBin(const Bin& bin, const RigidTransform& X_BE) {
  const Vector3 p_NE = bin.X_BN.inverse() * X_BE.translation();
  return std::abs(p_NE.x()) < bin.half_x_m() && std::abs(p_NE.y()) < bin.half_y_m();
}

/// A way to let something go in the bin: where the arm is, or over the bin's middle, turned there
/// about the vertical.
struct Lowering {
  bool over_middle = false;
  double turn_rad = 0.0;
  double over_floor_m = kOverFloor_m;
};

/// The ways that may do, the nearest to what the arm does anyway first. Between high walls a
/// housing beside the fingers fits only one way round.
std::vector<Lowering> Lowerings(const Bin& bin, bool over_bin) {
  std::vector<Lowering> out;
  for (double height_m = kOverFloor_m; height_m < bin.wall_m() + kHigher_m; height_m += kHigher_m) {
    if (over_bin) out.push_back({false, 0.0, height_m});
    for (const double turn : {0.0, 90.0, -90.0, 45.0, -45.0}) {
      out.push_back({true, Radians(turn), height_m});
    }
  }
  return out;
}

PickPath LoweringPath(const CycleContext& c, const Lowering& way) {
  const Bin& bin = c.cell.bin;
  const double floor_B = bin.X_BN.translation().z();
  RigidTransform X_BE = c.executor.X_BE();
  PathBuilder path = c.Path();
  if (!PointsDown(X_BE)) {
    X_BE = Upright(X_BE);
    path.Line("upright", To(X_BE));
  }
  if (way.over_middle) {
    X_BE.linear() = RotZ(way.turn_rad) * X_BE.linear();
    X_BE.translation().head<2>() = bin.X_BN.translation().head<2>();
    X_BE = AtHeight(X_BE, floor_B + c.cell.model.layout.carry_height_m);
    path.Transfer("to over the bin's middle", X_BE);
  }
  const double rim_B = floor_B + bin.wall_m() + kOverRim_m, low_B = floor_B + way.over_floor_m;
  if (rim_B < X_BE.translation().z()) {
    path.Line("lowering", To(AtHeight(X_BE, rim_B)), c.setup.planner.lift_speed_m_s);
  }
  if (low_B < X_BE.translation().z()) {
    // Hanging tubes touch first: what is felt as the load going down ends the descent.
    path.GuardedLine("into the bin", To(AtHeight(X_BE, low_B)), kLowerSpeed_m_s,
                     c.setup.cycle.guard_force_N);
  }
  return path.path();
}

StepOutcome RetreatAndPutBack(CycleContext& c) {
  c.executor.Resync();
  const double carry_B = c.cell.bin.X_BN.translation().z() + c.cell.model.layout.carry_height_m;
  const RigidTransform X_BE = c.executor.X_BE();
  MotionOptions slow = NearGrasp(kRetreatSpeed_m_s, kRetreatAcceleration_m_s2);
  if (X_BE.translation().z() < carry_B) {
    PathBuilder up = c.Path();
    up.Add("up after a stop", slow, Follow{{To(AtHeight(X_BE, carry_B))}});
    if (StepOutcome step = c.CheckAndRun(up.path()); !step.ok()) return step;
  }
  const GripperState& fingers = c.executor.fingers();
  const bool closed = fingers.object == GripperObject::kContactClosing;
  if (!closed || fingers.opening_m < kNothingOpening_m) return {};
  RigidTransform over = Upright(c.executor.X_BE());
  over.translation().head<2>() = c.cell.bin.X_BN.translation().head<2>();
  PathBuilder back = c.Path();
  back.Add("over the bin after a stop", slow, Transfer{over});
  if (StepOutcome step = c.CheckAndRun(back.path()); !step.ok()) return step;
  return PutBack(c);
}

/// Opens, rests and goes up.
StepOutcome LetGo(CycleContext& c, double opening_m, double rest_s) {
  PathBuilder open = c.Path();
  open.Open("letting go", opening_m);
  if (rest_s > 0.0) open.Pause("rest", rest_s);
  c.cell.carried_opening_m.reset();
  if (StepOutcome step = c.CheckAndRun(open.path()); !step.ok()) return step;
  c.Released();
  PathBuilder up = c.Path();
  up.Line("up", By(Vector3(0, 0, kRetreat_m)));
  const StepOutcome step = c.CheckAndRun(up.path());
  return step.refused() ? StepOutcome() : step;
}

}  // namespace

StepOutcome OpenAndRetreat(CycleContext& c, double opening_m) {
  const CycleContext::During recovering(c, &AttemptReport::Phases::recover);
  return LetGo(c, opening_m, 0.0);
}

StepOutcome PutBack(CycleContext& c) {
  const CycleContext::During recovering(c, &AttemptReport::Phases::recover);
  c.observer.OnStep("putting back");
  std::optional<StepOutcome> refused;
  for (const Lowering& way : Lowerings(c.cell.bin, IsOverBin(c.cell.bin, c.executor.X_BE()))) {
    StepOutcome lowered = c.CheckAndRun(LoweringPath(c, way));
    if (lowered.ok()) return LetGo(c, c.ReleaseOpening(), kRest_s);
    if (!lowered.refused()) return lowered;
    if (!refused) refused = lowered;
  }
  return *refused;
}

Acknowledgement PutBackLeftOver(CycleContext& c, const std::string& left) {
  if (!c.setup.acknowledge) return Acknowledgement::kEnd;
  const std::string what = left + ". It will be put back into the bin, slowly.";
  if (c.setup.acknowledge(what) != Acknowledgement::kGoOn) return Acknowledgement::kEnd;
  return RetreatAndPutBack(c).ok() ? Acknowledgement::kGoOn : Acknowledgement::kEnd;
}

Acknowledgement GoOnAfterStop(CycleContext& c, const StepOutcome& trouble) {
  c.cell.carried_opening_m.reset();
  if (!c.setup.acknowledge || !MayBeAcknowledged(trouble.device)) return Acknowledgement::kEnd;
  if (c.setup.acknowledge(trouble.reason) != Acknowledgement::kGoOn) return Acknowledgement::kEnd;
  c.observer.OnStep("going on after a stop");
  if (RecoverArm(c.cell).status != WaitOutcome::Status::kDone) return Acknowledgement::kEnd;
  return RetreatAndPutBack(c).ok() ? Acknowledgement::kGoOn : Acknowledgement::kEnd;
}

}  // namespace tubetwin
