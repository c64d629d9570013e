// The registry: a line for each method.

#include "models/arm/inverse/inverse_method.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

const std::vector<InverseMethod>& InverseMethods() {
  static const std::vector<InverseMethod> methods = {
      OffsetWristInverse(),
      SphericalWristInverse(),
      ThreeParallelInverse(),
      NumericInverse(),
  };
  return methods;
}

std::vector<std::string> InverseNames() {
  std::vector<std::string> names;
  for (const InverseMethod& method : InverseMethods()) names.emplace_back(method.name);
  return names;
}

const InverseMethod& MethodOf(const ArmModel& arm) {
  for (const InverseMethod& method : InverseMethods()) {
    if (arm.inverse == method.name) return method;
  }
  throw Error(ErrorKind::kConfig, "arm '" + arm.name + "': inverse is \"" + arm.inverse +
                                      "\", allowed are " + Join(InverseNames()) +
                                      "; the nearest is '" +
                                      NearestName(arm.inverse, InverseNames()) + "'");
}

}  // namespace tubetwin
