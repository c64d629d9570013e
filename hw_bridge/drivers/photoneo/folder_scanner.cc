#include "hw_bridge/drivers/photoneo/folder_scanner.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <utility>

#include "hw_bridge/codecs/scan_folder.h"
#include "hw_bridge/drivers/photoneo/scan_check.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using WallClock = std::chrono::steady_clock;
using Kind = ScanFileName::Kind;

constexpr auto kPoll = std::chrono::milliseconds(10);
constexpr auto kQuiet = std::chrono::milliseconds(200);     // Before a file that may grow is read.
constexpr auto kSettled = std::chrono::milliseconds(1000);  // Nobody is writing it any more.

constexpr std::uint64_t kTimesTheScan = 4;      // Other scanners see more than the cell's.
constexpr std::uint64_t kMostBytesAPoint = 64;  // Every field in binary, or six in text.

/// Tells whether a file is still the one that was looked at.
struct Stamp {
  std::uint64_t file = 0;  ///< Inode.
  std::int64_t size = 0;
  std::int64_t changed_ns = 0;
  bool operator==(const Stamp&) const = default;
};

struct Entry {
  ScanFileName name;
  Stamp stamp;
  /// It got its name after it was written, and so at once: it does not grow. Files that are written
  /// in their place may, with their whole size from the start, too.
  bool renamed = false;
};
using Listing = std::map<std::string, Entry>;  ///< By file name.

/// A file that may be the answer, watched until it is whole.
struct Candidate {
  std::string name;
  Stamp stamp;
  WallClock::time_point since;  ///< It has been as it is.
  std::string problem;          ///< Why it could not be read as it is; empty: not tried yet.
};

std::string FirstLine(const std::string& path) {
  std::ifstream in(path);
  std::string line(200, '\0');
  in.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(in.gcount()));
  line = line.substr(0, line.find_first_of("\r\n"));
  for (char& c : line) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return line.empty() ? "without a reason" : line;
}

/// The client's side of a scan folder. One thread.
class FolderLink {
 public:
  explicit FolderLink(const ScannerLinkConfig& config) : config_(config) {
    if (!fs::is_directory(config_.path)) {
      throw Error(ErrorKind::kDevice, Who() + "there is no such folder");
    }
    if (::access(config_.path.c_str(), R_OK | W_OK | X_OK) != 0) {
      throw Error(ErrorKind::kDevice,
                  Who() + "no permission to write here; triggers are files in the folder");
    }
  }

  AcquiredScan Acquire(const std::stop_token& stop) {
    const Listing before = List();
    for (const auto& [name, entry] : before) last_ = std::max(last_, entry.name.number);
    const std::uint64_t number = ++last_;
    const std::string trigger = TriggerFileName(number);
    WriteMessageFile(Path(trigger), "a scan is wanted: answer as " +
                                        ScanFileNameOf(number, ".pcd") + " or .ply\n");
    AcquiredScan scan = Await(before, number, stop);
    std::error_code gone;  // A feed that took the trigger up has removed it.
    fs::remove(Path(trigger), gone);
    return scan;
  }

 private:
  std::string Who() const { return "scanner folder '" + config_.path + "': "; }
  std::string Path(const std::string& name) const { return config_.path + "/" + name; }

