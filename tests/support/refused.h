#pragma once

#include <functional>
#include <stdexcept>

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {

/// What an action throws, which it must.
inline Error Refused(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e;
  }
  FAIL("nothing was refused");
  throw std::logic_error("not reached");
}

}  // namespace tubetwin
