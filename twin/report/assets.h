#pragma once

#include <string_view>

namespace tubetwin::report_assets {

/// Texts that reports are made of, embedded when building: our own style and scripts (folder
/// report/), Chart.js and three.js with its orbit controls as Debian ships them.
extern const std::string_view kStyle, kPageScript, kViewerScript;
extern const std::string_view kChartJs, kThreeJs, kOrbitControlsJs, kLicences;

}  // namespace tubetwin::report_assets
