#include "models/base/disk/build_id.h"

#include "models/base/files.h"

namespace tubetwin {

const std::string& BuildId() {
  static const std::string id = Fingerprint(ReadFile("/proc/self/exe"));
  return id;
}

}  // namespace tubetwin
