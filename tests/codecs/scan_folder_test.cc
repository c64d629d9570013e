#include "hw_bridge/codecs/scan_folder.h"

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Kind = ScanFileName::Kind;

TEST_CASE("Names of a scan folder are written with six digits or more", "[unit]") {
  CHECK(TriggerFileName(7) == "trigger-000007");
  CHECK(TriggerFileName(1234567) == "trigger-1234567");
  CHECK(ScanFileNameOf(7, ".pcd") == "scan-000007.pcd");
  CHECK(ScanFileNameOf(999999, ".error") == "scan-999999.error");
}

TEST_CASE("Names of a scan folder are read back with their number", "[unit]") {
  struct Row {
    const char* name;
    Kind kind;
    std::uint64_t number;
  };
  const Row rows[] = {
      {"trigger-000007", Kind::kTrigger, 7},
      {"trigger-1234567", Kind::kTrigger, 1234567},
      {"scan-000012.pcd", Kind::kScan, 12},
      {"scan-000012.PLY", Kind::kScan, 12},
      {"scan-000012.error", Kind::kRefusal, 12},
      {"scan-000012", Kind::kOther, 0},
      {"bin 3.ply", Kind::kSaved, 0},
      {"scan-12.pcd", Kind::kSaved, 0},  // Too few digits: somebody's own name.
      {"scan-00001x.pcd", Kind::kSaved, 0},
      {"scan-000001.copy.pcd", Kind::kSaved, 0},
      {"scan-1234567890123456789.pcd", Kind::kSaved, 0},  // Would not fit.
      {".scan-000012.pcd", Kind::kOther, 0},              // Being written.
      {"trigger-00007", Kind::kOther, 0},
      {"trigger--00007", Kind::kOther, 0},
      {"trigger-000007.tmp", Kind::kOther, 0},
      {"notes.error", Kind::kOther, 0},
      {"scan.praw", Kind::kOther, 0},
      {"", Kind::kOther, 0},
  };
  for (const Row& row : rows) {
    INFO(row.name);
    CHECK(ParseScanFileName(row.name).kind == row.kind);
    CHECK(ParseScanFileName(row.name).number == row.number);
  }
}

TEST_CASE("Any number survives being written as a name, and any bytes are a name", "[unit]") {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    RandomStream stream(1, i, "scan folder names");
    const std::uint64_t number =
        (static_cast<std::uint64_t>(stream.NextBits()) << 20 | stream.Index(1 << 20)) >>
        stream.Index(50);
    const ScanFileName trigger = ParseScanFileName(TriggerFileName(number));
    const ScanFileName scan = ParseScanFileName(ScanFileNameOf(number, ".ply"));
    if (trigger.kind != Kind::kTrigger || trigger.number != number || scan.kind != Kind::kScan ||
        scan.number != number) {
      FAIL("number " << number << " is lost");
    }
    std::string name = stream.Uniform() < 0.5 ? ScanFileNameOf(number, ".pcd") : "";
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::size_t at = stream.Index(static_cast<std::uint32_t>(name.size() + 1));
      name.insert(at, 1, static_cast<char>(stream.Index(256)));
    }
    const ScanFileName parsed = ParseScanFileName(name);
    if (parsed.kind == Kind::kOther && parsed.number != 0) FAIL("a number without a kind");
  }
}

}  // namespace
}  // namespace tubetwin
