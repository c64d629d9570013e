#include "twin/cell/twin_scanner.h"

#include <utility>

#include "models/base/error.h"

namespace tubetwin {

TwinScanner::TwinScanner(const CellModel& model, const CellWorld& world, const TwinArm& arm,
                         Setup setup, RandomStream stream)
    : model_(model), world_(world), arm_(arm), setup_(std::move(setup)), stream_(stream) {}

RigidTransform TwinScanner::TrueX_BS() const {
  return PoseOfScanner(model_, arm_.TruePosition()) * setup_.physics.X_SbelievedS;
}

std::uint64_t TwinScanner::taken() const {
  TT_CHECK(!shot_);
  return taken_;
}

CommandResult TwinScanner::Trigger() {
  if (Status() == ScanStatus::kBusy) {
    return {CommandResult::Status::kRejected, "a scan is running"};
  }
  Shot shot;
  shot.geometry = world_.Geometry();
  shot.X_BS = TrueX_BS();
  shot.X_NSBelieved = setup_.bin.X_BN.inverse() * PoseOfScanner(model_, arm_.State().q);
  shot.ready = world_.now() + FromSeconds(setup_.settings.spec.scan_time_s);
  shot.index = taken_++;
  shot_ = std::move(shot);
  return {};
}

ScanStatus TwinScanner::Status() const {
  if (!shot_) return ScanStatus::kIdle;
  return world_.now() < shot_->ready ? ScanStatus::kBusy : ScanStatus::kReady;
}

OrganizedCloud TwinScanner::Take() { return TakeLater()(); }

std::function<OrganizedCloud()> TwinScanner::TakeLater() {
  TT_CHECK(Status() == ScanStatus::kReady);
  const auto cast = [shot = std::move(*shot_), settings = setup_.settings,
                     parallelism = setup_.parallelism, stream = stream_] {
    OrganizedCloud cloud =
        CastScan(shot.geometry, shot.X_BS, settings, stream.Fork("shot", shot.index), parallelism);
    cloud.X_NS = shot.X_NSBelieved;
    return cloud;
  };
  shot_.reset();
  return cast;
}

}  // namespace tubetwin
