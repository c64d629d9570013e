#include <bit>
#include <string>
#include <utility>

#include "hw_bridge/recording/event_codec.h"
#include "hw_bridge/recording/event_tags.h"

namespace tubetwin {
namespace {

/// Wraps instead of overflowing: bytes may be anything.
TimeNs ReadTime(TimeNs from, ByteReader& in) {
  return TimeNs(static_cast<std::int64_t>(static_cast<std::uint64_t>(from.count()) +
                                          static_cast<std::uint64_t>(in.Signed())));
}

template <typename E>
E ReadEnum(ByteReader& in, E last, const char* what) {
  const std::uint8_t value = in.U8();
  if (value > static_cast<std::uint8_t>(last)) {
    in.Fail(std::string(what) + " " + std::to_string(value) + ", allowed 0 to " +
            std::to_string(static_cast<int>(last)));
  }
  return static_cast<E>(value);
}

TimeNs ReadStateTime(std::uint8_t flags, TimeNs old, TimeNs now, ByteReader& in) {
  if (flags & kTimeOther) return ReadTime(now, in);
  return flags & kTimeOld ? old : now;
}

CommandResult ReadAnswer(ByteReader& in) {
  CommandResult answer;
  answer.status = ReadEnum(in, CommandResult::Status::kRejected, "answer");
  answer.reason = in.Text();
  return answer;
}

JointTrajectory ReadTrajectory(ByteReader& in) {
  const std::size_t count = in.Count(8 * kPointNumbers);
  JointTrajectory trajectory;
  trajectory.points.resize(count);
  for (std::size_t column = 0; column < kPointNumbers; ++column) {
    const char* planes = in.Take(8 * count);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t b = 0; b < 8; ++b) {
        bits ^= static_cast<std::uint64_t>(static_cast<std::uint8_t>(planes[b * count + i]))
                << (8 * b);
      }
      TrajectoryPoint& point = trajectory.points[i];
      const auto value = std::bit_cast<double>(bits);
      if (column == 0) {
        point.time_s = value;
      } else {
        const std::size_t k = column - 1;
        JointVector& vector = k < kNumJoints ? point.q : k < 2 * kNumJoints ? point.qd : point.qdd;
        vector[static_cast<Eigen::Index>(k % kNumJoints)] = value;
      }
    }
  }
  return trajectory;
}

ArmRead ReadArm(EventContext& c, ByteReader& in) {
  ArmState& s = c.arm;
  const std::uint8_t flags = in.U8();
  s.time = ReadStateTime(flags, s.time, c.now, in);
  if (flags & kRest) {
    s.mode = ReadEnum(in, ArmMode::kFault, "arm mode");
    s.done = in.U8() != 0;
    s.planned_s = in.F64();
    s.fault = in.Text();
  }
  if (flags & kProgressOther) {
    s.progress_s = in.F64();
  } else if (flags & kProgressOn) {
    s.progress_s += kPeriod_s;
  }
  for (int i = 0; i < kNumJoints && (flags & kNumbers); ++i) s.q[i] = c.q[i].Read(in);
  for (int i = 0; i < kNumJoints && (flags & kMoreNumbers); ++i) s.qd[i] = c.qd[i].Read(in);
  return {s};
}

GripperRead ReadGripper(EventContext& c, ByteReader& in) {
  GripperState& s = c.gripper;
  const std::uint8_t flags = in.U8();
  s.time = ReadStateTime(flags, s.time, c.now, in);
  if (flags & kRest) {
    s.activated = in.U8() != 0;
    s.object = ReadEnum(in, GripperObject::kAtPosition, "gripper object");
    s.fault = static_cast<int>(in.Signed());
    s.opening_m = in.F64();
    s.requested_m = in.F64();
  }
  if (flags & kProblem) s.problem = in.Text();
  return {s};
}

WristRead ReadWrist(EventContext& c, ByteReader& in) {
  WrenchSample& s = c.wrist;
  const std::uint8_t flags = in.U8();
  s.time = ReadStateTime(flags, s.time, c.now, in);
  s.saturated = (flags & kSaturated) != 0;
  if (flags & kNumbers) {
    for (int i = 0; i < 3; ++i) s.wrench_K.force_N[i] = c.wrench[i].Read(in);
    for (int i = 0; i < 3; ++i) s.wrench_K.torque_Nm[i] = c.wrench[3 + i].Read(in);
  }
  if (flags & kProblem) s.problem = in.Text();
  return {s};
}

CellEvent ReadCommand(Tag tag, EventContext& c, ByteReader& in) {
  const TimeNs at = ReadTime(c.now, in);
  c.now = at;
  switch (tag) {
    case Tag::kArmStarted:
    case Tag::kArmAppended: {
      ArmStarted e{at, tag == Tag::kArmAppended, {}, ReadAnswer(in)};
      e.trajectory = ReadTrajectory(in);
      return e;
    }
    case Tag::kArmStopped:
      return ArmStopped{at, ReadEnum(in, StopKind::kFast, "kind of stop")};
    case Tag::kArmRecovered:
      return ArmRecovered{at, ReadAnswer(in)};
    case Tag::kPayloadSet: {
      PayloadSet e{at, in.F64(), {}};
      for (int i = 0; i < 3; ++i) e.p_FC[i] = in.F64();
      return e;
    }
    case Tag::kGripperCommanded: {
      GripperCommanded e{at, {}};
      e.command.opening_m = in.F64();
      e.command.speed_m_s = in.F64();
      e.command.force_N = in.F64();
      return e;
    }
    case Tag::kScanTriggered:
      return ScanTriggered{at, ReadAnswer(in)};
    case Tag::kScanTaken:
      return ScanTaken{at, {}};
    case Tag::kCaption:
      return PipelineNote{PipelineNote::Kind::kCaption, at, in.Text()};
    case Tag::kResult:
      return PipelineNote{PipelineNote::Kind::kResult, at, in.Text()};
    default:
      in.Fail("no event has the tag " + std::to_string(static_cast<int>(tag)));
  }
}

}  // namespace

EventDecoder::EventDecoder(std::string_view bytes, TimeNs now, std::string source)
    : in_(bytes, std::move(source)) {
  context_.now = now;
}

std::optional<CellEvent> EventDecoder::Next() {
  if (in_.AtEnd()) return std::nullopt;
  EventContext& c = context_;
  const auto tag = static_cast<Tag>(in_.U8());
  switch (tag) {
    case Tag::kTimeRead:
      c.now = ReadTime(c.now, in_);
      return TimeRead{c.now};
    case Tag::kOnePeriod:
      c.now =
          TimeNs(static_cast<std::int64_t>(static_cast<std::uint64_t>(c.now.count()) +
                                           static_cast<std::uint64_t>(kControlPeriod / TimeNs(1))));
      return TimeAdvanced{c.now, c.now};
    case Tag::kTimeAdvanced: {
      const TimeNs to = ReadTime(c.now, in_);
      c.now = ReadTime(to, in_);
      return TimeAdvanced{to, c.now};
    }
    case Tag::kArmRead:
      return ReadArm(c, in_);
    case Tag::kGripperRead:
      return ReadGripper(c, in_);
    case Tag::kWristRead:
      return ReadWrist(c, in_);
    case Tag::kScanStatusRead:
      return ScanStatusRead{ReadEnum(in_, ScanStatus::kFailed, "scan status")};
    case Tag::kScanFailureRead:
      return ScanFailureRead{in_.Text()};
    default:
      return ReadCommand(tag, c, in_);
  }
}

}  // namespace tubetwin
