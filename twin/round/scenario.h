#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/config/config.h"
#include "models/cell_model.h"
#include "models/physics.h"
#include "planner/cycle/pick_cycle.h"
#include "planner/evaluator/evaluator.h"
#include "scenes/pile.h"
#include "twin/render/recording.h"
#include "twin/render/scan/scan_geometry.h"
#include "twin/round/cell_config.h"
#include "twin/round/records/tolerance.h"

namespace tubetwin {

/// One round, completely: what lies in the bin, what the cell is like, how the pipeline works.
/// Defaults < files < overrides; the resolved scenario is archived beside the results.
struct Scenario {
  std::int64_t seed = 1;
  std::string profile = "best";

  struct PileConfig {
    std::string file;  ///< Empty: generate. Relative to the scenario file.
    std::string part;  ///< Empty: what the file says, else pvc_a.
    int count = 7;
    std::string arrangement = "dropped";
    void Visit(ConfigVisitor& v);
  } pile;

  struct BinConfig {
    std::vector<double> size_m;  ///< Empty: what the pile file says, else the cell model's.
    std::string mesh;            ///< Gives size_m, and the bin's looks in pictures; empty: none.
    std::string mesh_units;      ///< As ScaleToMetres takes it.
    /// x, y, z in metres, yaw in degrees; empty: the cell model's.
    std::vector<double> X_BN;
    void Visit(ConfigVisitor& v);
  } bin;

  PhysicsRanges physics;
  ScanConfig scan;
  PerceptionConfig perception;
  PlannerConfig planner;
  EvaluatorConfig evaluator;
  ResolutionConfig resolution;
  CycleConfig cycle;
  PlacementTolerance success;  ///< What `in_tolerance` means.

  /// The cell's own, where no pile says them: what lies in the bin, where tools hang, how fast the
  /// devices' clocks run against the wall's (emulated ones).
  struct PartConfig {
    std::string name;  ///< Part name or file; empty: what [pile] says.
    void Visit(ConfigVisitor& v);
  } part;
  CalibrationConfig calibration;
  /// No layer said where the scanner is: the cell model's figure. Not a key.
  bool nominal_scanner_pose = false;
  double rate = 1.0;
  CellConfig cell;

  void Visit(ConfigVisitor& v);
};

/// Name or file of the part where no pile file says it: of [pile], else [part], else "pvc_a".
std::string ScenarioPartName(const Scenario& scenario);

/// The scenario's cell model with its calibration and the place of its bin. Throws as LoadCellModel
/// does, and Error(kConfig) for calibration that does not fit it.
CellModel ScenarioModel(const Scenario& scenario);

/// What stops the arm of the scenario's cell, at its rate; a real arm starts at reduced speed.
SafetyLimits ScenarioSafety(const Scenario& scenario);

/// Throws Error(kConfig) naming `who` unless every device is the twin's: only there is truth.
void RequireTwin(const Scenario& scenario, const std::string& who);

/// The physics of the scenario's round for a part: nominal, or drawn.
RoundPhysics ScenarioPhysics(const Scenario& scenario, const Part& part);

/// How the scenario's scanner sees, without labels, for a round with that physics.
ScanSettings ScenarioScan(const Scenario& scenario, const CellModel& model,
                          const RoundPhysics& physics);

/// The pick cycle of the scenario for a part in a cell.
PickCycleSetup ScenarioCycle(const Scenario& scenario, const CellModel& model, const Part& part,
                             Parallelism parallelism);

/// Names of the pipeline's profiles.
const std::vector<std::string>& PipelineProfiles();

/// The scenario of the layers over the defaults of its profile. "leao2020" sets, unless a layer
/// says otherwise: that modelling, classes by occluded joints, one roll-out per motion with the
/// paper's cost alone, no ranks of doubt, tilting once by +45 degrees. `profile` overrides what the
/// layers say; empty: it does not. Throws as ConfigSource::ReadInto.
Scenario ReadScenario(const ConfigSource& source, const std::string& profile = "");

/// The bin of the scenario for a pile that says `pile_size_m`; the cell model's where none does.
/// Throws Error(kConfig) when both size and mesh are
/// given, Error(kBadData) saying why a mesh is no bin, and as ReadMesh does.
Bin ScenarioBin(const Scenario& scenario, const std::optional<std::array<double, 3>>& pile_size_m);

/// The scenario's meshes for pictures. Throws as ScenarioBin does, and Error(kConfig) for more
/// meshes than the arm has links.
std::vector<Recording::Visual> ScenarioVisuals(const Scenario& scenario);

/// What the scenario says of part and bin in place of a pile's file. Throws as ScenarioBin does.
PileOverrides AskedOverrides(const Scenario& scenario);

/// The pile of `scenario.pile.file` as it is, with the scenario's part and bin. Precondition: a
/// file is given. Throws as LoadPile does.
Pile AskedPile(const Scenario& scenario);

/// The pile that the scenario asks for, not yet settled when it comes from a file; generated ones
/// are. Throws as LoadPile and GeneratePile do, and
/// Error(kBadData) when no settled pile could be generated.
Pile ScenarioPile(const Scenario& scenario);

}  // namespace tubetwin
