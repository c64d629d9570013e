#pragma once

#include "hw_bridge/drivers/device_driver.h"
#include "hw_bridge/drivers/photoneo/scanner_link.h"

namespace tubetwin {

/// [cell.scanner] driver = "folder" or "gige": see FolderScanner and GigeScanner.
class PhotoneoDriver : public DeviceDriver<Scanner> {
 public:
  ScannerLinkConfig config;

  std::unique_ptr<DeviceDriver> Clone() const override;
  std::vector<DriverLink> Links() const override;
  std::string Summary() const override;
  void Visit(ConfigVisitor& v) override;
  void ValidateOrThrow(const std::string& link) const override;
  std::unique_ptr<Scanner> Connect(const std::string& link,
                                   const DriverContext& context) const override;
  std::string Owned(const std::string& link) const override;
};

}  // namespace tubetwin
