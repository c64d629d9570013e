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
  double friction = 0.3;  ///< Sliding; contacts take the larger of both sides' values.
  double torsion_m = 0.002;
  double bending_stiffness_Nm2 = 0.15;  ///< EI, hoses only.
  double contact_time_s = 0.005;        ///< Time constant of contacts.
  std::array<double, 3> colour_rgb = {0.85, 0.85, 0.82};
};

/// Options of a part's tubes under one round's physics.
TubeBodyOptions MakeTubeBodyOptions(const Part& part, const RoundPhysics& physics,
                                    const RigidTransform& X_WN);

/// One tube in a MuJoCo scene, used by piles, evaluator and twin cell alike.
///
/// Shape: capsules from node to node of the centerline, so the material reaches one radius beyond
/// its first and last node, and `Length(centerline)` is the tube's length. Rigid tube: one body
/// `NAME` with a free joint, its frame at the centre of mass along the principal axes. Hose: one
/// body `NAME_i` per link, the middle one free, each other hinged about two axes to its neighbour
/// towards the middle (no twist). The scene starts in the shape of `centerline_N`, while the joint
/// springs pull towards `rest_centerline_N` (how the rest shape is turned about the hose's own axis
/// is not stored: the turn of least bending energy is taken). Stiffness EI / l per joint, damping
/// 0.02 s times that, armature 1e-5 kg m^2: within 6 % of beam theory for 50 mm links. A free joint
/// loses 2e-5 N m s/rad, which ends rolling. Geoms are
/// `NAME_gi`.
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
  void AddCapsule(mjsBody* body, int index, const Vector3& from, const Vector3& to) const;

  std::string name_;
  PileTube tube_;
  TubeBodyOptions options_;
  std::vector<std::string> body_names_;
  std::vector<int> bodies_, geoms_;
  /// Body (index into bodies_) and place in its frame of every node.
  std::vector<Attachment> nodes_;
};

}  // namespace tubetwin
