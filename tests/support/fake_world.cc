#include "tests/support/fake_world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "models/gripper_spec.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

constexpr double kSamePlace_m = 0.002;  ///< E stands still, or moves along a line.
constexpr double kLeaning_rad = 0.08;   ///< A tool that leans more has been tilted.
constexpr double kBetween_m = 0.020;    ///< From E to the axis of a tube that the fingers close on.
constexpr double kLow_m = 0.20;        ///< Over the bin's floor: a tube that is let go is not hurt.
constexpr double kLaid_m = 0.08;       ///< Over the tray.
constexpr double kLifted_m = 0.003;    ///< From here on the wrist carries the tube, not the floor.
constexpr double kNothing_m = 0.004;   ///< Opening of closed fingers with nothing between them.
constexpr double kReleased_m = 0.005;  ///< Wider than the tube by so much, the fingers let go.
constexpr double kMet_N = 20.0;        ///< Of a rigid thing.
constexpr double kPressed_N = 6.0;     ///< Of a tube under the closed fingers.
constexpr double kRolls = 0.5;         ///< A tube under moving fingers goes half as far.
constexpr double kSwingPeriod_s = 0.8, kSwingFades_s = 0.3;
const Vector3 kToolCentre_K(0, 0, 0.06);

std::string Text(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double Leaning(const RigidTransform& X_BE) {
  return std::acos(std::clamp(-X_BE.linear()(2, 2), -1.0, 1.0));
}

}  // namespace

const char* ToString(MotionKind kind) {
  switch (kind) {
    case MotionKind::kDown:
      return "down";
    case MotionKind::kUp:
      return "up";
    case MotionKind::kAcross:
      return "across";
    case MotionKind::kLift:
      return "lift";
    case MotionKind::kLower:
      return "lower";
    case MotionKind::kShift:
      return "shift";
    case MotionKind::kTilt:
      return "tilt";
    case MotionKind::kTiltBack:
      return "tilt back";
    case MotionKind::kCarry:
      return "carry";
    case MotionKind::kLay:
      return "lay";
  }
  return "unknown";
}

Vector3 FakeMotion::rotation_E() const {
  const Eigen::AngleAxisd turn(Matrix3(X_BE_from.linear().transpose() * X_BE_to.linear()));
  return turn.angle() * turn.axis();
}

Bin FakeWorld::SmallBin() {
  Bin bin;
  bin.size_m = {0.50, 0.36, 0.09};
  return bin;
}

Part FakeWorld::ShortTube() {
  Part part;
  part.name = "short";
  part.length_m = 0.24;
  return part;
}

FakeWorld::FakeWorld(const std::vector<Polyline>& tubes_N, const Bin& bin, const Part& p)
    : part(p) {
  cell.bin = bin;
  for (const Polyline& line_N : tubes_N) {
    tubes.push_back({FakeTube::Place::kBin, line_N, {}, {}});
  }
  const RigidTransform X_BE =
      bin.X_BN * MakeTransform(RotX(kPi), Vector3(0, 0, model.layout.carry_height_m));
  const auto start = InverseWorking(model.arm, X_BE * model.layout.X_FE.inverse());
  REQUIRE(start.status == InverseNearResult::Status::kFound);
  arm.q = start.q;
  clock.each_period = [this] { Pass(); };
  arm.on_start = [this](const CheckedTrajectory& trajectory) { Begin(trajectory); };
  gripper.on_command = [this](const GripperCommand& command) { MoveFingers(command); };
  wrist.weigh = [this] { return Weigh(); };
  scanner.look = [this] { return Look(); };
}

void FakeWorld::During(MotionKind kind, int nth, std::function<void()> happens) {
  events_.push_back({kind, nth, false, std::move(happens)});
}

void FakeWorld::After(MotionKind kind, int nth, std::function<void()> happens) {
  events_.push_back({kind, nth, true, std::move(happens)});
}

void FakeWorld::StopArm(ArmMode mode, const std::string& why) {
  arm.mode = mode;
  arm.fault = why;
}

int FakeWorld::Count(FakeTube::Place place) const {
  return static_cast<int>(std::count_if(tubes.begin(), tubes.end(),
                                        [&](const FakeTube& tube) { return tube.place == place; }));
}

