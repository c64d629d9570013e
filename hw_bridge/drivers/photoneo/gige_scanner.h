#pragma once

#include "hw_bridge/drivers/photoneo/scanner_link.h"
#include "hw_bridge/drivers/photoneo/threaded_scanner.h"

namespace tubetwin {

/// A PhoXi scanner by GigE Vision (firmware 1.13 or newer, no PhoXi Control), at its address only
/// (what that means on the network: GigeCamera).
///
/// A scan is a software trigger and the organised range image that follows: Coord3D_ABC32f in the
/// unit that the scanner names, 0 0 0 where nothing was seen. A frame of which packets got lost is
/// asked for once more, within the same time limit. The scan fails, with the reason, when that one
/// is incomplete too; when the frame is no range image or no scan (see NoScan); when the scanner
/// does not confirm the trigger; when control of it is lost, and from then on always: nothing
/// connects again by itself; when `timeout_s` passes. GigE Vision knows no refusal: a scanner that
/// cannot scan is one that does not answer.
class GigeScanner : public ThreadedScanner {
 public:
  /// Takes control of the scanner within 8 s. Throws Error(kConfig) when the host is no IPv4
  /// address and Error(kDevice) naming device, place and what was awaited.
  GigeScanner(const ScannerLinkConfig& config, ScannerPose believed_X_NS);
};

}  // namespace tubetwin
