#include <memory>

#include "tests/contract/arm_rigs.h"
#include "tests/contract/device_contract.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

using Suite = void (*)(ArmContractRig&);

TEST_CASE("Twin, and driver before emulated controller, keep the arm's contract", "[contract]") {
  const auto [name, suite] = GENERATE(table<const char*, Suite>({
      {"as any device", [](ArmContractRig& rig) { CheckArmContract(rig.cell()); }},
      {"starts", CheckArmStarts},
      {"follows", CheckArmFollows},
      {"stops", CheckArmStops},
      {"protective stop", CheckArmProtectiveStop},
  }));
  const bool over_loopback = GENERATE(false, true);
  CAPTURE(name, over_loopback);
  std::unique_ptr<ArmContractRig> rig;
  if (over_loopback) {
    rig = std::make_unique<DriverArmRig>();
  } else {
    rig = std::make_unique<TwinArmRig>();
  }
  suite(*rig);
}

}  // namespace
}  // namespace tubetwin::test
