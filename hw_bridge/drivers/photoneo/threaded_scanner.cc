#include "hw_bridge/drivers/photoneo/threaded_scanner.h"

#include <exception>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {

ThreadedScanner::ThreadedScanner(ScannerPose believed_X_NS, Acquire acquire)
    : believed_X_NS_(std::move(believed_X_NS)),
      acquire_(std::move(acquire)),
      thread_([this](std::stop_token stop) { Serve(std::move(stop)); }) {}

CommandResult ThreadedScanner::Trigger() {
  if (Status() == ScanStatus::kBusy) {
    return {CommandResult::Status::kRejected, "a scan is running"};
  }
  const RigidTransform X_NS = believed_X_NS_();
  {
    const std::lock_guard lock(mutex_);
    X_NS_ = X_NS;
    cloud_ = {};
    failure_.clear();
    status_ = ScanStatus::kBusy;
  }
  triggered_.notify_one();
  return {};
}

ScanStatus ThreadedScanner::Status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

OrganizedCloud ThreadedScanner::Take() {
  const std::lock_guard lock(mutex_);
  TT_CHECK(status_ == ScanStatus::kReady);
  status_ = ScanStatus::kIdle;
  return std::exchange(cloud_, {});
}

std::string ThreadedScanner::FailureReason() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void ThreadedScanner::Serve(std::stop_token stop) {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (!triggered_.wait(lock, stop, [this] { return status_ == ScanStatus::kBusy; })) return;
    }
    AcquiredScan scan;
    try {
      scan = acquire_(stop);
    } catch (const std::exception& error) {
      scan = ScanFailure{error.what()};
    }
    const std::lock_guard lock(mutex_);
    if (auto* cloud = std::get_if<OrganizedCloud>(&scan)) {
      cloud_ = std::move(*cloud);
      cloud_.label.clear();  // For scoring only; no device knows them.
      cloud_.X_NS = X_NS_;
      status_ = ScanStatus::kReady;
    } else {
      failure_ = std::get<ScanFailure>(scan).reason;
      status_ = ScanStatus::kFailed;
    }
  }
}

}  // namespace tubetwin
