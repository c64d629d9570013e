#include "twin/round/scenario.h"

#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/mesh/bin_mesh.h"
#include "models/mesh/mesh.h"

namespace tubetwin {
namespace {

std::vector<std::string> MeshUnitChoices() {
  std::vector<std::string> units = LengthUnits();
  units.insert(units.begin(), "");
  return units;
}

RigidTransform PoseOfBin(const std::vector<double>& x) {
  return MakeTransform(RotZ(Radians(x[3])), Vector3(x[0], x[1], x[2]));
}

std::vector<double> PoseNumbers(const RigidTransform& X) {
  const Vector3& p = X.translation();
  const auto q = QuaternionWxyz(X.linear());
  return {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]};
}

/// What the configuration leaves to the cell model, so that the resolved one says it.
void FillFromModel(Scenario& scenario) {
  const CalibrationConfig& given = scenario.calibration;
  const bool scanner = !given.X_FS.empty() || !given.X_BS.empty();
  if (scanner && !given.X_FK.empty() && !given.X_FE.empty() && !scenario.bin.X_BN.empty() &&
      !scenario.scan.resolution.empty()) {
    return;  // As a resolved configuration is: a recording's cell file need not be there.
  }
  const CellModel model = LoadCellModel(scenario.cell.model);
  const CellLayout& layout = model.layout;
  const auto fill = [](std::vector<double>& x, const std::vector<double>& from) {
    if (x.empty()) x = from;
  };
  CalibrationConfig& calibration = scenario.calibration;
  fill(calibration.X_FK, PoseNumbers(layout.X_FK));
  fill(calibration.X_FE, PoseNumbers(layout.X_FE));
  const bool flange = layout.scanner_mount == CellLayout::ScannerMount::kFlange;
  scenario.nominal_scanner_pose = calibration.X_FS.empty() && calibration.X_BS.empty();
  if (flange && calibration.X_BS.empty()) fill(calibration.X_FS, PoseNumbers(layout.X_FS));
  if (!flange && calibration.X_FS.empty()) fill(calibration.X_BS, PoseNumbers(layout.X_BS));
  const Vector3& p_BN = layout.X_BN.translation();
  const double yaw_rad = std::atan2(layout.X_BN.linear()(1, 0), layout.X_BN.linear()(0, 0));
  fill(scenario.bin.X_BN, {p_BN.x(), p_BN.y(), p_BN.z(), Degrees(yaw_rad)});
  if (scenario.scan.resolution.empty()) {
    scenario.scan.resolution = model.scanner.resolutions.front();
  }
}

struct BinMesh {
  Mesh mesh;  ///< Metres.
  MeshBin found;
};

BinMesh BinOfMesh(const Scenario& scenario) {
  const std::string& path = scenario.bin.mesh;
  BinMesh bin;
  bin.mesh = ReadMesh(path);
  ScaleToMetres(bin.mesh, scenario.bin.mesh_units, path, "bin.mesh_units");
  bin.found = FindBinOfMesh(bin.mesh);
  if (bin.found.verdict != BinVerdict::kBin) {
    throw Error(ErrorKind::kBadData, path + ": this is no bin for the cell: " + bin.found.reason);
  }
  return bin;
}

}  // namespace

void Scenario::PileConfig::Visit(ConfigVisitor& v) {
  v.File("file",
         "pile to start from (pile.json, CSV or the public set's text), or a moment that "
         "cycle.end_at_several stored; in campaigns a folder of them too, one for each round; "
         "empty: generate",
         file);
  v.NameOrFile("part", "part name or part file; empty: what the pile file says, else pvc_a", part);
  v.Field("count", "tubes to generate", count, {1, 40});
  v.Choice("arrangement", "how generated tubes are laid", arrangement,
           {"dropped", "stirred", "threaded"});
}

void Scenario::BinConfig::Visit(ConfigVisitor& v) {
  v.Field("size_m", "long, short, wall height in metres; empty: the pile's, else the cell model's",
          size_m, 0, {0.01, 3.0});
  v.File("mesh", "STL, OBJ or PLY of the bin, z upwards: gives size_m and looks", mesh);
  v.Choice("mesh_units", "unit of the mesh; empty: metres", mesh_units, MeshUnitChoices());
  v.NumbersOrNone("X_BN",
                  "floor centre x y z in metres and yaw in degrees, in the robot's base; empty: "
                  "the cell model's",
                  X_BN, 4);
}

void Scenario::PartConfig::Visit(ConfigVisitor& v) {
  v.NameOrFile("name",
               "what lies in the bin of this cell: part name or part file; [pile] part wins", name);
}