  Listing List() const {
    std::error_code code;
    Listing listing;
    fs::directory_iterator file(config_.path, code);
    for (; !code && file != fs::directory_iterator(); file.increment(code)) {
      const std::string name = file->path().filename().string();
      const ScanFileName parsed = ParseScanFileName(name);
      if (parsed.kind == Kind::kOther) continue;
      struct stat status = {};
      // Gone since it was listed, or a folder: not there.
      if (::stat(Path(name).c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
      const auto ns = [](const timespec& time) {
        return time.tv_sec * std::int64_t{1000000000} + time.tv_nsec;
      };
      listing[name] = {parsed,
                       {status.st_ino, status.st_size, ns(status.st_mtim)},
                       ns(status.st_ctim) > ns(status.st_mtim)};
    }
    if (code) throw Error(ErrorKind::kDevice, Who() + "cannot be read: " + code.message());
    return listing;
  }

  /// The cloud that answers `number`, whole or not: its own one, else the newest saved one.
  static const Listing::value_type* Answer(const Listing& now, const Listing& before,
                                           std::uint64_t number) {
    const Listing::value_type* best = nullptr;
    for (const auto& file : now) {
      const Entry& entry = file.second;
      if (entry.name.kind == Kind::kScan && entry.name.number == number) return &file;
      if (entry.name.kind != Kind::kSaved) continue;
      const auto old = before.find(file.first);
      if (old != before.end() && old->second.stamp == entry.stamp) continue;
      if (best == nullptr || entry.stamp.changed_ns > best->second.stamp.changed_ns) best = &file;
    }
    return best;
  }

  AcquiredScan Await(const Listing& before, std::uint64_t number, const std::stop_token& stop) {
    const auto limit = std::chrono::duration<double>(config_.timeout_s / config_.rate);
    const auto begin = WallClock::now();
    Candidate candidate;
    while (!stop.stop_requested()) {
      const Listing now = List();
      const auto refusal = now.find(ScanFileNameOf(number, ".error"));
      if (refusal != now.end()) {
        return ScanFailure{Who() + "the scan was refused: " + FirstLine(Path(refusal->first))};
      }
      if (const auto* file = Answer(now, before, number)) {
        if (auto scan = Look(file->first, file->second, candidate)) return *std::move(scan);
      }
      if (WallClock::now() - begin >= limit) return TimedOut(number, candidate);
      std::this_thread::sleep_for(kPoll);
    }
    return ScanFailure{Who() + "the scan was given up"};
  }

  /// The outcome as soon as there is one.
  std::optional<AcquiredScan> Look(const std::string& name, const Entry& entry,
                                   Candidate& candidate) const {
    if (candidate.name != name || !(candidate.stamp == entry.stamp)) {
      candidate = {name, entry.stamp, WallClock::now(), ""};
    }
    const std::uint64_t most = kMostBytesAPoint * kTimesTheScan * config_.max_points;
    if (static_cast<std::uint64_t>(entry.stamp.size) > most) {
      return ScanFailure{"scanner: " + Path(name) + ": holds " + std::to_string(entry.stamp.size) +
                         " bytes; allowed: " + std::to_string(most) + " for four scans of " +
                         std::to_string(config_.max_points) + " points"};
    }
    const auto quiet = WallClock::now() - candidate.since;
    if (candidate.problem.empty()) {
      const bool may_grow = entry.name.kind == Kind::kSaved || !entry.renamed;
      if (may_grow && quiet < kQuiet) return std::nullopt;
      try {
        OrganizedCloud cloud = ReadCloud(Path(name));
        const Listing after = List();
        const auto still = after.find(name);
        if (still == after.end() || !(still->second.stamp == entry.stamp)) return std::nullopt;
        if (const auto problem = NoScan(cloud)) {
          return ScanFailure{"scanner: " + Path(name) + ": " + *problem};
        }
        return cloud;
      } catch (const Error& error) {
        candidate.problem = error.what();  // Perhaps only half of it is there.
      }
    }
    if (quiet < kSettled) return std::nullopt;
    return ScanFailure{"scanner: " + candidate.problem};
  }

  AcquiredScan TimedOut(std::uint64_t number, const Candidate& candidate) const {
    std::string reason = Who() + "no whole scan within " + Number(config_.timeout_s) + " s of " +
                         TriggerFileName(number);
    if (!candidate.problem.empty()) reason += "; last: " + candidate.problem;
    return ScanFailure{reason};
  }

  ScannerLinkConfig config_;
  std::uint64_t last_ = 0;  ///< Highest number seen or used.
};

}  // namespace

FolderScanner::FolderScanner(const ScannerLinkConfig& config, ScannerPose believed_X_NS)
    : ThreadedScanner(std::move(believed_X_NS),
                      [link = std::make_shared<FolderLink>(config)](const std::stop_token& stop) {
                        return link->Acquire(stop);
                      }) {}

}  // namespace tubetwin
