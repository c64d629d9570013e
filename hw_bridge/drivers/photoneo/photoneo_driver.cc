#include "hw_bridge/drivers/photoneo/photoneo_driver.h"

#include <algorithm>
#include <filesystem>

namespace tubetwin {

std::unique_ptr<DeviceDriver<Scanner>> PhotoneoDriver::Clone() const {
  return std::make_unique<PhotoneoDriver>(*this);
}

std::vector<DriverLink> PhotoneoDriver::Links() const {
  return {
      {"folder", "make the folder, or mount the share, that [cell.scanner] path names",
       "its folder can be used"},
      {"gige", "check power, address and [cell.scanner], and that no other program has the scanner",
       "it takes orders"}};
}

std::string PhotoneoDriver::Summary() const {
  return "a Photoneo PhoXi by a folder of saved scans or by GigE Vision";
}

void PhotoneoDriver::Visit(ConfigVisitor& v) { config.Visit(v); }

void PhotoneoDriver::ValidateOrThrow(const std::string& link) const {
  ScannerLinkConfig chosen = config;
  chosen.driver = link;
  chosen.ValidateOrThrow();
}

std::unique_ptr<Scanner> PhotoneoDriver::Connect(const std::string& link,
                                                 const DriverContext& context) const {
  ScannerLinkConfig used = config;
  used.driver = link;
  used.rate = context.rate;
  const ScannerSpec& scanner = context.model.scanner;
  used.max_points = 1;
  for (const std::string& resolution : scanner.resolutions) {
    const ScanSize size = SizeOfScan(scanner, resolution);
    used.max_points = std::max(used.max_points, static_cast<std::uint64_t>(size.width) *
                                                    static_cast<std::uint64_t>(size.height));
  }
  return ConnectScanner(used, context.believed_X_NS);
}

std::string PhotoneoDriver::Owned(const std::string& link) const {
  return link == "gige" ? config.host : std::filesystem::weakly_canonical(config.path).string();
}

}  // namespace tubetwin