void Scenario::Visit(ConfigVisitor& v) {
  v.Field("seed", "seed of everything random in the round", seed, {0, 9007199254740991.0});
  v.Choice("profile", "pipeline profile", profile, PipelineProfiles());
  v.Section("pile", "what lies in the bin", pile);
  v.Section("bin", "the bin", bin);
  v.Section("physics", "ranges that the round's physics is drawn from", physics);
  v.Section("scan", "looking into the bin", scan);
  v.Section("perception", "modelling tubes", perception);
  v.Section("planner", "motions, grasps, choice", planner);
  v.Section("evaluator", "physics roll-outs inside the planner", evaluator);
  v.Section("resolution", "when several tubes hang in the fingers", resolution);
  v.Section("cycle", "speeds, forces and waits of the pick cycle", cycle);
  v.Section("success", "how well a placed tube must lie to count as in_tolerance", success);
  v.Section("part", "the part, for cell files", part);
  v.Section("calibration", "how the tools hang on the flange", calibration);
  v.Field("rate", "how many times as fast as the wall's the devices' clocks run (emulated ones)",
          rate, {0.01, 100});
  v.Section("cell", "which devices", cell);
}

std::string ScenarioPartName(const Scenario& scenario) {
  if (!scenario.pile.part.empty()) return scenario.pile.part;
  return scenario.part.name.empty() ? "pvc_a" : scenario.part.name;
}

CellModel ScenarioModel(const Scenario& scenario) {
  CellModel model = LoadCellModel(scenario.cell.model);
  scenario.calibration.ApplyTo(model.layout);
  if (!scenario.bin.X_BN.empty()) model.layout.X_BN = PoseOfBin(scenario.bin.X_BN);
  return model;
}

SafetyLimits ScenarioSafety(const Scenario& scenario) {
  SafetyLimits safety = scenario.cell.safety.AtRate(scenario.rate);
  if (scenario.cell.arm.IsDevice()) {
    safety.start_speed_m_s = scenario.cell.arm.start_speed_m_s;
  }
  return safety;
}

void RequireTwin(const Scenario& scenario, const std::string& who) {
  if (scenario.cell.IsTwin()) return;
  throw Error(ErrorKind::kConfig, "cell: " + who + " needs the twin's four devices; found arm '" +
                                      scenario.cell.arm.driver + "', gripper '" +
                                      scenario.cell.gripper.driver + "', wrist '" +
                                      scenario.cell.wrist.driver + "', scanner '" +
                                      scenario.cell.scanner.driver + "'");
}

RoundPhysics ScenarioPhysics(const Scenario& scenario, const Part& part) {
  if (!scenario.physics.randomize) return NominalPhysics(part);
  PhysicsRanges ranges = scenario.physics;
  ranges.hand_eye_error_m *= scenario.cell.scanner.hand_eye_error;
  ranges.hand_eye_error_deg *= scenario.cell.scanner.hand_eye_error;
  return DrawPhysics(ranges, part,
                     RandomStream(static_cast<std::uint64_t>(scenario.seed), 0, "physics"));
}

ScanSettings ScenarioScan(const Scenario& scenario, const CellModel& model,
                          const RoundPhysics& physics) {
  ScanSettings settings;
  const ScanSize size = SizeOfScan(model.scanner, scenario.scan.resolution);
  settings.width = size.width;
  settings.height = size.height;
  settings.spec = model.scanner;
  settings.effects = scenario.cell.scanner.effects;
  settings.noise_scale = physics.depth_noise_scale;
  settings.bias_seed = static_cast<std::uint64_t>(scenario.seed);
  return settings;
}

PickCycleSetup ScenarioCycle(const Scenario& scenario, const CellModel& model, const Part& part,
                             Parallelism parallelism) {
  PickCycleSetup setup;
  setup.part = part;
  setup.perception = scenario.perception;
  setup.planner = scenario.planner;
  setup.scan = scenario.scan;
  setup.resolution = scenario.resolution;
  setup.cycle = scenario.cycle;
  setup.seed = static_cast<std::uint64_t>(scenario.seed);
  setup.evaluate = MakeEvaluator({parallelism, scenario.evaluator, MakeGripperGeometry(model)});
  setup.parallelism = parallelism;
  return setup;
}

const std::vector<std::string>& PipelineProfiles() {
  static const std::vector<std::string> names = {"best", "leao2020"};
  return names;
}

Scenario ReadScenario(const ConfigSource& source, const std::string& profile) {
  Scenario asked;
  source.ReadInto(asked);
  Scenario scenario;
  const std::string& chosen = profile.empty() ? asked.profile : profile;
  if (chosen == "leao2020") {
    scenario.perception.profile = "leao2020";
    PlannerConfig& planner = scenario.planner;
    planner.classes = "occluded_joints";
    planner.motions = {"up", "escape"};  // The paper's own candidates.
    planner.escape_const_m = 0.03;
    planner.samples = 1;
    planner.separated = 0;
    planner.max_simulated_s = 1e6;
    planner.max_candidates = 1000;  // All weakly occluded tubes are simulated before the choice.
    planner.weight_clearance = planner.weight_confidence = planner.weight_extra = 0.0;
    planner.weight_release = 0.0;
    planner.min_length_share = planner.min_confidence = 0.0;
    planner.nudges = 0;
    scenario.evaluator.give_up_m = planner.max_displacement_m;  // Where the paper's cost ends.
    scenario.resolution.strategy = "plus45";
  }
  source.ReadInto(scenario);
  if (chosen == "leao2020" && scenario.planner.nudges > 0) {
    throw Error(ErrorKind::kConfig,
                "planner.nudges is " + std::to_string(scenario.planner.nudges) +
                    "; only 0 is allowed in the profile leao2020: the paper pushes no tube");
  }
  scenario.profile = chosen;
  FillFromModel(scenario);
  return scenario;
}

