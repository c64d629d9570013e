#pragma once

#include <string>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// Writes what WritePcd() writes, packed by zstd: `zstd -d` unpacks it, ReadCloud() reads it as it
/// is. `path` ends in ".pcd.zst". Throws Error(kCannotCreate | kIo).
void WritePackedPcd(const OrganizedCloud& cloud, const std::string& path);

}  // namespace tubetwin
