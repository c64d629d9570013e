#pragma once

#include "models/base/time.h"

namespace tubetwin {

/// The controller's side of one device: serves a device of a Cell on its wire protocol. All
/// emulators run on one thread, which alternates network events, the cell's clock and Tick().
class Emulator {
 public:
  virtual ~Emulator() = default;
  /// After every control period of the cell; `now` is the cell's time. Never throws for what a
  /// client or the network does.
  virtual void Tick(TimeNs now) = 0;
};

}  // namespace tubetwin
