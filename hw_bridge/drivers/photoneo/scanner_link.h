#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hw_bridge/drivers/photoneo/threaded_scanner.h"
#include "models/base/config/config.h"

namespace tubetwin {

/// How to reach the scanner: `[cell.scanner]` of a cell file.
struct ScannerLinkConfig {
  /// "folder" (FolderScanner) or "gige" (GigeScanner): the cell file's key, not visited here.
  std::string driver = "folder";
  std::string host = "192.168.1.27";  ///< gige: the scanner's IPv4 address.
  std::string path;                   ///< folder: where triggers and scans are exchanged.
  double timeout_s = 10.0;            ///< From a trigger to its whole scan, cell time.
  /// Cell time per wall time: of the whole cell, so the cell file's own key and not visited here.
  double rate = 1.0;
  /// Points of the largest scan of the cell's scanner, not visited here: a file of more than four
  /// times as many is refused before it takes memory.
  std::uint64_t max_points = 2064 * 1544;

  void Visit(ConfigVisitor& v);
  /// Throws Error(kConfig) for what the fields' own ranges cannot say.
  void ValidateOrThrow() const;
};

/// The scanner that `config` names, ready to be triggered. Throws Error(kConfig), and
/// Error(kDevice) naming device, place and what was awaited when it cannot be reached within 8 s.
std::unique_ptr<Scanner> ConnectScanner(const ScannerLinkConfig& config, ScannerPose believed_X_NS);

}  // namespace tubetwin