std::vector<FakeMotion> FakeWorld::MotionsOf(MotionKind kind) const {
  std::vector<FakeMotion> out;
  std::copy_if(motions.begin(), motions.end(), std::back_inserter(out),
               [&](const FakeMotion& motion) { return motion.kind == kind; });
  return out;
}

int FakeWorld::CountMotions(MotionKind kind) const {
  return static_cast<int>(MotionsOf(kind).size());
}

RigidTransform FakeWorld::PoseOfE(const JointVector& q) const {
  return FlangePose(model.arm, q) * model.layout.X_FE;
}

FakeWorld::Region FakeWorld::RegionOf(const RigidTransform& X_BE) const {
  const Vector3 p_NE = cell.bin.X_BN.inverse() * X_BE.translation();
  if (std::abs(p_NE.x()) < cell.bin.half_x_m() && std::abs(p_NE.y()) < cell.bin.half_y_m()) {
    return Region::kBin;
  }
  const Vector3 p_TE = model.layout.X_BT.inverse() * X_BE.translation();
  const double half_m = 0.5 * model.layout.tray_size_m;
  return p_TE.head<2>().cwiseAbs().maxCoeff() < half_m ? Region::kTray : Region::kElsewhere;
}

MotionKind FakeWorld::KindOf(const RigidTransform& X_BE_from, const RigidTransform& X_BE_to) const {
  const Vector3 way_B = X_BE_to.translation() - X_BE_from.translation();
  const bool straight = way_B.head<2>().norm() < kSamePlace_m;
  const bool turned =
      Eigen::AngleAxisd(Matrix3(X_BE_from.linear().transpose() * X_BE_to.linear())).angle() >
      kLeaning_rad;
  if (held_.empty()) {
    if (!straight || turned) return MotionKind::kAcross;
    return way_B.z() < 0.0 ? MotionKind::kDown : MotionKind::kUp;
  }
  if (straight && std::abs(way_B.z()) < kSamePlace_m && turned) {
    return Leaning(X_BE_to) > kLeaning_rad ? MotionKind::kTilt : MotionKind::kTiltBack;
  }
  if (RegionOf(X_BE_to) != Region::kBin) {
    return straight && way_B.z() < 0.0 ? MotionKind::kLay : MotionKind::kCarry;
  }
  const bool from_the_pile =
      (cell.bin.X_BN.inverse() * X_BE_from.translation()).z() < kLow_m && way_B.z() > 0.0;
  if (straight || from_the_pile) {
    return way_B.z() < 0.0 ? MotionKind::kLower : MotionKind::kLift;
  }
  return MotionKind::kShift;
}

void FakeWorld::Begin(const CheckedTrajectory& checked) {
  if (running_) faults.push_back("a motion was started while another ran");
  FakeMotion motion;
  motion.trajectory = checked.trajectory();
  motion.began = clock.Now();
  motion.duration_s = checked.duration_s();
  motion.X_BE_from = PoseOfE(motion.trajectory.points.front().q);
  motion.X_BE_to = PoseOfE(motion.trajectory.points.back().q);
  motion.held = held();
  motion.kind = KindOf(motion.X_BE_from, motion.X_BE_to);
  std::string line =
      std::string(ToString(motion.kind)) + " in " + Text("%.17g", motion.duration_s) + " s to";
  for (const double q : motion.trajectory.points.back().q) line += Text(" %.17g", q);
  log.push_back(line);
  pressing_ = Pressed() != nullptr;
  motions.push_back(motion);
  running_ = std::move(motion);
  half_over_ = false;
}

void FakeWorld::Pass() {
  if (!running_) return;
  const double since_s = Seconds(clock.Now() - running_->began);
  if (!half_over_ && since_s >= 0.5 * running_->duration_s) {
    half_over_ = true;
    Happen(false);
  }
  const ArmState state = arm.State();
  if (state.mode == ArmMode::kMoving) return;
  at_rest_since_ = clock.Now();
  const FakeMotion ended = *std::exchange(running_, std::nullopt);
  Roll(ended.X_BE_from.translation(), PoseOfE(state.q).translation());
  if (state.done) Happen(true);
}

void FakeWorld::Happen(bool at_end) {
  const MotionKind kind = motions.back().kind;
  const int nth = CountMotions(kind);
  for (const Event& event : std::vector<Event>(events_)) {
    if (event.kind == kind && event.nth == nth && event.at_end == at_end) event.happens();
  }
}

