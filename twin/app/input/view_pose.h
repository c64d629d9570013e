#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"
#include "perception/view/floor_pose.h"
#include "twin/app/common.h"

namespace tubetwin {

/// A cloud and the file that it came from.
struct ViewOfFile {
  std::string file;
  OrganizedCloud cloud;
};

/// The pose of --pose, X_NS: "tx,ty,tz,qw,qx,qy,qz". Throws Error(kUsage) for another text, for
/// a place no scanner stands at (millimetres) and a quaternion that is none.
RigidTransform ParsePose(const std::string& text);

/// Whether the file says where its scanner was: one that does not know writes nothing, or a turn
/// of the axes alone, and no scanner stands in the middle of the bin's floor.
bool HasPose(const OrganizedCloud& cloud);

/// Fits the views' poses to floor and walls: what --pose floor asks for. The files' own poses only
/// say how the views stand to each other. Throws Error(kBadData) with the files' names and why.
FloorPose UseFloorPose(const Bin& bin, std::vector<ViewOfFile>& views, const Common& common);

/// Gives every view the pose that the user says, which wins over the file's: a note tells what was
/// not used. Throws Error(kUsage) when the files say that the views differ, so that one pose
/// cannot be right for all.
void UseGivenPose(const RigidTransform& X_NS, std::vector<ViewOfFile>& views, const Common& common);

/// Throws Error(kBadData) for a view without a pose, or with one in millimetres.
void RequireOwnPoses(const std::vector<ViewOfFile>& views);

}  // namespace tubetwin
