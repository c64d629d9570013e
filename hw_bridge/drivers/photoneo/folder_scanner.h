#pragma once

#include "hw_bridge/drivers/photoneo/scanner_link.h"
#include "hw_bridge/drivers/photoneo/threaded_scanner.h"

namespace tubetwin {

/// A scanner behind a folder of saved scans, local or a network share (names and rules of the
/// files: hw_bridge/codecs/scan_folder.h).
///
/// With a real PhoXi scanner: let PhoXi Control, or a few lines over its API, watch the folder; for
/// each new trigger-N trigger a frame, save it as organised PLY in camera space under a hidden name
/// (.scan-N.ply), rename it to scan-N.ply and delete the trigger. Without such a feed an operator
/// who sees the trigger saves a frame into the folder under any name. `emulate` is such a feed over
/// the twin.
///
/// A trigger is answered by scan-N of its own number, or by the newest cloud that came into the
/// folder after the trigger; scans of other numbers are answers to triggers that were given up. A
/// scan is taken whole: once it can be read, has not changed meanwhile and, under an operator's
/// name, for 0.2 s. The scan fails when the feed refuses it; when a file that cannot be read stays
/// as it is for 1 s (the reason names file and byte or line); when the cloud is no scan (see
/// NoScan); when `timeout_s` passes. A trigger that is given up is removed.
///
/// Polls the folder every 10 ms while a scan runs (shares report no changes), and not otherwise.
class FolderScanner : public ThreadedScanner {
 public:
  /// Throws Error(kDevice) when the path is no folder that files can be made in.
  FolderScanner(const ScannerLinkConfig& config, ScannerPose believed_X_NS);
};

}  // namespace tubetwin
