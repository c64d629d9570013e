#pragma once

#include <memory>
#include <string>

#include <mujoco/mujoco.h>

#include "models/base/frames.h"

namespace tubetwin {

struct MjSpecDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
struct MjModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct MjDataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
/// Owners of MuJoCo's C handles; `.get()` only at a call into C. A const mjModel may be shared by
/// threads, an mjData belongs to one.
using MjSpec = std::unique_ptr<mjSpec, MjSpecDeleter>;
using MjModel = std::unique_ptr<mjModel, MjModelDeleter>;
using MjData = std::unique_ptr<mjData, MjDataDeleter>;

/// How a scene is stepped. The defaults are those of a pile by itself.
struct EngineOptions {
  double timestep_s = 0.002;
  double impratio = 10.0;  ///< Friction against normal stiffness of contacts; 100 for grasping.
  int iterations = 100;
  /// Direction of "up"; gravity is kGravity against it.
  Vector3 up = Vector3::UnitZ();
};

/// An empty scene, angles in radians, with `options`: discrete integrator (joint springs and
/// servos implicit), elliptic cone, Newton to 1e-8 on sparse matrices, no automatic reset after
/// divergence. Throws Error(kInternal) for a wrong engine version (InitEngine).
MjSpec MakeSpec(const EngineOptions& options = {});

/// Compiles; `what` names the scene in errors. Throws Error(kInternal) with the compiler's text.
MjModel Compile(mjSpec& spec, const std::string& what);

/// Data at the model's initial state with all derived quantities computed (mj_forward).
MjData MakeData(const mjModel& model);

/// Index of a named element. Throws LogicError when there is none: names are ours.
int IdOf(const mjModel& model, mjtObj type, const std::string& name);

/// Sets a name. Throws Error(kInternal) when it is taken.
void SetName(mjsElement* element, const std::string& name);

/// Sets a text field of a spec element. Never assign to one: the library's std::string is not ours
/// (it carries its own C++ run time), so `*weld->name1 = ...` corrupts memory.
void SetString(mjString* field, const std::string& text);

/// Pose into pos[3], quat[4] (w x y z).
void SetPose(const RigidTransform& X_PB, double pos[3], double quat[4]);

/// Pose of a body's frame in the world as last computed (kinematics of the current qpos only after
/// mj_forward: mj_step leaves it one step behind).
RigidTransform BodyPose(const mjData& data, int body);

}  // namespace tubetwin
