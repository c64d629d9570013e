#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <string>

#include "hw_bridge/base/config.h"
#include "hw_bridge/cell/devices.h"
#include "hw_bridge/emulators/scanner_emulator.h"

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
class ScannerFolderEmulator : public ScannerEmulator {
 public:
  /// `scanner` must outlive it. Throws Error(kCannotCreate) when the folder cannot be made or
  /// written to.
  ScannerFolderEmulator(Scanner& scanner, const ScannerFolderConfig& config);
  ~ScannerFolderEmulator() override;

  void Tick(TimeNs now) override;

  const std::string& path() const { return config_.path; }

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

  TimeNs next_poll_{0};
  std::uint64_t number_ = 0;  ///< Of the trigger that is served.
  ScanFaults::Ordered fault_;
  bool scanning_ = false;
  std::future<Written> writing_;
  std::optional<std::string> hidden_;  ///< Waits to be published.
  TimeNs publish_at_{0};

  std::deque<std::string> published_;
};

}  // namespace tubetwin
