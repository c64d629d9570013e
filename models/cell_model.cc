#include "models/cell_model.h"

namespace tubetwin {
namespace {

constexpr double kBracketHalf_m = 0.005;
constexpr double kBracketHalfWidth_m = 0.035;

Vector3 HousingHalf(const ScannerSpec& spec) {
  return {0.5 * spec.housing_x_m, 0.5 * spec.housing_y_m, 0.5 * spec.housing_z_m};
}

/// Camera and projector look out of the housing's front, which stands askew in S.
RigidTransform HousingCentre(const ScannerSpec& spec, const RigidTransform& X_AS) {
  return X_AS * HousingPose(spec) * Translation(0, 0, -HousingHalf(spec).z());
}

void AddScannerOnFlange(std::vector<Shape>& shapes, const CellModel& model) {
  const Vector3 half = HousingHalf(model.scanner);
  const RigidTransform& X_FS = model.layout.X_FS;
  shapes.push_back(
      {Shape::Kind::kBox, "scanner", kFlangeBody, HousingCentre(model.scanner, X_FS), half, true});
  // A plate under the flange carries it: from the tool's axis to the near side of the housing.
  const Vector3 p_FS = X_FS.translation();
  const double reach_m = p_FS.y() - half.y();
  if (reach_m <= 0.0) return;  // The housing is at the axis itself.
  shapes.push_back({Shape::Kind::kBox, "scanner bracket", kFlangeBody,
                    Translation(0, 0.5 * reach_m, kBracketHalf_m),
                    Vector3(kBracketHalfWidth_m, 0.5 * reach_m, kBracketHalf_m), true});
}

}  // namespace

RigidTransform PoseOfScanner(const CellModel& model, const JointVector& q) {
  const CellLayout& layout = model.layout;
  if (layout.scanner_mount == CellLayout::ScannerMount::kStand) return layout.X_BS;
  return FlangePose(model.arm, q) * layout.X_FS;
}

std::vector<Shape> ToolShapes(const CellModel& model) {
  std::vector<Shape> shapes;
  const RigidTransform& X_FK = model.layout.X_FK;
  const double sensor_m = X_FK.translation().z();
  shapes.push_back({Shape::Kind::kCylinder, "force sensor", kFlangeBody,
                    Translation(0, 0, 0.5 * sensor_m),
                    Vector3(model.wrist.radius_m, 0.5 * sensor_m, 0), false});
  for (Shape shape : model.gripper.body) {
    shape.X_LinkShape = X_FK * shape.X_LinkShape;
    shapes.push_back(std::move(shape));
  }
  if (model.layout.scanner_mount == CellLayout::ScannerMount::kFlange) {
    AddScannerOnFlange(shapes, model);
  }
  return shapes;
}

std::vector<Shape> MovingShapes(const CellModel& model) {
  std::vector<Shape> shapes = model.arm.shapes;
  for (Shape& shape : ToolShapes(model)) shapes.push_back(std::move(shape));
  return shapes;
}

std::vector<Shape> StandingShapes(const CellModel& model) {
  std::vector<Shape> shapes;
  if (model.layout.scanner_mount == CellLayout::ScannerMount::kStand) {
    shapes.push_back({Shape::Kind::kBox, "scanner", 0,
                      HousingCentre(model.scanner, model.layout.X_BS), HousingHalf(model.scanner),
                      true});
  }
  for (const CellLayout::KeepOut& box : model.layout.keep_out) {
    shapes.push_back({Shape::Kind::kBox, box.name, 0, box.X_BBox, box.half_m, false});
  }
  return shapes;
}

}  // namespace tubetwin
