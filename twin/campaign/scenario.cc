#include "twin/campaign/scenario.h"

#include <filesystem>

#include "hw_bridge/base/error.h"

namespace tubetwin {

void Scenario::PileChoice::Visit(ConfigVisitor& v) {
  v.Field("file", "pile to start from (pile.json, CSV or the public set's text); empty: generate",
          file);
  v.Field("part", "part name or part file; empty: what the pile file says, else pvc_a", part);
  v.Field("count", "tubes to generate", count, {1, 40});
  v.Choice("arrangement", "how generated tubes are laid", arrangement,
           {"dropped", "stirred", "threaded"});
}

void Scenario::BinChoice::Visit(ConfigVisitor& v) {
  v.Field("size_m", "long, short, wall height in metres; empty: the pile's, else 0.77 0.58 0.09",
          size_m, 0, {0.01, 3.0});
  v.Field("X_BN", "floor centre x y z in metres and yaw in degrees, in the robot's base", X_BN, 4);
}

void Scenario::CellChoice::Device::Visit(ConfigVisitor& v) {
  v.Choice("driver", "which device serves this role", driver, {"twin"});
}

void Scenario::CellChoice::ScannerDevice::Visit(ConfigVisitor& v) {
  Device::Visit(v);
  v.Field("hand_eye_error", "error of the scanner's pose against what [physics] draws; 0: none",
          hand_eye_error, {0, 100});
  effects.Visit(v);
}

void Scenario::CellChoice::Visit(ConfigVisitor& v) {
  v.Section("arm", "the arm", arm);
  v.Section("gripper", "the gripper", gripper);
  v.Section("wrist", "the force/torque sensor", wrist);
  v.Section("scanner", "the scanner", scanner);
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
  v.Section("cell", "which devices", cell);
}

RoundPhysics ScenarioPhysics(const Scenario& scenario, const Part& part) {
  if (!scenario.physics.randomize) return NominalPhysics(part);
  PhysicsRanges ranges = scenario.physics;
  ranges.hand_eye_error_m *= scenario.cell.scanner.hand_eye_error;
  ranges.hand_eye_error_deg *= scenario.cell.scanner.hand_eye_error;
  return DrawPhysics(ranges, part,
                     RandomStream(static_cast<std::uint64_t>(scenario.seed), 0, "physics"));
}

ScanSettings ScenarioScan(const Scenario& scenario, const RoundPhysics& physics) {
  ScanSettings settings;
  if (scenario.scan.resolution == "2064x1544") {
    settings.width = settings.spec.full_width;
    settings.height = settings.spec.full_height;
  }
  settings.effects = scenario.cell.scanner.effects;
  settings.noise_scale = physics.depth_noise_scale;
  settings.bias_seed = static_cast<std::uint64_t>(scenario.seed);
  return settings;
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
    planner.escape_const_m = 0.03;
    planner.samples = 1;
    planner.weight_clearance = planner.weight_confidence = planner.weight_extra = 0.0;
    planner.min_length_share = planner.min_confidence = 0.0;
    scenario.resolution.strategy = "plus45";
  }
  source.ReadInto(scenario);
  scenario.profile = chosen;
  return scenario;
}

Bin ScenarioBin(const Scenario& scenario, const std::array<double, 3>& pile_size_m) {
  Bin bin;
  bin.size_m = pile_size_m;
  if (!scenario.bin.size_m.empty()) {
    if (scenario.bin.size_m.size() != 3) {
      throw Error(ErrorKind::kConfig,
                  "bin.size_m: three numbers are needed (long, short, wall), found " +
                      std::to_string(scenario.bin.size_m.size()));
    }
    for (int i = 0; i < 3; ++i) bin.size_m[i] = scenario.bin.size_m[i];
  }
  const auto& x = scenario.bin.X_BN;
  bin.X_BN = MakeTransform(RotZ(Radians(x[3])), Vector3(x[0], x[1], x[2]));
  return bin;
}

Pile AskedPile(const Scenario& scenario, const std::string& folder) {
  std::filesystem::path file(scenario.pile.file);
  if (file.is_relative()) file = std::filesystem::path(folder) / file;
  PileOverrides overrides;
  if (!scenario.pile.part.empty()) overrides.part = scenario.pile.part;
  if (!scenario.bin.size_m.empty()) overrides.bin_size_m = ScenarioBin(scenario, {}).size_m;
  Pile pile = LoadPile(file.string(), overrides);
  pile.bin = ScenarioBin(scenario, pile.bin.size_m);
  return pile;
}

Pile ScenarioPile(const Scenario& scenario, const std::string& folder) {
  if (!scenario.pile.file.empty()) return AskedPile(scenario, folder);
  const Part part = LoadPart(scenario.pile.part.empty() ? "pvc_a" : scenario.pile.part);
  const Bin bin = ScenarioBin(scenario, Bin().size_m);
  const RoundPhysics physics = ScenarioPhysics(scenario, part);
  SettleResult made = GeneratePile(part, bin, scenario.pile.count, scenario.pile.arrangement,
                                   static_cast<std::uint64_t>(scenario.seed), physics);
  if (made.status != SettleStatus::kSettled) {
    throw Error(ErrorKind::kInternal, std::string("no settled pile could be generated: ") +
                                          ToString(made.status) + ", " + made.reason);
  }
  return std::move(made.pile);
}

}  // namespace tubetwin
