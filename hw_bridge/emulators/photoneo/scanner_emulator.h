#pragma once

#include <cstdint>
#include <string>

#include "hw_bridge/emulators/emulator.h"
#include "hw_bridge/emulators/link_faults.h"
#include "hw_bridge/emulators/photoneo/scan_faults.h"

namespace tubetwin {

/// What emulated scanners share, whatever their protocol.
class ScannerEmulator : public Emulator {
 public:
  std::uint64_t triggers() const { return triggers_; }  ///< Taken up so far.
  std::uint64_t answers() const { return answers_; }    ///< Clouds and refusals sent so far.
  /// The last thing that went wrong on this side (disk full, folder gone); empty: nothing yet.
  const std::string& last_problem() const { return last_problem_; }

  // What fault scripts do.
  ScanFaults& faults() { return faults_; }
  LinkFaults& link() { return link_; }

 protected:
  ScanFaults faults_;
  LinkFaults link_;
  std::uint64_t triggers_ = 0, answers_ = 0;
  std::string last_problem_;
};

}  // namespace tubetwin
