#include "hw_bridge/emulators/photoneo/scan_faults.h"

namespace tubetwin {

void ScanFaults::Order(ScanFault fault, int scans) {
  ordered_ = {fault, 0.0, ""};
  left_ = scans;
}

void ScanFaults::OrderLate(double delay_s, int scans) {
  ordered_ = {ScanFault::kLate, delay_s, ""};
  left_ = scans;
}

void ScanFaults::OrderRefusal(const std::string& reason, int scans) {
  ordered_ = {ScanFault::kRefused, 0.0, reason};
  left_ = scans;
}

ScanFaults::Ordered ScanFaults::Next() {
  if (left_ <= 0) return {};
  --left_;
  return ordered_;
}

void ClearPoints(OrganizedCloud& cloud) {
  for (Eigen::Vector3f& p : cloud.p_SP) p = InvalidPoint();
  for (float& brightness : cloud.intensity) brightness = 0;
}

}  // namespace tubetwin
