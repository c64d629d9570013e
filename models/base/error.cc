#include "models/base/error.h"

namespace tubetwin {

void ThrowCheckFailed(const char* expression, const char* file, int line) {
  throw LogicError(std::string(file) + ":" + std::to_string(line) +
                   ": this does not hold: " + expression);
}

}  // namespace tubetwin
