#pragma once

#include <optional>
#include <string>

#include "models/base/cloud/cloud.h"

namespace tubetwin {

/// What shows that a cloud in S is no scan, or nothing: it is not organised, or more than one in a
/// thousand of its points lie behind the camera or over 20 m away, where no scanner measures. A
/// cloud without any valid point is a scan that saw nothing.
std::optional<std::string> NoScan(const OrganizedCloud& cloud);

}  // namespace tubetwin
