#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/emulators/background_task.h"
#include "hw_bridge/emulators/photoneo/scanner_emulator.h"

namespace tubetwin {

struct ScannerFolderConfig {
  std::string path;            ///< Created when missing.
  std::string format = "pcd";  ///< "pcd" (exact) or "ply" (as PhoXi saves it, millimetres).
  int keep = 8;                ///< Answers that stay; older ones of this emulator are removed.
};

/// The feed of a scan folder (hw_bridge/codecs/scan_folder.h) over any Scanner. A trigger starts a
/// scan; the cloud is written in S, without pose and labels, as a real scanner would. What is left
/// to compute and the writing run on a thread of their own, one scan at a time, so the cell goes on
/// in real time; the destructor waits for them.
class ScannerFolderEmulator : public ScannerEmulator {
 public:
  /// `scanner` must outlive it. Throws Error(kCannotCreate) when the folder cannot be made or
  /// written to.
  ScannerFolderEmulator(Scanner& scanner, const ScannerFolderConfig& config);
  ~ScannerFolderEmulator() override;

  void Tick(TimeNs now) override;

  const std::string& path() const { return config_.path; }

 private:
  /// What the thread of files is about, or was when it is idle again.
  enum class Doing { kNothing, kLooking, kWriting, kPublishing };
  void Do(Doing what, std::function<void()> work);
  void Settle(TimeNs now);
  void LookForTrigger();
  void Start(std::uint64_t number);
  void FollowScan();
  void Write();
  void Publish();
  void Refuse(const std::string& reason);

  Scanner& scanner_;
  ScannerFolderConfig config_;

  TimeNs next_poll_{0};
  std::uint64_t number_ = 0;  ///< Of the trigger that is served.
  ScanFaults::Ordered fault_;
  bool scanning_ = false;
  std::string hidden_;  ///< File that waits to be published; empty: none does.
  TimeNs publish_at_{0};
  std::deque<std::string> published_;

  Doing doing_ = Doing::kNothing;
  // Of the thread of files while it works.
  std::string problem_;
  std::uint64_t found_ = 0;  ///< Newest trigger; 0: none.

  BackgroundTask files_;  ///< Last: ends before what it uses.
};

}  // namespace tubetwin
