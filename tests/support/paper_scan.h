#pragma once

#include "tests/support/paper_cell.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin {

/// How the paper's scanner sees by default.
inline ScanSettings PaperScan() {
  ScanSettings settings;
  settings.spec = PaperCell().scanner;
  const ScanSize size = SizeOfScan(settings.spec, "");
  settings.width = size.width;
  settings.height = size.height;
  return settings;
}

}  // namespace tubetwin
