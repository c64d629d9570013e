#pragma once

#include "models/base/time.h"

namespace tubetwin {

/// What a fault script does to a device's link. Each emulator consults it wherever it receives or
/// sends a message, whatever a message is in its protocol.
struct LinkFaults {
  bool drop = false;       ///< Messages are lost, in both directions.
  TimeNs delay{0};         ///< What is sent leaves that much later, cell time.
  bool duplicate = false;  ///< What is sent is sent twice.
  bool corrupt = false;    ///< Bytes of what is sent are changed.
  bool freeze = false;     ///< The controller does nothing at all; its sockets stay open.
};

}  // namespace tubetwin