void FakeWorld::MoveFingers(const GripperCommand& command) {
  log.push_back("fingers to " + Text("%.17g", command.opening_m) + " m with " +
                Text("%.17g", command.force_N) + " N");
  if (held_.empty()) {
    if (command.opening_m < kNothing_m) Close();
  } else if (command.opening_m > 2 * part.radius_m + kReleased_m) {
    Open();
  }
  ShowFingers();
}

void FakeWorld::Close() {
  const RigidTransform X_NE_now = X_NE();
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    if (tubes[i].place != FakeTube::Place::kBin) continue;
    near.emplace_back(Closest(tubes[i].line_N, X_NE_now.translation()).distance_m, i);
  }
  std::sort(near.begin(), near.end());
  // Fingers that close to push are not over a tube; no script speaks of them.
  const bool over_a_tube = !near.empty() && near.front().first < kBetween_m;
  std::size_t count = 0;
  while (count < near.size() && near[count].first < kBetween_m) ++count;
  if (over_a_tube && !grabs_.empty()) {
    count = std::min(near.size(), static_cast<std::size_t>(grabs_.front()));
    grabs_.pop_front();
  }
  for (std::size_t k = 0; k < count; ++k) {
    FakeTube& tube = tubes[near[k].second];
    tube.place = FakeTube::Place::kFingers;
    tube.line_E = Transformed(X_NE_now.inverse(), tube.line_N);
    held_.push_back(near[k].second);
  }
  closed_at_m_ = X_NE_now.translation().z();
}

void FakeWorld::Open() {
  const RigidTransform X_BE_now = X_BE();
  const Region region = RegionOf(X_BE_now);
  const double over_tray_m = (model.layout.X_BT.inverse() * X_BE_now.translation()).z();
  const auto fault = [&](const std::string& what) {
    faults.push_back("the fingers let a tube go " + what);
  };
  if (running_) fault("in motion");
  if (region == Region::kElsewhere) fault("between bin and tray");
  if (region == Region::kBin && X_NE().translation().z() > kLow_m) fault("high over the bin");
  if (region == Region::kTray && over_tray_m > kLaid_m) fault("high over the tray");
  if (region == Region::kTray && held() > 1) fault("with another on the tray");
  for (const std::size_t i : held_) {
    tubes[i].place = region == Region::kBin    ? FakeTube::Place::kBin
                     : region == Region::kTray ? FakeTube::Place::kTray
                                               : FakeTube::Place::kLost;
    tubes[i].line_T = Transformed(model.layout.X_BT.inverse() * X_BE_now, tubes[i].line_E);
  }
  held_.clear();
}

void FakeWorld::Fall(int count) {
  const bool over_bin = RegionOf(X_BE()) == Region::kBin;
  for (; count > 0 && !held_.empty(); --count) {
    tubes[held_.back()].place = over_bin ? FakeTube::Place::kBin : FakeTube::Place::kLost;
    held_.pop_back();
  }
  ShowFingers();
}

void FakeWorld::ShowFingers() {
  GripperState& state = gripper.state;
  state.object = held_.empty() ? GripperObject::kAtPosition : GripperObject::kContactClosing;
  state.opening_m = held_.empty() ? state.requested_m : 2 * part.radius_m;
}

FakeTube* FakeWorld::Pressed() {
  if (!held_.empty() || gripper.state.opening_m > kNothing_m) return nullptr;
  Vector3 tip_N = X_NE().translation();
  tip_N.z() -= 0.5 * PaperCell().gripper.pad_height_m;
  for (FakeTube& tube : tubes) {
    if (tube.place != FakeTube::Place::kBin) continue;
    const Vector3 axis_N = Closest(tube.line_N, tip_N).point;
    const bool under = (axis_N - tip_N).head<2>().norm() < part.radius_m;
    if (under && tip_N.z() < axis_N.z() + part.radius_m) return &tube;
  }
  return nullptr;
}

