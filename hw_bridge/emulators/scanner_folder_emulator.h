#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <string>

#include "hw_bridge/base/config.h"
#include "hw_bridge/cell/devices.h"
#include "hw_bridge/emulators/emulator.h"
#include "hw_bridge/emulators/link_faults.h"
#include "hw_bridge/emulators/scan_faults.h"

namespace tubetwin {

struct ScannerFolderConfig {
  std::string path;              ///< Created when missing.
  std::string format = "pcd";    ///< "pcd" (exact) or "ply" (as PhoXi saves it, millimetres).
  int keep = 8;                  ///< Answers that stay; older ones of this emulator are removed.
  void Visit(ConfigVisitor& v);  ///< Not the path, which is the cell's.
};

/// The feed of a scan folder (hw_bridge/codecs/scan_folder.h) over any Scanner. A trigger starts a
/// scan; the cloud is written in S, without pose and labels, as a real scanner would. What is left
/// to compute and the writing run on a thread of their own, one scan at a time, so the cell goes on
/// in real time; the destructor waits for them.
class ScannerFolderEmulator : public Emulator {
 public:
  /// `scanner` must outlive it. Throws Error(kCannotCreate) when the folder cannot be made or
  /// written to.
  ScannerFolderEmulator(Scanner& scanner, const ScannerFolderConfig& config);
  ~ScannerFolderEmulator() override;

  void Tick(TimeNs now) override;

  const std::string& path() const { return config_.path; }
  std::uint64_t triggers() const { return triggers_; }  ///< Taken up so far.
  std::uint64_t answers() const { return answers_; }    ///< Clouds and refusals written so far.
  /// The last thing that went wrong on this side (disk full, folder gone); empty: nothing yet.
  const std::string& last_problem() const { return last_problem_; }

  // What fault scripts do.
  ScanFaults& faults() { return faults_; }
  LinkFaults& link() { return link_; }

 private:
  struct Written {
    std::string hidden;   ///< File under its hidden name; empty when it could not be written.
    std::string problem;  ///< Then.
  };
  void TakeTrigger();
  void Start(std::uint64_t number);
  void FollowScan();
  void Write();
  void Publish();
  void Refuse(const std::string& reason);

  Scanner& scanner_;
  ScannerFolderConfig config_;
  ScanFaults faults_;
  LinkFaults link_;

  TimeNs next_poll_{0};
  std::uint64_t number_ = 0;  ///< Of the trigger that is served.
  ScanFaults::Ordered fault_;
  bool scanning_ = false;
  std::future<Written> writing_;
  std::optional<std::string> hidden_;  ///< Waits to be published.
  TimeNs publish_at_{0};

  std::deque<std::string> published_;
  std::uint64_t triggers_ = 0, answers_ = 0;
  std::string last_problem_;
};

}  // namespace tubetwin
