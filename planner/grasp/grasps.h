#pragma once

#include <vector>

#include "models/bin.h"
#include "perception/scene/tube_scene.h"
#include "planner/extraction/candidate_motion.h"
#include "planner/grasp/grasp.h"
#include "planner/grasp/gripper_boxes.h"

namespace tubetwin {

/// What grasps are looked for in; references outlive the call.
struct GraspInput {
  const TubeScene& scene;
  const std::vector<Vector3>& points_N;  ///< VoxelDownsample of the views, or empty.
  const Bin& bin;
  const GripperGeometry& gripper;
  const GraspConfig& config;
  double step_m = 0.01;  ///< Between grasp points along a tube.
};

/// A place where the gripper fits around a tube, whatever the tube does afterwards.
struct GraspSite {
  Grasp grasp;          ///< Its cost is not set yet.
  double height_m = 0;  ///< Of the tube's axis there, over the floor.
};

/// Sites along a tube in the order of arc length, and why the others are none.
struct GraspSites {
  std::vector<GraspSite> sites;
  std::vector<Rejection> rejections;
};

/// Where a gripper fits (Leão et al. 2020, section 3.4.1, with exact distances instead of
/// point counts alone): points every `step_m` along the curve and `grasp_end_m` from its
/// ends, yaw across the tangent (of the two equal yaws the one whose x points along B's x), E at
/// GraspHeightOverAxis. Rejected are steep tangents, places within two radii of a crossing under
/// another tube, and every opening at which fingers, gap or gripper body come within
/// `finger_clearance_m` of another tube, of a farther part of the same tube or of a wall, or at
/// which more than `max_points` thinned measured points lie in the way. Of the openings that fit,
/// the one with the best balance of room inside and outside the fingers is taken, the wider of
/// equals. The tool is vertical. Only where no site of the tube passes, yaws up to 30 degrees off
/// and points 12 mm from the ends are tried too; only where none of these does, tools that lean up
/// to 35 degrees to a side or along a steep tube, E as far back along the tool as the fingers need
/// over the floor. `tube` is one of the scene's.
GraspSites FindGraspSites(const GraspInput& input, const PerceivedTube& tube);

/// The sites that suit a motion, cheapest first, with the paper's cost: height (its sign turned, so
/// that high points are cheap), distance from the true centre of mass, displacement that the
/// evaluator found, and our clearance term. Rejected are sites in the forbidden section and those
/// that would drive the gripper into a wall. `top_m`: height of the highest tube.
struct GraspSet {
  std::vector<Grasp> grasps;
  std::vector<Rejection> rejections;
};
GraspSet RankGrasps(const GraspInput& input, const GraspSites& sites, const PerceivedTube& tube,
                    const CandidateMotion& motion, double displacement_m, double top_m);

}  // namespace tubetwin
