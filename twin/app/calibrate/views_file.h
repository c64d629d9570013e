#pragma once

#include <string>
#include <vector>

#include "models/arm/arm.h"
#include "perception/calibration/calibration.h"

namespace tubetwin {

/// The file that says from where clouds were taken, in a folder given instead of it.
inline constexpr const char* kViewsFile = "views.toml";

/// `folder_or_file` as the file.
std::string ViewsFileOf(const std::string& folder_or_file);

/// Reads the file, `[[view]]` with `cloud` and `joints_deg` or `X_BF`, `[[touch]]` with `on` and
/// `p_BTip`, and the clouds that it names, into `views` and `touches` of `input`. `units`: of the
/// clouds' lengths, empty: what they say. Throws Error(kMissing), Error(kConfig) with
/// file:line:column for keys and values, Error(kBadData) as ReadCloud does.
void ReadViewsFile(const std::string& folder_or_file, const ArmModel& arm, const std::string& units,
                   CalibrationInput& input);

/// Adds a view to the folder's file: the cloud as view_N.pcd and the joints that it was taken at.
/// Returns the cloud's path. The file is made when there is none. Throws as ReadViewsFile and
/// WriteFileAtomically do.
std::string AddView(const std::string& folder, const OrganizedCloud& cloud, const JointVector& q);

/// Adds a touch likewise.
void AddTouch(const std::string& folder, const CalibrationTouch& touch);

}  // namespace tubetwin
