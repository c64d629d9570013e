#include "hw_bridge/drivers/photoneo/scanner_link.h"

#include <utility>

#include "hw_bridge/drivers/photoneo/folder_scanner.h"
#include "hw_bridge/drivers/photoneo/gige_scanner.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {

void ScannerLinkConfig::Visit(ConfigVisitor& v) {
  v.Field("host", "gige: IPv4 address", host);
  v.File("path", "folder: where scans are asked for and saved", path);
  v.Field("timeout_s", "from a trigger to its whole scan", timeout_s, {0.1, 600});
}

void ScannerLinkConfig::ValidateOrThrow() const {
  if (driver == "folder" && path.empty()) {
    throw Error(ErrorKind::kConfig,
                "cell.scanner.path: is empty; the driver 'folder' needs the folder of the scans");
  }
  if (!(rate > 0)) {
    throw Error(ErrorKind::kConfig, "rate is " + Number(rate) + ", allowed are numbers over 0");
  }
}

std::unique_ptr<Scanner> ConnectScanner(const ScannerLinkConfig& config,
                                        ScannerPose believed_X_NS) {
  config.ValidateOrThrow();
  if (config.driver == "gige") {
    return std::make_unique<GigeScanner>(config, std::move(believed_X_NS));
  }
  return std::make_unique<FolderScanner>(config, std::move(believed_X_NS));
}

}  // namespace tubetwin
