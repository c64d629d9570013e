#pragma once

#include <cstdint>
#include <vector>

#include "models/physics.h"
#include "planner/evaluator/evaluator.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/engine/stepping.h"
#include "scenes/tube_body.h"

namespace tubetwin {

/// What differs between samples of one request.
struct SampleDraw {
  double friction = 0.3;
  double bending_stiffness_Nm2 = 0.15;
  std::vector<Vector3> shift_N;  ///< Of every tube.
};

/// Sample 0 is nominal and unshifted.
SampleDraw DrawSample(const Part& part, int tubes, int sample, std::uint64_t seed,
                      const EvaluatorConfig& config);

/// Perceived tubes in a bin with the hand, settled and kept. Frame of the world: N. Immutable after
/// construction, so threads may share it (each with its own model copy and data).
class RolloutScene {
 public:
  static constexpr int kHandAxes = 6;  ///< Slides x y z, then hinges x y z.

  RolloutScene(const TubeScene& scene, const Part& part, const Bin& bin, const SampleDraw& draw,
               const EvaluatorOptions& options);
  /// Tubes as they are, with masses and rest shapes, under one friction and bending stiffness.
  RolloutScene(const std::vector<PileTube>& tubes, const Part& part, const Bin& bin,
               double friction, double bending_stiffness_Nm2, const EvaluatorOptions& options);

  const mjModel& model() const { return *model_; }
  StepStatus status() const { return status_; }  ///< Of settling; the rest holds only when kOk.
  const Snapshot& settled() const { return settled_; }
  const std::vector<TubeBody>& tubes() const { return tubes_; }
  const std::vector<Vector3>& centres_N() const { return centres_N_; }  ///< As settled.
  const std::vector<double>& creep_m_s() const { return creep_m_s_; }   ///< Without any motion.
  const Bin& bin() const { return bin_; }
  double radius_m(int tube) const { return tubes_[tube].initial().radius_m; }

  /// Restores the settled state in `data` and welds the hand to tube `index` at a share of its arc
  /// length, fingers closed on both sides of it; writes weld and contacts into `model`, which is a
  /// copy of model(). Returns where the hand is: origin on the tube's axis, z up, y closing.
  RigidTransform Grip(int index, double share, mjModel& model, mjData& data) const;

  /// Targets of the hand's slides and hinges, the hinges as near as may be to those commanded last.
  /// Precondition: turned about N's y axis, the second hinge, by less than 90 degrees.
  void Command(const Vector3& p_NHand, const Matrix3& R_NHand, mjData& data) const;
  /// Largest of the hand's forces over its limit, 1 when saturated.
  double Load(const mjModel& model, const mjData& data) const;

 private:
  void AddHand(mjSpec& spec, double force_N);
  void AddFingers(mjsBody& hand, const GripperGeometry& gripper, double radius_m, double contact_s);
  void BindHand();
  void Settle();
  void MeasureCreep(mjData& data);

  MjModel model_;
  std::vector<TubeBody> tubes_;
  Bin bin_;
  double pad_width_m_;
  int first_axis_qpos_ = 0, first_actuator_ = 0, first_weld_ = 0, hand_ = 0;
  std::vector<int> weld_offset_;  ///< Index of every tube's first weld.
  StepStatus status_ = StepStatus::kOk;
  Snapshot settled_;
  std::vector<Vector3> centres_N_;
  std::vector<double> creep_m_s_;
};

}  // namespace tubetwin
