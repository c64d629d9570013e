#include "twin/cell/cell_world.h"

#include <algorithm>
#include <array>
#include <string>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/json_text.h"
#include "scenes/bin_body.h"
#include "scenes/engine/engine_error.h"
#include "scenes/engine/stepping.h"
#include "scenes/engine/surface.h"
#include "twin/cell/arm_body.h"
#include "twin/cell/contact_bits.h"
#include "twin/cell/gripper_body.h"

namespace tubetwin {
namespace {

constexpr std::array<float, 4> kPlateRgba = {0.55f, 0.56f, 0.58f, 1.0f};
constexpr std::array<float, 4> kHousingRgba = {0.10f, 0.10f, 0.11f, 1.0f};
constexpr std::array<float, 4> kTrayRgba = {0.70f, 0.66f, 0.55f, 1.0f};

constexpr double kPlateThickness_m = 0.02;
/// At rest tubes creep far less than this (impratio 100); what still rolls is faster.
constexpr double kSleepSpeed_m_s = 2e-4;

/// A box of the scene. Its friction wins over that of what touches it.
void AddBox(mjSpec& spec, const std::string& name, const RigidTransform& X_BBox,
            const Vector3& half_m, double friction, const std::array<float, 4>& rgba) {
  mjsGeom* box = mjs_addGeom(mjs_findBody(&spec, "world"), nullptr);
  SetName(box->element, name);
  box->type = mjGEOM_BOX;
  SetPose(X_BBox, box->pos, box->quat);
  for (int k = 0; k < 3; ++k) box->size[k] = half_m[k];
  box->contype = 0;
  box->conaffinity = kSceneAccepts;
  SetSurface(*box, friction, 1, kContactTime_s);
  std::copy(rgba.begin(), rgba.end(), box->rgba);
}

void AddPlate(mjSpec& spec, const CellLayout& layout, double friction) {
  const auto& centre = layout.plate_centre_m;
  const auto& size = layout.plate_size_m;
  AddBox(spec, "plate",
         Translation(centre[0], centre[1], layout.plate_z_m - 0.5 * kPlateThickness_m),
         Vector3(0.5 * size[0], 0.5 * size[1], 0.5 * kPlateThickness_m), friction, kPlateRgba);
}

/// What stands in the cell besides bin and tray.
void AddStanding(mjSpec& spec, const CellModel& model, double friction) {
  for (const Shape& shape : StandingShapes(model)) {
    TT_CHECK(shape.kind == Shape::Kind::kBox);
    AddBox(spec, "standing_" + shape.name, shape.X_LinkShape, shape.size_m, friction,
           shape.scanner ? kHousingRgba : kPlateRgba);
  }
}

/// The bin as piles have it, on a plinth set back so that nothing rests on its edge.
void AddBinOnPlinth(mjSpec& spec, const Bin& bin, double plate_z_m, double friction) {
  BinBodyOptions options;
  options.X_WN = bin.X_BN;
  options.friction = friction;
  AddBin(spec, bin, options);
  for (const char* name :
       {"bin_floor", "bin_wall_x+", "bin_wall_x-", "bin_wall_y+", "bin_wall_y-"}) {
    mjsGeom* geom = mjs_asGeom(mjs_findElement(&spec, mjOBJ_GEOM, name));
    TT_CHECK(geom != nullptr);
    geom->contype = 0;
    geom->conaffinity = kSceneAccepts;
  }
  const double t = Bin::kWallThickness_m;
  const double below_m = bin.X_BN.translation().z() - t - plate_z_m;
  if (below_m <= 0.0) return;
  AddBox(spec, "bin_plinth", bin.X_BN * Translation(0, 0, -t - 0.5 * below_m),
         {0.9 * bin.half_x_m(), 0.9 * bin.half_y_m(), 0.5 * below_m}, friction, kPlateRgba);
}

void AddTray(mjSpec& spec, const CellLayout& layout, double friction) {
  // A solid block from the plate up to the surface.
  const double half_m = 0.5 * layout.tray_size_m;
  const double half_height_m = 0.5 * (layout.X_BT.translation().z() - layout.plate_z_m);
  TT_CHECK(half_height_m > 0.0);
  AddBox(spec, "tray", layout.X_BT * Translation(0, 0, -half_height_m),
         {half_m, half_m, half_height_m}, friction, kTrayRgba);
}

void SetLooks(mjSpec& spec) {
  spec.stat.extent = 1.0;
  spec.stat.center[0] = 0.4;
  spec.stat.center[1] = -0.2;
  spec.stat.center[2] = 0.3;
  spec.visual.global.offwidth = 1280;
  spec.visual.global.offheight = 720;
  spec.visual.map.znear = 0.02f;
  mjsLight* light = mjs_addLight(mjs_findBody(&spec, "world"), nullptr);
  light->type = mjLIGHT_DIRECTIONAL;
  const double direction[3] = {-0.35, 0.25, -0.9}, position[3] = {1.0, -1.0, 2.5};
  std::copy(direction, direction + 3, light->dir);
  std::copy(position, position + 3, light->pos);
}

}  // namespace

JointVector HomePosition(const CellModel& model, const Bin& bin) {
  const CellLayout& layout = model.layout;
  const Vector3 p_BE = bin.X_BN.translation() + Vector3(0, 0, layout.carry_height_m);
  const RigidTransform X_BF = MakeTransform(RotX(kPi), p_BE) * layout.X_FE.inverse();
  const InverseNearResult home = InverseWorking(model.arm, X_BF);
  if (home.status != InverseNearResult::Status::kFound) {
    throw Error(ErrorKind::kConfig,
                "cell: the arm does not reach the middle of the bin at carry height " +
                    std::to_string(layout.carry_height_m) + " m");
  }
  return home.q;
}

CellWorld::CellWorld(const Pile& pile, const CellModel& model, const RoundPhysics& physics)
    : gripper_(model.gripper) {
  EngineOptions options;
  options.timestep_s = Seconds(kControlPeriod);
  options.impratio = 100.0;
  spec_ = MakeSpec(options);
  // Tubes that lie still for 10 ms and touch nothing that moves are left out until something
  // touches them; the arm's tree, with whatever it holds, has motors and never sleeps.
  spec_->option.enableflags |= mjENBL_SLEEP;
  spec_->option.sleep_tolerance = kSleepSpeed_m_s;
  SetLooks(*spec_);
  AddPlate(*spec_, model.layout, physics.tray_friction);
  AddBinOnPlinth(*spec_, pile.bin, model.layout.plate_z_m, physics.bin_friction);
  AddTray(*spec_, model.layout, physics.tray_friction);
  AddStanding(*spec_, model, physics.tray_friction);
  mjsBody& tool = AddArm(*spec_, model);
  AddGripper(*spec_, tool, model, physics);
  for (const PileTube& tube : pile.tubes) {
    tubes_.emplace_back(*spec_, "tube" + std::to_string(tube.id), tube,
                        MakeTubeBodyOptions(pile.part, physics, pile.bin.X_BN, tube.id));
  }

  CompileWithStart(HomePosition(model, pile.bin));
  MapGeoms(pile);
  pad_contacts_.emplace(*model_);
  Refresh();
}

void CellWorld::CompileWithStart(const JointVector& q_home) {
  // The start is a keyframe, so that whoever opens the XML finds it; its size is known only after a
  // first compilation.
  model_ = Compile(*spec_, "the cell");
  std::vector<mjtNum> qpos(model_->qpos0, model_->qpos0 + model_->nq);
  for (int i = 0; i < kNumJoints; ++i) {
    qpos[model_->jnt_qposadr[IdOf(*model_, mjOBJ_JOINT, ArmJointName(i))]] = q_home[i];
  }
  mjsKey* start = mjs_addKey(spec_.get());
  SetName(start->element, "start");
  mjs_setDouble(start->qpos, qpos.data(), static_cast<int>(qpos.size()));
  model_ = Compile(*spec_, "the cell");
  data_ = MakeData(*model_);
  mj_resetDataKeyframe(model_.get(), data_.get(), 0);
}

void CellWorld::Refresh() {
  GuardEngine([&] { mj_forward(model_.get(), data_.get()); });
}

void CellWorld::MapGeoms(const Pile& pile) {
  tube_of_geom_.assign(model_->ngeom, -1);
  for (std::size_t tube = 0; tube < tubes_.size(); ++tube) {
    tubes_[tube].Bind(*model_);
    for (const int geom : tubes_[tube].geoms()) tube_of_geom_[geom] = static_cast<int>(tube);
  }
  tube_albedo_ = static_cast<float>(pile.part.albedo());
  tube_gloss_ = static_cast<float>(pile.part.gloss);
}

void CellWorld::Step() {
  GuardEngine([&] {
    mj_step2(model_.get(), data_.get());
    mj_step1(model_.get(), data_.get());
    pad_contacts_->Correct(*data_);
  });
  ++steps_;
  const StepStatus status = StatusOf(*data_);
  if (status != StepStatus::kOk) {
    throw Error(ErrorKind::kInternal, "the cell's physics is " + std::string(ToString(status)) +
                                          " at " + std::to_string(data_->time) + " s");
  }
}

void CellWorld::WakeAll() {
  std::vector<mjtNum> state(mj_stateSize(model_.get(), mjSTATE_INTEGRATION));
  GuardEngine([&] { mj_getState(model_.get(), data_.get(), state.data(), mjSTATE_INTEGRATION); });
  SetAwake(state);
}

void CellWorld::SetAwake(const std::vector<double>& integration) {
  GuardEngine([&] {
    const auto set = [&] {
      mj_setState(model_.get(), data_.get(), integration.data(), mjSTATE_INTEGRATION);
    };
    mj_resetData(model_.get(), data_.get());
    set();
    mj_forward(model_.get(), data_.get());
    set();  // The forward pass replaced the warm start.
    mj_step1(model_.get(), data_.get());
    pad_contacts_->Correct(*data_);
  });
}

Json CellWorld::State() const {
  std::vector<mjtNum> state(mj_stateSize(model_.get(), mjSTATE_INTEGRATION));
  GuardEngine([&] { mj_getState(model_.get(), data_.get(), state.data(), mjSTATE_INTEGRATION); });
  return Json{{"steps", steps_}, {"world", Fingerprint(Xml())}, {"integration", state}};
}

void CellWorld::RequireSane(const JsonView& integration) const {
  // Far more than any cell reaches; beyond, physics runs on for minutes until it diverges.
  struct Part {
    int of;
    double most;
  };
  std::size_t at = 0;
  for (const Part& part : {Part{mjSTATE_TIME, 1e6}, Part{mjSTATE_QPOS, 100.0},
                           Part{mjSTATE_QVEL, 1e3}, Part{mjSTATE_ACT, 1e6}}) {
    const std::size_t end = at + static_cast<std::size_t>(mj_stateSize(model_.get(), part.of));
    for (; at < end; ++at) integration.Item(at).AsNumber(-part.most, part.most);
  }
  for (; at < integration.Size(); ++at) integration.Item(at).AsNumber(-1e9, 1e9);
}

void CellWorld::Restore(const JsonView& state) {
  const JsonView world = state.Field("world");
  if (world.AsString() != Fingerprint(Xml())) {
    world.Fail("the state belongs to another cell: its pile, physics or program differ");
  }
  const std::vector<double> integration = state.Field("integration").AsNumbers();
  if (static_cast<int>(integration.size()) != mj_stateSize(model_.get(), mjSTATE_INTEGRATION)) {
    state.Fail("the state has another size than the cell's");
  }
  RequireSane(state.Field("integration"));
  SetAwake(integration);
  if (StatusOf(*data_) != StepStatus::kOk) {
    state.Field("integration").Fail("is no state that the cell's physics can go on from");
  }
  steps_ = CountFromJson(state.Field("steps"));
}

ScanGeometry CellWorld::Geometry() const {
  ScanGeometry geometry;
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const mjtNum* R = data_->geom_xmat + 9 * geom;
    const mjtNum* size = model_->geom_size + 3 * geom;
    const Vector3 centre(data_->geom_xpos + 3 * geom);
    const Vector3 axis(R[2], R[5], R[8]);
    const int tube = tube_of_geom_[geom];
    const std::uint32_t label =
        tube >= 0 ? kLabelFirstTube + static_cast<std::uint32_t>(tube) : kLabelCell;
    const float albedo = tube >= 0 ? tube_albedo_ : kCellAlbedo;
    const float gloss = tube >= 0 ? tube_gloss_ : 0.0f;
    const auto capsule = [&](double half_m) {
      geometry.capsules.push_back(
          {centre - half_m * axis, centre + half_m * axis, size[0], label, albedo, gloss});
    };
    switch (model_->geom_type[geom]) {
      case mjGEOM_CAPSULE:
        capsule(size[1]);
        break;
      case mjGEOM_SPHERE:
        capsule(1e-4);  // A ray tracer wants a length.
        break;
      case mjGEOM_CYLINDER:
        // Arm parts seen in passing: round ends instead of flat ones.
        capsule(std::max(1e-4, size[1] - size[0]));
        break;
      case mjGEOM_BOX: {
        Matrix3 R_BBox;
        R_BBox << R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8];
        geometry.boxes.push_back({MakeTransform(R_BBox, centre), Vector3(size[0], size[1], size[2]),
                                  label, albedo, gloss});
        break;
      }
      default:
        TT_CHECK(!"a geom that no ray can hit");
    }
  }
  return geometry;
}

std::string CellWorld::Xml() const {
  std::string xml(1 << 20, '\0');
  std::array<char, 1000> error{};
  int missing = 0;
  for (int tries = 0; tries < 2; ++tries) {
    GuardEngine([&] {
      missing = mj_saveXMLString(spec_.get(), xml.data(), static_cast<int>(xml.size()),
                                 error.data(), static_cast<int>(error.size()));
    });
    if (missing <= 0) break;
    xml.resize(static_cast<std::size_t>(missing) + 1);
  }
  if (missing != 0) {
    throw Error(ErrorKind::kInternal,
                "the cell cannot be written as XML: " + std::string(error.data()));
  }
  xml.resize(xml.find('\0'));
  return xml;
}

}  // namespace tubetwin
