#pragma once

#include <string>

namespace tubetwin {

/// Why something was not offered. `motion` or `grasp` empty: it holds for all of them.
struct Rejection {
  int tube = 0;
  std::string motion, grasp, reason;
};

}  // namespace tubetwin
