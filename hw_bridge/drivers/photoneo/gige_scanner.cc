#include "hw_bridge/drivers/photoneo/gige_scanner.h"

#include <chrono>
#include <utility>

#include "hw_bridge/drivers/photoneo/gige_camera.h"
#include "hw_bridge/drivers/photoneo/scan_check.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr auto kWait = std::chrono::milliseconds(20);

/// Triggers and awaits. One thread.
class GigeLink {
 public:
  explicit GigeLink(const ScannerLinkConfig& config)
      : limit_(config.timeout_s / config.rate),
        timeout_text_(Number(config.timeout_s)),
        camera_(config.host) {}

  AcquiredScan Acquire(const std::stop_token& stop) {
    if (camera_.lost()) return Lost();
    // A frame that was given up would be taken for the answer to this trigger.
    if (std::exchange(given_up_, true)) camera_.Restart();
    AcquiredScan scan = Await(stop);
    given_up_ = std::holds_alternative<ScanFailure>(scan);
    return scan;
  }

 private:
  ScanFailure Failure(const std::string& what) const {
    return ScanFailure{camera_.name() + ": " + what};
  }
  ScanFailure Lost() const {
    return Failure("control was lost; the cell has to be started again to connect anew");
  }

  AcquiredScan Await(const std::stop_token& stop) {
    const auto began = SteadyClock::now();
    camera_.Trigger();
    std::string incomplete;  // What was wrong with the first frame; empty: none has come.
    while (!stop.stop_requested()) {
      if (camera_.lost()) return Lost();
      ReceivedFrame frame = camera_.Receive(kWait);
      if (auto* cloud = std::get_if<OrganizedCloud>(&frame)) {
        if (const auto problem = NoScan(*cloud)) return Failure(*problem);
        return std::move(*cloud);
      }
      const auto& none = std::get<NoFrame>(frame);
      if (none.kind == NoFrame::Kind::kNoRange) return Failure(none.what);
      if (none.kind == NoFrame::Kind::kIncomplete) {
        if (!incomplete.empty()) {
          return Failure("the frame came incomplete twice: " + incomplete + ", then " + none.what);
        }
        incomplete = none.what;
        camera_.Trigger();
      }
      if (SteadyClock::now() - began >= limit_) return TimedOut(incomplete);
    }
    return Failure("the scan was given up");
  }

  ScanFailure TimedOut(const std::string& incomplete) const {
    std::string what = "no whole frame within " + timeout_text_ + " s of the trigger";
    if (!incomplete.empty()) what += "; the first one came incomplete: " + incomplete;
    return Failure(what);
  }

  const std::chrono::duration<double> limit_;  ///< Wall time.
  const std::string timeout_text_;
  GigeCamera camera_;
  bool given_up_ = false;  ///< A frame may be on its way that nobody waits for.
};

}  // namespace

GigeScanner::GigeScanner(const ScannerLinkConfig& config, ScannerPose believed_X_NS)
    : ThreadedScanner(std::move(believed_X_NS),
                      [link = std::make_shared<GigeLink>(config)](const std::stop_token& stop) {
                        return link->Acquire(stop);
                      }) {}

}  // namespace tubetwin