void FakeWorld::Roll(const Vector3& from_B, const Vector3& to_B) {
  if (!pressing_) return;
  Vector3 way_N = cell.bin.X_BN.linear().transpose() * (to_B - from_B);
  way_N.z() = 0.0;
  if (way_N.norm() < kSamePlace_m) return;
  // The tube that was under the fingers where they began.
  for (FakeTube& tube : tubes) {
    if (tube.place != FakeTube::Place::kBin) continue;
    const Vector3 from_N = cell.bin.X_BN.inverse() * from_B;
    const Vector3 axis_N = Closest(tube.line_N, from_N).point;
    if ((axis_N - from_N).head<2>().norm() > part.radius_m) continue;
    tube.line_N = Transformed(tubetwin::Translation(rolls * way_N), tube.line_N);
    return;
  }
}

Vector3 FakeWorld::HeldTorque_K() const {
  const RigidTransform X_BF = FlangePose(model.arm, arm.State().q);
  const RigidTransform X_KE = model.layout.X_FK.inverse() * model.layout.X_FE;
  const Vector3 g_K = (X_BF * model.layout.X_FK).linear().transpose() * Vector3(0, 0, -kGravity);
  Vector3 torque_K = Vector3::Zero();
  for (const std::size_t i : held_) {
    torque_K += (X_KE * CurveCentre(tubes[i].line_E)).cross(part.mass_kg * g_K);
  }
  return torque_K;
}

Wrench FakeWorld::Weigh() {
  const RigidTransform X_BF = FlangePose(model.arm, arm.State().q);
  const RigidTransform X_NE_now = cell.bin.X_BN.inverse() * X_BF * model.layout.X_FE;
  const Matrix3 R_KB = (X_BF * model.layout.X_FK).linear().transpose();
  const Vector3 g_K = R_KB * Vector3(0, 0, -kGravity);
  Wrench out;
  out.force_N = (PaperCell().gripper.mass_kg + PaperCell().gripper.coupling_mass_kg) * g_K;
  out.torque_Nm = kToolCentre_K.cross(out.force_N);
  if (!held_.empty() && X_NE_now.translation().z() > closed_at_m_ + kLifted_m) {
    out.force_N += static_cast<double>(held_.size()) * part.mass_kg * g_K;
    out.torque_Nm += HeldTorque_K();
    const double t_s = Seconds(clock.Now() - at_rest_since_);
    out.force_N += swing_N * std::cos(2 * kPi * t_s / kSwingPeriod_s) *
                   std::exp(-t_s / kSwingFades_s) * g_K.normalized();
  }
  if (held_.empty()) {
    const bool met = obstacle_height_m && X_NE_now.translation().z() <= *obstacle_height_m;
    if (met) out.force_N += R_KB * Vector3(0, 0, kMet_N);
    if (!met && Pressed() != nullptr) out.force_N += R_KB * Vector3(0, 0, kPressed_N);
  }
  return out;
}

OrganizedCloud FakeWorld::Look() {
  ++scans;
  log.push_back("scan");
  const RigidTransform X_NS =
      cell.bin.X_BN.inverse() * FlangePose(model.arm, arm.State().q) * model.layout.X_FS;
  ToyScene scene;
  scene.radius_m = part.radius_m;
  scene.bin = cell.bin;
  scene.boxes = boxes_N;
  std::string key;
  const auto add = [&key](double number) { key += Text("%.9f ", number); };
  for (const FakeTube& tube : tubes) {
    if (tube.place != FakeTube::Place::kBin) continue;
    scene.tubes_N.push_back(tube.line_N);
    for (const Vector3& p : tube.line_N) std::for_each(p.begin(), p.end(), add);
  }
  for (const ToyScene::Box& box : boxes_N) {
    std::for_each(box.low_N.begin(), box.low_N.end(), add);
    std::for_each(box.high_N.begin(), box.high_N.end(), add);
  }
  std::for_each(X_NS.matrix().data(), X_NS.matrix().data() + 16, add);
  std::for_each(cell.bin.size_m.begin(), cell.bin.size_m.end(), add);
  // Casting rays is what takes time here, and tests look at the same bins again and again.
  static std::map<std::string, OrganizedCloud> seen;
  const auto found = seen.find(key);
  if (found != seen.end()) return found->second;
  // A wider field than the cell's scanner has, and coarser pixels.
  ToyCamera camera;
  camera.width = 688;
  camera.height = 516;
  camera.focal_px = 440.0;
  return seen[key] = ToyScan(scene, camera, X_NS, RandomStream(1, 0, "fake world"));
}

}  // namespace tubetwin::test
