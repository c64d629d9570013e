#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>

#include "hw_bridge/cell/devices.h"

namespace tubetwin {

/// X_NS as the pipeline believes it now: from the arm's joints and the hand-eye calibration.
using ScannerPose = std::function<RigidTransform()>;

struct ScanFailure {
  std::string reason;  ///< Names device, place and, for a file, the byte or line.
};
using AcquiredScan = std::variant<OrganizedCloud, ScanFailure>;

/// A Scanner whose link is served by a thread of its own: what folder and GigE Vision share. The
/// methods belong to the thread of the pick cycle and never wait for the link; the pose is asked
/// for in Trigger(), on that thread. The destructor ends the thread; a scan under way is given up.
class ThreadedScanner : public Scanner {
 public:
  CommandResult Trigger() override;
  ScanStatus Status() const override;
  OrganizedCloud Take() override;
  std::string FailureReason() const override;

 protected:
  /// Triggers the device and waits for its whole scan, in S, in vain when `stop` is requested. Runs
  /// on the thread; what it throws is a failed scan.
  using Acquire = std::function<AcquiredScan(std::stop_token stop)>;
  ThreadedScanner(ScannerPose believed_X_NS, Acquire acquire);

 private:
  void Serve(std::stop_token stop);

  ScannerPose believed_X_NS_;
  Acquire acquire_;

  mutable std::mutex mutex_;  ///< Of all below but the thread.
  std::condition_variable_any triggered_;
  ScanStatus status_ = ScanStatus::kIdle;
  RigidTransform X_NS_ = RigidTransform::Identity();  ///< At the trigger.
  OrganizedCloud cloud_;
  std::string failure_;

  std::jthread thread_;  ///< Last: ends before what it uses.
};

}  // namespace tubetwin