Bin ScenarioBin(const Scenario& scenario, const std::optional<std::array<double, 3>>& pile_size_m) {
  const CellLayout layout = LoadCellModel(scenario.cell.model).layout;
  Bin bin;
  bin.size_m = pile_size_m.value_or(layout.bin_size_m);
  if (!scenario.bin.size_m.empty()) {
    if (scenario.bin.size_m.size() != 3) {
      throw Error(ErrorKind::kConfig,
                  "bin.size_m: three numbers are needed (long, short, wall), found " +
                      std::to_string(scenario.bin.size_m.size()));
    }
    for (int i = 0; i < 3; ++i) bin.size_m[i] = scenario.bin.size_m[i];
  }
  if (!scenario.bin.mesh.empty()) {
    if (!scenario.bin.size_m.empty()) {
      throw Error(ErrorKind::kConfig,
                  "bin.size_m and bin.mesh are both given; the mesh says the size: leave one out");
    }
    bin.size_m = BinOfMesh(scenario).found.size_m;
  }
  bin.X_BN = scenario.bin.X_BN.empty() ? layout.X_BN : PoseOfBin(scenario.bin.X_BN);
  return bin;
}

std::vector<Recording::Visual> ScenarioVisuals(const Scenario& scenario) {
  std::vector<Recording::Visual> visuals;
  if (!scenario.bin.mesh.empty()) {
    BinMesh bin = BinOfMesh(scenario);
    const RigidTransform X_BM = ScenarioBin(scenario, std::nullopt).X_BN * bin.found.X_MN.inverse();
    for (Vector3& v : bin.mesh.vertices) v = X_BM * v;
    visuals.push_back({"world", {"bin_floor", "bin_wall_"}, std::move(bin.mesh)});
  }
  const auto& arm = scenario.cell.arm;
  if (arm.visual_meshes.size() > kNumJoints + 1) {
    throw Error(ErrorKind::kConfig,
                "cell.arm.visual_meshes: " + std::to_string(arm.visual_meshes.size()) +
                    " meshes are given; the arm has a base and 6 links");
  }
  for (std::size_t i = 0; i < arm.visual_meshes.size(); ++i) {
    if (arm.visual_meshes[i].empty()) continue;
    const std::string& path = arm.visual_meshes[i];
    Mesh mesh = ReadMesh(path);
    ScaleToMetres(mesh, arm.visual_units, path, "cell.arm.visual_units");
    // What is mounted on the flange stays.
    visuals.push_back({i == 0 ? "arm_base" : "arm_link" + std::to_string(i),
                       {i == kNumJoints ? "arm_flange" : "arm_"},
                       std::move(mesh)});
  }
  return visuals;
}

PileOverrides AskedOverrides(const Scenario& scenario) {
  PileOverrides overrides;
  if (!scenario.pile.part.empty() || !scenario.part.name.empty()) {
    overrides.part = ScenarioPartName(scenario);
  }
  if (!scenario.bin.size_m.empty() || !scenario.bin.mesh.empty()) {
    overrides.bin_size_m = ScenarioBin(scenario, std::nullopt).size_m;
  }
  return overrides;
}

Pile AskedPile(const Scenario& scenario) {
  Pile pile = LoadPile(scenario.pile.file, AskedOverrides(scenario));
  pile.bin = ScenarioBin(scenario, pile.bin.size_m);
  return pile;
}

Pile ScenarioPile(const Scenario& scenario) {
  if (!scenario.pile.file.empty()) return AskedPile(scenario);
  const Part part = LoadPart(ScenarioPartName(scenario));
  const Bin bin = ScenarioBin(scenario, std::nullopt);
  const RoundPhysics physics = ScenarioPhysics(scenario, part);
  SettleResult made = GeneratePile(part, bin, scenario.pile.count, scenario.pile.arrangement,
                                   static_cast<std::uint64_t>(scenario.seed), physics);
  if (made.status != SettleStatus::kSettled) {
    throw Error(ErrorKind::kBadData,
                "no settled pile could be generated of " + std::to_string(scenario.pile.count) +
                    " " + part.name + ", " + scenario.pile.arrangement + ": " +
                    ToString(made.status) + ", " + made.reason +
                    "; allowed: what comes to rest in the bin (fewer tubes, a larger bin)");
  }
  return std::move(made.pile);
}

}  // namespace tubetwin
