// A campaign whose rounds take no time, for the tests of bad disks: its files are those of a real
// one.
//   disk_campaign run OUT      runs it, and says "saved N" after each round that was saved
//   disk_campaign merge OUT M  merges it

#include <cstdio>
#include <cstring>
#include <exception>

#include "tests/campaign/fake_rounds.h"

namespace tubetwin {
namespace {

constexpr int kRounds = 8, kVariants = 2;

int Main(int argc, char** argv) {
  const Campaign campaign = FakeCampaign(kRounds, kVariants);
  if (argc == 4 && std::strcmp(argv[1], "merge") == 0) {
    WriteMerged(ReadShards({argv[2]}), argv[3]);
    return 0;
  }
  if (argc != 3) return static_cast<int>(ErrorKind::kUsage);
  CampaignRunOptions options = Options(argv[2]);
  options.jobs = 1;  // Rounds are saved in their order.
  options.progress = [](const ShardProgress& progress) {
    std::printf("saved %d\n", progress.done);
    std::fflush(stdout);
  };
  options.notice = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
  RunCampaign(campaign, Rounds(campaign), options);
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  try {
    return tubetwin::Main(argc, argv);
  } catch (const tubetwin::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return static_cast<int>(e.kind());
  } catch (const std::exception& e) {
    const auto machine = tubetwin::MachineError(e);
    std::fprintf(stderr, "%s\n", e.what());
    return static_cast<int>(machine ? machine->kind() : tubetwin::ErrorKind::kInternal);
  }
}
