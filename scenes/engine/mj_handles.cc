#include "scenes/engine/mj_handles.h"

#include "models/base/error.h"
#include "scenes/engine/engine_error.h"

namespace tubetwin {

MjSpec MakeSpec(const EngineOptions& options) {
  InitEngine();
  MjSpec spec(mj_makeSpec());
  spec->compiler.degree = false;
  // One thread: callers that want more run several scenes at once.
  spec->compiler.usethread = false;
  mjOption& option = spec->option;
  option.timestep = options.timestep_s;
  option.impratio = options.impratio;
  option.iterations = options.iterations;
  option.tolerance = 1e-8;
  option.integrator = mjINT_DISCRETE;
  option.cone = mjCONE_ELLIPTIC;
  option.solver = mjSOL_NEWTON;
  // The engine would go dense below 60 degrees of freedom; a pile of seven tubes is twice as fast
  // so.
  option.jacobian = mjJAC_SPARSE;
  option.disableflags |= mjDSBL_AUTORESET;
  for (int k = 0; k < 3; ++k) option.gravity[k] = -kGravity * options.up[k];
  spec->memory = 16 << 20;  // High-water of twenty tubes is below 2 MB.
  return spec;
}

MjModel Compile(mjSpec& spec, const std::string& what) {
  mjModel* model = nullptr;
  GuardEngine([&] { model = mj_compile(&spec, nullptr); });
  if (model == nullptr) {
    throw Error(ErrorKind::kInternal,
                what + ": the scene does not compile: " + mjs_getError(&spec));
  }
  return MjModel(model);
}

MjData MakeData(const mjModel& model) {
  mjData* data = nullptr;
  GuardEngine([&] { data = mj_makeData(&model); });
  if (data == nullptr) throw Error(ErrorKind::kInternal, "MuJoCo: no memory for a scene's data");
  MjData owner(data);
  GuardEngine([&] { mj_forward(&model, data); });
  return owner;
}

int IdOf(const mjModel& model, mjtObj type, const std::string& name) {
  const int id = mj_name2id(&model, type, name.c_str());
  if (id < 0) throw LogicError("the model has no element named '" + name + "'");
  return id;
}

void SetName(mjsElement* element, const std::string& name) {
  if (mjs_setName(element, name.c_str()) != 0) {
    throw Error(ErrorKind::kInternal, "MuJoCo refuses the element name '" + name + "'");
  }
}

void SetString(mjString* field, const std::string& text) { mjs_setString(field, text.c_str()); }

void SetPose(const RigidTransform& X_PB, double pos[3], double quat[4]) {
  const std::array<double, 4> q = QuaternionWxyz(X_PB.linear());
  for (int k = 0; k < 3; ++k) pos[k] = X_PB.translation()[k];
  for (int k = 0; k < 4; ++k) quat[k] = q[k];
}

RigidTransform BodyPose(const mjData& data, int body) {
  Matrix3 R;
  for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = data.xmat[9 * body + i];
  return MakeTransform(R, Vector3(data.xpos + 3 * body));
}

}  // namespace tubetwin
