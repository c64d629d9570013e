#include "hw_bridge/emulators/photoneo/scanner_folder_emulator.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <utility>
#include <vector>

#include "hw_bridge/codecs/scan_folder.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/parallel.h"
#include "models/base/random.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

constexpr TimeNs kPoll = std::chrono::milliseconds(10);

/// Changes bytes of the header, as a bad cable or disk would: no reader can miss that.
void CorruptFile(const std::string& path) {
  std::string bytes = ReadFile(path);
  for (std::size_t i = 3; i < bytes.size() && i < 64; i += 7) {
    bytes[i] = static_cast<char>(bytes[i] ^ 0x95);
  }
  WriteMessageFile(path, bytes);
}

void WriteGarbage(const std::string& path, std::uint64_t seed) {
  RandomStream stream(seed, 0, "garbage scan");
  std::string bytes(4096, '\0');
  for (char& c : bytes) c = static_cast<char>(stream.Index(256));
  WriteMessageFile(path, bytes);
}

}  // namespace

ScannerFolderEmulator::ScannerFolderEmulator(Scanner& scanner, const ScannerFolderConfig& config)
    : scanner_(scanner), config_(config) {
  MakeFolder(config_.path);
}

ScannerFolderEmulator::~ScannerFolderEmulator() = default;  // The thread of files is waited for.

void ScannerFolderEmulator::Tick(TimeNs now) {
  // Disks may block for longer than a control period: files are the other thread's.
  if (link_.freeze || !files_.idle()) return;
  Settle(now);
  if (!files_.idle()) return;
  if (scanning_) {
    FollowScan();
  } else if (!hidden_.empty()) {
    if (now >= publish_at_) Publish();
  } else if (now >= next_poll_) {
    next_poll_ = now + kPoll;
    LookForTrigger();
  }
}

void ScannerFolderEmulator::Do(Doing what, std::function<void()> work) {
  doing_ = what;
  files_.Start([this, work = std::move(work)] {
    try {
      work();
    } catch (const std::exception& error) {  // The folder is gone, the disk is full: go on.
      problem_ = error.what();
    }
  });
}

void ScannerFolderEmulator::Settle(TimeNs now) {
  const Doing done = std::exchange(doing_, Doing::kNothing);
  if (!problem_.empty()) {
    last_problem_ = std::exchange(problem_, {});
    hidden_.clear();
    return;
  }
  switch (done) {
    case Doing::kNothing:
      return;
    case Doing::kLooking:
      if (found_ > 0 && !link_.drop) Start(found_);
      return;
    case Doing::kWriting:
      publish_at_ = now + link_.delay + FromSeconds(fault_.delay_s);
      return;
    case Doing::kPublishing:
      if (!link_.drop) ++answers_;
      return;
  }
}

void ScannerFolderEmulator::LookForTrigger() {
  Do(Doing::kLooking, [this] {
    found_ = 0;
    std::vector<fs::path> triggers;
    for (const fs::directory_entry& file : fs::directory_iterator(config_.path)) {
      const ScanFileName name = ParseScanFileName(file.path().filename().string());
      if (name.kind != ScanFileName::Kind::kTrigger || !file.is_regular_file()) continue;
      found_ = std::max(found_, name.number);
      triggers.push_back(file.path());
    }
    for (const fs::path& trigger : triggers) fs::remove(trigger);
  });
}

void ScannerFolderEmulator::Start(std::uint64_t number) {
  ++triggers_;
  number_ = number;
  fault_ = faults_.Next();
  if (fault_.fault == ScanFault::kNoAnswer) return;
  if (fault_.fault == ScanFault::kRefused) return Refuse(fault_.reason);
  const CommandResult triggered = scanner_.Trigger();
  if (!triggered.accepted()) return Refuse(triggered.reason);
  scanning_ = true;
}

void ScannerFolderEmulator::FollowScan() {
  switch (scanner_.Status()) {
    case ScanStatus::kBusy:
      return;
    case ScanStatus::kReady:
      scanning_ = false;
      return Write();
    case ScanStatus::kFailed:
      scanning_ = false;
      return Refuse(scanner_.FailureReason());
    case ScanStatus::kIdle:
      scanning_ = false;
      return Refuse("the scan got lost");
  }
}

void ScannerFolderEmulator::Write() {
  hidden_ = config_.path + "/." + ScanFileNameOf(number_, ".part." + config_.format);
  Do(Doing::kWriting, [hidden = hidden_, take = scanner_.TakeLater(), fault = fault_.fault,
                       number = number_, corrupt = link_.corrupt, ply = config_.format == "ply"] {
    OrganizedCloud cloud = take();
    cloud.label.clear();
    cloud.X_NS = RigidTransform::Identity();
    if (fault == ScanFault::kEmptyCloud) ClearPoints(cloud);
    if (fault == ScanFault::kGarbage) {
      WriteGarbage(hidden, number);
    } else if (ply) {
      WritePhoxiPly(cloud, static_cast<std::uint32_t>(number), hidden);
    } else {
      WritePcd(cloud, hidden);
    }
    if (fault == ScanFault::kTruncated) fs::resize_file(hidden, fs::file_size(hidden) / 5 * 3);
    if (corrupt) CorruptFile(hidden);
  });
}

void ScannerFolderEmulator::Publish() {
  const std::string path = config_.path + "/" + ScanFileNameOf(number_, "." + config_.format);
  std::vector<std::string> old;
  if (!link_.drop) published_.push_back(path);
  while (published_.size() > static_cast<std::size_t>(config_.keep)) {
    old.push_back(published_.front());
    published_.pop_front();
  }
  Do(Doing::kPublishing, [hidden = std::exchange(hidden_, {}), path, old = std::move(old),
                          drop = link_.drop, twice = link_.duplicate] {
    if (drop) {
      fs::remove(hidden);
      return;
    }
    if (twice) {
      const std::string copy = hidden + ".copy";
      fs::copy_file(hidden, copy, fs::copy_options::overwrite_existing);
      fs::rename(copy, path);
    }
    fs::rename(hidden, path);
    for (const std::string& file : old) fs::remove(file);
  });
}

void ScannerFolderEmulator::Refuse(const std::string& reason) {
  if (link_.drop) return;
  const std::string path = config_.path + "/" + ScanFileNameOf(number_, ".error");
  published_.push_back(path);
  Do(Doing::kPublishing, [path, reason] { WriteMessageFile(path, reason + "\n"); });
}

}  // namespace tubetwin
