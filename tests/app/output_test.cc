// What becomes of what the program prints: a full disk behind standard output, closed files.

#include <filesystem>
#include <string>

#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("What a full disk does not take of the output ends with 74, whatever the verb", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kPile);
  for (const char* arguments :
       {"config dump", "config schema", "config check", "config model", "config model ur10e",
        "campaign schema", "pile show p.json", "pile show p.json --json", "part check pvc_a",
        "plan --help", "help", "help campaign run", "--help", "--version", "doctor",
        "doctor --json"}) {
    INFO(arguments);
    // A machine without EGL: what is missing there goes before.
    const int plain = RunProgram(folder, arguments).code;
    const bool may_fail = std::string(arguments).rfind("doctor", 0) == 0;
    REQUIRE((plain == 0 || may_fail));
    const Outcome outcome = RunProgram(folder, arguments, "", "> /dev/full");
    CHECK(outcome.code == (plain == 0 ? 74 : plain));
    CHECK_THAT(outcome.err, Contains("standard output cannot be written: No space left on device"));
    CHECK(Lines(outcome.err) <= 4);
  }
  // What went wrong before keeps its own code.
  CHECK(RunProgram(folder, "pile show none.json", "", "> /dev/full").code == 66);
}

TEST_CASE("Closed standard files are no error, and nothing that is printed lands in a file",
          "[app]") {
  const TemporaryFolder folder;
  Write(folder, "C.toml",
        "rounds = 1\n[keep]\nsample = 0.0\nfailures = 0\n[[variant]]\ncount = 1\n");
  CHECK(RunProgram(folder, "config dump", "", ">&-").code == 0);
  CHECK(RunProgram(folder, "config dump", "", "<&- >&- 2>&-").code == 0);
  REQUIRE(RunProgram(folder, "campaign run C.toml --shard 0/1 --out o", "", "<&- >&- 2>&-").code ==
          0);
  const std::string shard = ReadFile(folder / "o/shard-00000-of-00001.jsonl");
  CHECK(Lines(shard) == 2);
  CHECK(RunProgram(folder, "campaign merge o --out m").code == 0);
}

TEST_CASE("SIGHUP asks for an end as SIGTERM does, unless nohup said otherwise", "[app][slow]") {
  const TemporaryFolder folder;
  Write(folder, "C.toml", "rounds = 60\n[[variant]]\ncount = 1\n");
  // The signal comes when the first round is saved: the shard's file has its second line.
  const std::string wait =
      "& pid=$!; cd '" + folder.path() +
      "'; for i in $(seq 600); do [ $(cat o/shard-*.jsonl 2>/dev/null | wc -l) -ge 2 ] && break; "
      "sleep 0.1; done; kill -HUP $pid; wait $pid; exit $?";
  const Outcome hung_up = RunProgram(folder, "campaign run C.toml --out o --jobs 1", "exec ", wait);
  CHECK(hung_up.code == 75);
  CHECK_THAT(hung_up.err, Contains("run again to go on"));
  const Outcome ignored = RunProgram(folder, "campaign run C.toml --out o --jobs 1 --limit-time 4s",
                                     "trap '' HUP; exec ", wait);
  CHECK(ignored.code == 75);
  CHECK_THAT(ignored.err, Contains("the time is up"));
}

}  // namespace
}  // namespace tubetwin
