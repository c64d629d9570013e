#include "twin/cell/pad_contacts.h"

#include <Eigen/Dense>

#include "scenes/engine/mj_handles.h"
#include "twin/cell/gripper_body.h"

namespace tubetwin {

PadContacts::PadContacts(mjModel& model)
    : model_(model),
      pads_{IdOf(model, mjOBJ_GEOM, kPadLeftGeom), IdOf(model, mjOBJ_GEOM, kPadRightGeom)},
      jacp_(3 * static_cast<std::size_t>(model.nv)),
      jacr_(3 * static_cast<std::size_t>(model.nv)) {
  model.flg_surfacevel = 1;
}

void PadContacts::Correct(mjData& data) {
  using RowMatrix = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Eigen::VectorXd> v(data.qvel, model_.nv);
  const Eigen::Map<const RowMatrix> Jp(jacp_.data(), 3, model_.nv), Jr(jacr_.data(), 3, model_.nv);
  for (int i = 0; i < data.ncon; ++i) {
    mjContact& contact = data.contact[i];
    const bool pad = contact.geom[0] == pads_[0] || contact.geom[0] == pads_[1] ||
                     contact.geom[1] == pads_[0] || contact.geom[1] == pads_[1];
    if (!pad || contact.efc_address < 0) continue;
    // Acceleration of geom 1's material against geom 0's at the contact, all joints coasting.
    Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? -1.0 : 1.0;
      mj_jacDot(&model_, &data, jacp_.data(), jacr_.data(), contact.pos,
                model_.geom_bodyid[contact.geom[side]]);
      linear += sign * (Jp * v);
      angular += sign * (Jr * v);
    }
    const double damping_time_s = 0.5 * contact.solimp[1] * contact.solref[0];  // 1/b
    const double time_s = damping_time_s + 0.5 * model_.opt.timestep;
    contact.surfacevel[0] = time_s * Vector3(contact.frame + 3).dot(linear);
    contact.surfacevel[1] = time_s * Vector3(contact.frame + 6).dot(linear);
    contact.surfacevel[2] = time_s * Vector3(contact.frame).dot(angular);
  }
}

}  // namespace tubetwin
