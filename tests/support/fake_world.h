#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/part.h"
#include "tests/support/fake_cell.h"
#include "tests/support/toy_scanner.h"

namespace tubetwin::test {

/// What the arm was doing, told from where a motion began and ended and from whether a tube hung in
/// the fingers.
enum class MotionKind {
  kDown,      ///< Empty fingers go down over the bin.
  kUp,        ///< Empty fingers go up.
  kAcross,    ///< Any other motion with empty fingers: to a view, to above a grasp.
  kLift,      ///< A tube is taken up.
  kLower,     ///< A tube is let down over the bin.
  kShift,     ///< A tube is moved over the bin, neither up nor down.
  kTilt,      ///< The tool leaves the vertical about the fingers, which stand still.
  kTiltBack,  ///< The same, back to the vertical.
  kCarry,     ///< A tube leaves the bin.
  kLay,       ///< A tube is let down over the tray.
};
const char* ToString(MotionKind kind);

/// A motion that the arm was told to make. Poses of E in B.
struct FakeMotion {
  MotionKind kind = MotionKind::kAcross;
  TimeNs began{0};
  double duration_s = 0.0;
  JointTrajectory trajectory;
  RigidTransform X_BE_from = RigidTransform::Identity(), X_BE_to = RigidTransform::Identity();
  int held = 0;  ///< Tubes in the fingers when it began.

  /// How the tool turned from the first to the last point: axis times angle in E, radians.
  Vector3 rotation_E() const;
};

/// A tube of the fake world, and where it is.
struct FakeTube {
  enum class Place { kBin, kFingers, kTray, kLost } place = Place::kBin;
  Polyline line_N;  ///< As it lies, or lay, in the bin.
  Polyline line_E;  ///< As it hangs in the fingers.
  Polyline line_T;  ///< As it was laid on the tray.
};

/// A bin of tubes around a FakeCell: enough of a world for the pick cycle to empty, without
/// physics, and fast. The scanner shows the tubes that lie in the bin, the fingers close on what is
/// between them, the wrist weighs the tool and what hangs in it, and what the open fingers let go
/// lies on the tray or back in the bin. Everything else that may happen to a tube or a device is
/// the script of the test:
///
///     FakeWorld world({StraightLine(...), StraightLine(...)});
///     world.Grab(2);                                            // The first grasp takes two.
///     world.After(MotionKind::kTilt, 1, [&] { world.Fall(1); });  // One falls in the first tilt.
///     RunPickCycle(world.cell, setup, observer);
///     CHECK(world.Count(FakeTube::Place::kTray) == 2);
///
/// What the devices were told is in `motions`, `log` and, where no robot may ever do so, in
/// `faults`.
class FakeWorld : public FakeCell {
 public:
  explicit FakeWorld(const std::vector<Polyline>& tubes_N, const Bin& bin = SmallBin(),
                     const Part& part = ShortTube());

  /// A bin that one view from above sees whole, and tubes that fit into it.
  static Bin SmallBin();
  static Part ShortTube();

  // The script: what happens, to be said before the cycle runs.

  /// The next grasp takes so many tubes: the nearest to the fingers first. Called again, that is
  /// said of the grasp after it. Grasps of which nothing was said take what lies between the
  /// fingers.
  void Grab(int count) { grabs_.push_back(count); }
  /// When half the time of the `nth` motion (from 1) of a kind is over.
  void During(MotionKind kind, int nth, std::function<void()> happens);
  /// When it has come to its end.
  void After(MotionKind kind, int nth, std::function<void()> happens);
  /// A rigid thing that the empty fingers meet when E comes down to this height over the floor.
  std::optional<double> obstacle_height_m;
  /// After each motion what hangs in the fingers swings up and down, so strongly at first.
  double swing_N = 0.0;
  /// How far a tube on which closed fingers press goes with them: half as far, as it rolls.
  double rolls = 0.5;
  /// Things in the bin that are no tubes.
  std::vector<ToyScene::Box> boxes_N;

  // What may happen.

  /// So many of the tubes in the fingers fall, the last taken first: over the bin they lie again
  /// where they lay before.
  void Fall(int count);
  void StopArm(ArmMode mode, const std::string& why);

  // What was done.

  std::vector<FakeMotion> motions;
  std::vector<std::string> log;     ///< Every command in order, all numbers told.
  std::vector<std::string> faults;  ///< What no cell may do, such as opening fingers in mid-air.
  std::vector<FakeTube> tubes;
  int scans = 0;

  int Count(FakeTube::Place place) const;
  int held() const { return Count(FakeTube::Place::kFingers); }
  int CountMotions(MotionKind kind) const;
  std::vector<FakeMotion> MotionsOf(MotionKind kind) const;
  RigidTransform X_BE() const { return PoseOfE(arm.State().q); }
  RigidTransform X_NE() const { return cell.bin.X_BN.inverse() * X_BE(); }
  /// Torque that the tubes in the fingers add to the wrist, frame K.
  Vector3 HeldTorque_K() const;
  const Part part;

 private:
  struct Event {
    MotionKind kind;
    int nth;
    bool at_end;
    std::function<void()> happens;
  };
  enum class Region { kBin, kTray, kElsewhere };

  RigidTransform PoseOfE(const JointVector& q) const;
  Region RegionOf(const RigidTransform& X_BE) const;
  MotionKind KindOf(const RigidTransform& X_BE_from, const RigidTransform& X_BE_to) const;
  void Pass();
  void Begin(const CheckedTrajectory& trajectory);
  void Happen(bool at_end);
  /// A tube that the fingers pressed on goes along with them.
  void Roll(const Vector3& from_B, const Vector3& to_B);
  void MoveFingers(const GripperCommand& command);
  void Close();
  void Open();
  void ShowFingers();
  Wrench Weigh();
  OrganizedCloud Look();
  /// The tube in the bin that the closed fingers press on, if any.
  FakeTube* Pressed();

  std::deque<int> grabs_;
  std::vector<Event> events_;
  std::vector<std::size_t> held_;  ///< Indices of tubes, in the order in which they were taken.
  double closed_at_m_ = 0.0;       ///< Height of E over the floor when the fingers closed.
  std::optional<FakeMotion> running_;
  TimeNs at_rest_since_{0};
  bool half_over_ = false;
  bool pressing_ = false;  ///< The closed fingers pressed on a tube when the motion began.
};

}  // namespace tubetwin::test
