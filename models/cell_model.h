#pragma once

#include <string>
#include <vector>

#include "models/arm/arm.h"
#include "models/bin.h"
#include "models/gripper_spec.h"
#include "models/layout.h"
#include "models/model_file.h"
#include "models/scanner_spec.h"
#include "models/shape.h"
#include "models/wrist_spec.h"

namespace tubetwin {

/// The files of a cell model: texts of them are a cell again anywhere (ReadCellModel).
struct CellFiles {
  ModelFile cell, arm, gripper, wrist, scanner;
};

/// Tubes of at least this radius are looked at alike; thinner ones hide in narrower shadows.
inline constexpr double kThinnestUsual_m = 0.010;

/// A robotic cell as data: which arm, gripper, wrist sensor and scanner, and where they stand. Read
/// from a cell file (models/cells) that names one file for each device; passed explicitly, never a
/// global. What says how to talk to the devices is not part of it.
struct CellModel {
  std::string name;
  ArmModel arm;
  GripperSpec gripper;
  WristSpec wrist;
  ScannerSpec scanner;
  CellLayout layout;

  CellFiles files;  ///< That it was read from.
};

/// A shipped cell by name ("leao2020"), or a cell file when `name_or_path` ends in ".toml"; device
/// files that it names are relative to it. Throws Error(kMissing) naming the nearest,
/// Error(kConfig) with file:line:column.
CellModel LoadCellModel(const std::string& name_or_path);

/// The cell of such files; device names within the cell's file are not looked at. Throws
/// Error(kConfig) as LoadCellModel does.
CellModel ReadCellModel(const CellFiles& files);

/// Names of the cells that ship with the program, sorted.
std::vector<std::string> CellModelNames();

/// Pose of the scanner's camera in B, calibrated, when the arm's joints are at q.
RigidTransform PoseOfScanner(const CellModel& model, const JointVector& q);

/// Tools on the flange (sensor, gripper without its fingers, scanner and its bracket), in F.
std::vector<Shape> ToolShapes(const CellModel& model);

/// Everything that hangs on base, links and flange; see Shape::link.
std::vector<Shape> MovingShapes(const CellModel& model);

/// Housing of a scanner on a stand and the keep-out boxes, in B.
std::vector<Shape> StandingShapes(const CellModel& model);

/// The views that model the bin, in the order in which they are taken: the camera's poses in B. On
/// a stand there is one. On the flange: those of the layout, or else views straight down, the long
/// side of the image along B's x, that cover the bin. Where the projector would stand beyond a wall
/// so high that its shadow could hide a tube, the scanner looks from inside that wall, tilted
/// outward. Tubes of `radius_m` are to be seen.
std::vector<RigidTransform> ScanPosesOf(const CellModel& model, const Bin& bin,
                                        double radius_m = kThinnestUsual_m);

}  // namespace tubetwin
