#include "twin/live/fault_script.h"

#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

std::string Complaint(const std::string& toml) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "f.toml", toml);
  try {
    ReadFaultScript(folder / "f.toml");
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kConfig);
    return e.what();
  }
  return "";
}

std::string Fault(const std::string& rest) { return "[[fault]]\n" + rest + "\n"; }

}  // namespace

TEST_CASE("Wrong fault scripts are named with what is allowed", "[unit]") {
  using Catch::Contains;
  CHECK_THAT(Complaint(""), Contains("no [[fault]]"));
  CHECK_THAT(Complaint(Fault("device = \"arm\"\naction = \"hold\"")), Contains("at_s"));
  CHECK_THAT(Complaint(Fault("at_s = 1\non = \"carry\"\ndevice = \"arm\"\naction = \"hold\"")),
             Contains("either"));
  CHECK_THAT(Complaint(Fault("on = \"cary\"\ndevice = \"arm\"\naction = \"hold\"")),
             Contains("carry"));
  CHECK_THAT(Complaint(Fault("at_s = 1\ndevice = \"leg\"\naction = \"hold\"")), Contains("leg"));
  CHECK_THAT(Complaint(Fault("at_s = 1\ndevice = \"gripper\"\naction = \"fualt\"")),
             Contains("nearest: 'fault'"));
  CHECK_THAT(Complaint(Fault("at_s = 1\ndevice = \"arm\"\naction = \"hold\"\nfor = 2")),
             Contains("for: unknown key"));
  CHECK_THAT(Complaint("other = 1\n" + Fault("at_s = 1\ndevice = \"arm\"\naction = \"hold\"")),
             Contains("other"));
  CHECK(Complaint(Fault("at_s = 1\ndevice = \"arm\"\naction = \"hold\"")).empty());
}

TEST_CASE("Every device has actions, each of which a script may name", "[unit]") {
  for (const std::string& device : FaultDevices()) {
    CHECK_FALSE(FaultActions(device).empty());
    for (const std::string& action : FaultActions(device)) {
      CAPTURE(device, action);
      CHECK(Complaint(Fault("at_s = 1\ndevice = \"" + device + "\"\naction = \"" + action + "\""))
                .empty());
    }
  }
}

}  // namespace tubetwin
