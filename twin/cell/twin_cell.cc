#include "twin/cell/twin_cell.h"

#include <cmath>
#include <utility>

#include "models/base/json.h"
#include "models/base/json_text.h"
#include "twin/cell/twin_cell_impl.h"

namespace tubetwin {

TimeNs TwinClock::Now() const { return parts_.world.now(); }

void TwinClock::AdvanceTo(TimeNs t) {
  while (Now() < t) parts_.Step();
}

TwinCell::Impl::Impl(const Pile& pile, const TwinCellOptions& options)
    : model(options.model),
      world(pile, model, options.physics),
      arm(model.arm, world),
      gripper(world),
      wrist(model.wrist, world, options.physics,
            RandomStream(options.seed, options.round, "wrench")),
      scanner(model, world, arm, {pile.bin, options.physics, options.scan, options.parallelism},
              RandomStream(options.seed, options.round, "scan")),
      clock(*this),
      cell{clock, arm, gripper, wrist, scanner, model, pile.bin, {}},
      start_pile(pile) {
  // The first sample of the wrist, with the arm already held by its motors.
  arm.Control();
  gripper.Control();
  world.Refresh();
  wrist.Sample();
}

void TwinCell::Impl::Step() {
  arm.Control();
  gripper.Control();
  world.Step();
  wrist.Sample();
  // Frame k is due at k/30 s rounded to a step.
  constexpr double kFramesPerSecond = 30.0;
  const double due_s = (frames + 1) / kFramesPerSecond;
  if (world.now() >= kControlPeriod * std::llround(due_s / Seconds(kControlPeriod))) {
    ++frames;
    if (observer) observer();
  }
}

TwinCell::TwinCell(const Pile& pile, const TwinCellOptions& options)
    : impl_(std::make_unique<Impl>(pile, options)) {}
TwinCell::~TwinCell() = default;

ServoArm& TwinCell::servo_arm() { return impl_->arm; }
Cell& TwinCell::cell() { return impl_->cell; }

void TwinCell::SetFrameObserver(std::function<void()> observer) {
  impl_->observer = std::move(observer);
}

void TwinCell::WakeAll() { impl_->world.WakeAll(); }

Json TwinCell::State() const {
  return Json{{"world", impl_->world.State()},           {"arm", impl_->arm.StoredState()},
              {"gripper", impl_->gripper.StoredState()}, {"wrist", impl_->wrist.StoredState()},
              {"scans", impl_->scanner.taken()},         {"frames", impl_->frames}};
}

void TwinCell::Restore(const JsonView& state) {
  // The gripper first: its force is a number of the model.
  impl_->gripper.Restore(state.Field("gripper"));
  impl_->world.Restore(state.Field("world"));
  impl_->arm.Restore(state.Field("arm"));
  impl_->wrist.Restore(state.Field("wrist"));
  impl_->scanner.SetTaken(static_cast<std::uint64_t>(CountFromJson(state.Field("scans"))));
  impl_->frames = CountFromJson(state.Field("frames"));
}

std::string TwinCell::ModelXml() const { return impl_->world.Xml(); }

std::vector<double> TwinCell::Qpos() const {
  const mjData& data = impl_->world.data();
  return std::vector<double>(data.qpos, data.qpos + impl_->world.model().nq);
}

}  // namespace tubetwin
