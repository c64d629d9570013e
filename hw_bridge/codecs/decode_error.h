#pragma once

#include <string>

namespace tubetwin {

/// Why bytes are no message of a protocol: an expected outcome on any network, so decoders return
/// it and never throw.
struct DecodeError {
  std::string reason;  ///< What is wrong, with the value and what is allowed.
};

}  // namespace tubetwin
