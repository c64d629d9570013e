#include "tests/recording/random_events.h"

#include <cmath>
#include <limits>

#include "hw_bridge/recording/byte_stream.h"

namespace tubetwin::test {
namespace {

/// Numbers as they come from devices, and some that hardly do.
double AnyNumber(RandomStream& stream, double step) {
  switch (stream.Index(8)) {
    case 0:
      return -0.0;
    case 1:
      return stream.Normal() * 1e3;
    case 2:
      return std::numeric_limits<double>::quiet_NaN();
    case 3:
      return stream.Uniform() < 0.5 ? 1e300 : -std::numeric_limits<double>::infinity();
    default:
      return step * std::round(stream.Normal(0.0, 300.0));
  }
}

TimeNs AnyTime(RandomStream& stream) {
  const std::uint32_t far = stream.Index(20);
  if (far == 0) return TimeNs(std::numeric_limits<std::int64_t>::max() / 4);
  return TimeNs(static_cast<std::int64_t>(stream.Index(1000)) * 1000003);
}

std::string AnyText(RandomStream& stream) {
  std::string text;
  for (std::uint32_t i = stream.Index(12); i > 0; --i) {
    text.push_back(static_cast<char>(stream.Index(256)));
  }
  return text;
}

JointTrajectory AnyTrajectory(RandomStream& stream) {
  JointTrajectory trajectory;
  for (std::uint32_t i = stream.Index(5); i > 0; --i) {
    TrajectoryPoint point;
    point.time_s = AnyNumber(stream, 0.01);
    for (int k = 0; k < kNumJoints; ++k) {
      point.q[k] = AnyNumber(stream, 1e-5);
      point.qd[k] = AnyNumber(stream, 1e-4);
      point.qdd[k] = AnyNumber(stream, 1e-4);
    }
    trajectory.points.push_back(point);
  }
  return trajectory;
}

CommandResult AnyAnswer(RandomStream& stream) {
  if (stream.Index(2) == 0) return {};
  return {CommandResult::Status::kRejected, AnyText(stream)};
}

ArmState AnyArmState(RandomStream& stream) {
  ArmState state;
  state.time = AnyTime(stream);
  state.mode = static_cast<ArmMode>(stream.Index(8));
  for (int i = 0; i < kNumJoints; ++i) {
    state.q[i] = AnyNumber(stream, 1e-5);
    state.qd[i] = AnyNumber(stream, 1e-4);
  }
  state.progress_s = AnyNumber(stream, 0.001);
  state.planned_s = AnyNumber(stream, 0.01);
  state.done = stream.Index(2) == 0;
  state.fault = AnyText(stream);
  return state;
}

WrenchSample AnySample(RandomStream& stream) {
  WrenchSample sample;
  sample.time = AnyTime(stream);
  for (int i = 0; i < 3; ++i) {
    sample.wrench_K.force_N[i] = AnyNumber(stream, 1.0 / 80.0);
    sample.wrench_K.torque_Nm[i] = AnyNumber(stream, 10.0 / 13333.0);
  }
  sample.saturated = stream.Index(4) == 0;
  if (stream.Index(4) == 0) sample.problem = AnyText(stream);
  return sample;
}

class BitWriter {
 public:
  explicit BitWriter(ByteWriter& out) : out_(out) {}
  void operator()(const TimeRead& e) { Time(e.now); }
  void operator()(const TimeAdvanced& e) {
    Time(e.to);
    Time(e.now);
  }
  void operator()(const ArmRead& e) {
    Time(e.state.time);
    out_.U8(static_cast<std::uint8_t>(e.state.mode));
    Joints(e.state.q);
    Joints(e.state.qd);
    out_.F64(e.state.progress_s);
    out_.F64(e.state.planned_s);
    out_.U8(e.state.done);
    out_.Text(e.state.fault);
  }
  void operator()(const ArmStarted& e) {
    Time(e.at);
    out_.U8(e.appended);
    Answer(e.answer);
    out_.U64(e.trajectory.points.size());
    for (const TrajectoryPoint& point : e.trajectory.points) {
      out_.F64(point.time_s);
      Joints(point.q);
      Joints(point.qd);
      Joints(point.qdd);
    }
  }
  void operator()(const ArmStopped& e) {
    Time(e.at);
    out_.U8(static_cast<std::uint8_t>(e.kind));
  }
  void operator()(const ArmRecovered& e) {
    Time(e.at);
    Answer(e.answer);
  }
  void operator()(const PayloadSet& e) {
    Time(e.at);
    out_.F64(e.mass_kg);
    for (int i = 0; i < 3; ++i) out_.F64(e.p_FC[i]);
  }
  void operator()(const GripperRead& e) {
    Time(e.state.time);
    out_.U8(e.state.activated);
    out_.U8(static_cast<std::uint8_t>(e.state.object));
    out_.F64(e.state.opening_m);
    out_.F64(e.state.requested_m);
    out_.I64(e.state.fault);
    out_.Text(e.state.problem);
  }
  void operator()(const GripperCommanded& e) {
    Time(e.at);
    out_.F64(e.command.opening_m);
    out_.F64(e.command.speed_m_s);
    out_.F64(e.command.force_N);
  }
  void operator()(const WristRead& e) {
    Time(e.sample.time);
    for (int i = 0; i < 3; ++i) out_.F64(e.sample.wrench_K.force_N[i]);
    for (int i = 0; i < 3; ++i) out_.F64(e.sample.wrench_K.torque_Nm[i]);
    out_.U8(e.sample.saturated);
    out_.Text(e.sample.problem);
  }
  void operator()(const ScanTriggered& e) {
    Time(e.at);
    Answer(e.answer);
  }
  void operator()(const ScanStatusRead& e) { out_.U8(static_cast<std::uint8_t>(e.status)); }
  void operator()(const ScanTaken& e) {
    Time(e.at);
    out_.Text(Bits(e.cloud_S));
  }
  void operator()(const ScanFailureRead& e) { out_.Text(e.reason); }
  void operator()(const PipelineNote& e) {
    out_.U8(static_cast<std::uint8_t>(e.kind));
    Time(e.at);
    out_.Text(e.text);
  }

