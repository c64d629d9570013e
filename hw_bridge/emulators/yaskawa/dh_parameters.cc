#include "hw_bridge/emulators/yaskawa/dh_parameters.h"

#include <cmath>
#include <vector>

namespace tubetwin {
namespace {

constexpr double kNone = 1e-9;

struct Axis {
  Vector3 p = Vector3::Zero(), z = Vector3::UnitZ();
};

/// The joints' axes in the zero pose, then the flange's.
std::vector<Axis> AxesOf(const ArmModel& arm) {
  const RigidTransform X_BF = FlangePose(arm, JointVector::Zero());
  const JacobianMatrix J = Jacobian(arm, JointVector::Zero(), RigidTransform::Identity());
  std::vector<Axis> axes;
  for (int i = 0; i < kNumJoints; ++i) {
    const Vector3 v = J.col(i).head<3>(), z = J.col(i).tail<3>();
    axes.push_back({X_BF.translation() - v.cross(z), z});
  }
  axes.push_back({X_BF.translation(), X_BF.linear().col(2)});
  return axes;
}

struct Frame {
  Vector3 o = Vector3::Zero(), x = Vector3::UnitX(), z = Vector3::UnitZ();
};

/// The frame on `next` that the common normal of both axes leads to, and the link's numbers.
Frame Link(const Frame& from, const Axis& next, bool last, float* numbers) {
  const Vector3 normal = from.z.cross(next.z), between = next.p - from.o;
  Frame to{from.o, from.x, next.z};
  double d = 0.0, a = 0.0;
  if (normal.norm() < kNone) {
    // Parallel: nothing along the axis, but to the flange.
    if (last) d = between.dot(from.z);
    const Vector3 across = between - between.dot(from.z) * from.z;
    a = across.norm();
    if (a > kNone) to.x = across / a;
  } else {
    const Vector3 n = normal.normalized();
    d = between.cross(next.z).dot(normal) / normal.squaredNorm();
    a = between.dot(n);
    to.x = a < 0.0 ? Vector3(-n) : n;
    a = std::abs(a);
  }
  to.o = from.o + d * from.z + a * to.x;
  numbers[0] = static_cast<float>(std::atan2(from.x.cross(to.x).dot(from.z), from.x.dot(to.x)));
  numbers[1] = static_cast<float>(d);
  numbers[2] = static_cast<float>(a);
  numbers[3] = static_cast<float>(std::atan2(from.z.cross(to.z).dot(to.x), from.z.dot(to.z)));
  return to;
}

}  // namespace

simple_message::DhParameters DhParametersOf(const ArmModel& arm) {
  simple_message::DhParameters out;
  const std::vector<Axis> axes = AxesOf(arm);
  Frame frame{axes[0].p, Vector3::UnitX(), axes[0].z};
  frame.x -= frame.x.dot(frame.z) * frame.z;
  frame.x = frame.x.norm() > kNone ? frame.x.normalized() : Vector3::UnitY();
  for (int i = 0; i < kNumJoints; ++i) {
    frame = Link(frame, axes[i + 1], i + 1 == kNumJoints,
                 out.values.data() + i * simple_message::DhParameters::kNumbers);
  }
  return out;
}

}  // namespace tubetwin
