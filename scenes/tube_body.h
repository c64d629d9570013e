#pragma once

#include <array>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "models/base/polyline.h"
#include "models/physics.h"
#include "scenes/pile.h"

namespace tubetwin {

/// How a tube is built into a scene: where, and its physics.
struct TubeBodyOptions {
  RigidTransform X_WN = RigidTransform::Identity();  ///< Bin in the scene's world.
  bool hose = false;
  double mass_scale = 1.0;
  /// Sliding, tube on tube: the larger of both sides. What else a tube touches has a higher
  /// priority and its own friction.
  double friction = 0.3;
  double torsion_m = 0.002;
  double bending_stiffness_Nm2 = 0.15;  ///< EI, hoses only.
  double loss_factor = 0.15;            ///< Hoses only.
  double contact_time_s = 0.005;        ///< Time constant of contacts.
  std::array<double, 3> colour_rgb = {0.85, 0.85, 0.82};
};

/// Options of one of a part's tubes under one round's physics.
TubeBodyOptions MakeTubeBodyOptions(const Part& part, const RoundPhysics& physics,
                                    const RigidTransform& X_WN, int tube_id);

/// One tube in a MuJoCo scene, used by piles, evaluator and twin cell alike.
///
/// Shape: capsules along the centerline, with round ends that reach just to its first and last
/// node: `Length(centerline)` is the tube's length from tip to tip. Rigid tube: one body `NAME`
/// with a free joint, its frame at the centre of mass along the principal axes. Hose: one body
/// `NAME_i` per link, the middle one free, each other hinged to its neighbour towards the middle by
/// two bends and a twist. The scene starts in the shape of `centerline_N`, while the joint springs
/// pull towards `rest_centerline_N` (how the links are turned about the hose's own axis is not
/// stored: the turns of least elastic energy are taken). Stiffness EI / l and GJ / l per joint,
/// armature 1e-6 kg m^2; damping in proportion, so that the first free bending mode has half the
/// loss factor as its damping ratio (higher modes have more). A free joint loses 2e-5 N m s/rad,
/// which ends rolling. Geoms are `NAME_gi`.
///
/// Add to a spec, compile, Bind, then read. Const calls are thread safe (one mjData each).
class TubeBody {
 public:
  /// Adds the tube to the world body of `spec`. Preconditions (ValidatePile checks them): at least
  /// two nodes (hoses three), no two neighbours closer than 1 mm, a rest shape with as many nodes.
  TubeBody(mjSpec& spec, const std::string& name, const PileTube& tube,
           const TubeBodyOptions& options);

  /// Looks up the elements of the compiled model; needed before all below.
  void Bind(const mjModel& model);

  /// Centerline with the nodes of the tube it was made from, from the kinematics last computed
  /// (after mj_step call mj_forward first, or it is one step old).
  Polyline Centerline_W(const mjData& data) const;
  Polyline Centerline_N(const mjData& data) const;
  Vector3 CentreOfMass_W(const mjModel& model, const mjData& data) const;
  /// Largest speed of any node beside something that moves at `v_W`, m/s; from the velocities last
  /// computed.
  double MaxSpeed(const mjModel& model, const mjData& data,
                  const Vector3& v_W = Vector3::Zero()) const;

  /// The tube as it lies now: `tube` as given, with a new centerline.
  PileTube Current(const mjData& data) const;

  const PileTube& initial() const { return tube_; }
  const std::string& name() const { return name_; }
  bool is_hose() const { return options_.hose; }
  /// Body names and ids, in order along the tube; one for a rigid tube.
  const std::vector<std::string>& body_names() const { return body_names_; }
  const std::vector<int>& bodies() const { return bodies_; }
  const std::vector<int>& geoms() const { return geoms_; }

  /// Where a point of the axis sits: index into bodies() and place in that body's frame. Needs no
  /// Bind.
  struct Attachment {
    int link = 0;
    Vector3 p_Body = Vector3::Zero();
  };
  Attachment AttachmentAt(double arc_length_m) const;

 private:
  void BuildRigid(mjSpec& spec);
  void BuildHose(mjSpec& spec);
  struct HoseChain;
  /// Adds link i below its neighbour towards the root (-1: it is the root). The link's frame sits
  /// at the node that both share (the root's at its first node), z forward along the tube.
  void AddLink(mjSpec& spec, HoseChain& chain, int i, int parent);
  void AddCapsule(mjsBody* body, int index, const Vector3& from, const Vector3& to);

  std::string name_;
  PileTube tube_;
  TubeBodyOptions options_;
  std::vector<std::string> body_names_, geom_names_;
  std::vector<int> bodies_, geoms_;
  /// Body (index into bodies_) and place in its frame of every node.
  std::vector<Attachment> nodes_;
};

}  // namespace tubetwin