 private:
  void Time(TimeNs t) { out_.I64(t.count()); }
  void Joints(const JointVector& q) {
    for (const double v : q) out_.F64(v);
  }
  void Answer(const CommandResult& answer) {
    out_.U8(static_cast<std::uint8_t>(answer.status));
    out_.Text(answer.reason);
  }
  ByteWriter& out_;
};

}  // namespace

std::string Bits(const CellEvent& event) {
  std::string bits(1, static_cast<char>(event.index()));
  ByteWriter out(bits);
  std::visit(BitWriter(out), event);
  return bits;
}

std::string Bits(const OrganizedCloud& cloud) {
  std::string bits;
  ByteWriter out(bits);
  out.I64(cloud.width);
  out.I64(cloud.height);
  out.Raw(cloud.X_NS.matrix().data(), 16 * sizeof(double));
  for (const Eigen::Vector3f& p : cloud.p_SP) {
    out.U8(IsValid(p) ? 1 : 0);
    if (IsValid(p)) out.Raw(p.data(), 12);
  }
  out.U64(cloud.intensity.size());
  out.Raw(cloud.intensity.data(), cloud.intensity.size() * sizeof(float));
  out.U64(cloud.label.size());
  out.Raw(cloud.label.data(), cloud.label.size() * sizeof(std::uint32_t));
  return bits;
}

OrganizedCloud RandomCloud(RandomStream& stream, int width, int height, bool camera) {
  OrganizedCloud cloud;
  cloud.width = width;
  cloud.height = height;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const auto z = static_cast<float>(stream.Normal(0.45, 0.01));
      Eigen::Vector3f p(static_cast<float>(stream.Normal()), static_cast<float>(stream.Normal()),
                        z);
      if (camera) {
        p.x() = (static_cast<float>(column) - 0.5f * static_cast<float>(width)) / 1267.0f * z;
        p.y() = (static_cast<float>(row) - 0.5f * static_cast<float>(height)) / 1267.0f * z;
      }
      cloud.p_SP.push_back(stream.Index(5) == 0 ? InvalidPoint() : p);
      cloud.intensity.push_back(static_cast<float>(stream.Uniform()));
      if (!camera) cloud.label.push_back(stream.NextBits());
    }
  }
  cloud.X_NS = MakeTransform(RotX(stream.Normal()) * RotZ(stream.Normal()),
                             Vector3(stream.Normal(), stream.Normal(), 0.5));
  return cloud;
}

CellEvent RandomEvent(RandomStream& stream) {
  switch (stream.Index(16)) {
    case 0:
      return TimeRead{AnyTime(stream)};
    case 1:
      return TimeAdvanced{AnyTime(stream), AnyTime(stream)};
    case 2:
    case 3:
      return ArmRead{AnyArmState(stream)};
    case 4:
      return ArmStarted{AnyTime(stream), stream.Index(2) == 0, AnyTrajectory(stream),
                        AnyAnswer(stream)};
    case 5:
      return ArmStopped{AnyTime(stream),
                        stream.Index(2) == 0 ? StopKind::kFast : StopKind::kOnPath};
    case 6:
      return PayloadSet{AnyTime(stream), AnyNumber(stream, 0.1),
                        Vector3(AnyNumber(stream, 0.1), 0.0, -0.0)};
    case 7: {
      GripperState state;
      state.time = AnyTime(stream);
      state.activated = stream.Index(2) == 0;
      state.object = static_cast<GripperObject>(stream.Index(4));
      state.opening_m = AnyNumber(stream, 0.1);
      state.requested_m = AnyNumber(stream, 0.1);
      state.fault = static_cast<int>(stream.Index(20)) - 5;
      if (stream.Index(3) == 0) state.problem = AnyText(stream);
      return GripperRead{state};
    }
    case 8:
      return GripperCommanded{AnyTime(stream), {AnyNumber(stream, 0.1), 0.1, -0.0}};
    case 9:
    case 10:
      return WristRead{AnySample(stream)};
    case 11:
      return ScanTriggered{AnyTime(stream), AnyAnswer(stream)};
    case 15:
      return ArmRecovered{AnyTime(stream), AnyAnswer(stream)};
    case 12:
      return ScanStatusRead{static_cast<ScanStatus>(stream.Index(4))};
    case 13:
      return ScanFailureRead{AnyText(stream)};
    default:
      return PipelineNote{
          stream.Index(2) == 0 ? PipelineNote::Kind::kCaption : PipelineNote::Kind::kResult,
          AnyTime(stream), AnyText(stream)};
  }
}

}  // namespace tubetwin::test
