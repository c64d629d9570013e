#include <array>
#include <bit>
#include <vector>

#include "hw_bridge/recording/event_codec.h"
#include "hw_bridge/recording/event_tags.h"

namespace tubetwin {
namespace {

void WriteTime(TimeNs time, TimeNs from, ByteWriter& out) { out.Signed((time - from).count()); }

std::uint8_t TimeFlag(TimeNs time, TimeNs old, TimeNs now) {
  if (time == now) return 0;
  return time == old ? kTimeOld : kTimeOther;
}

/// A command's tag and time.
void BeginCommand(Tag tag, TimeNs at, EventContext& context, ByteWriter& out) {
  out.U8(static_cast<std::uint8_t>(tag));
  WriteTime(at, context.now, out);
  context.now = at;
}

void WriteAnswer(const CommandResult& answer, ByteWriter& out) {
  out.U8(static_cast<std::uint8_t>(answer.status));
  out.Text(answer.reason);
}

/// Numbers of one point: time, positions, speeds, accelerations.
std::array<double, kPointNumbers> Numbers(const TrajectoryPoint& point) {
  std::array<double, kPointNumbers> out;
  out[0] = point.time_s;
  for (int i = 0; i < kNumJoints; ++i) {
    out[1 + i] = point.q[i];
    out[1 + kNumJoints + i] = point.qd[i];
    out[1 + 2 * kNumJoints + i] = point.qdd[i];
  }
  return out;
}

/// Column by column and byte by byte, each number as what differs from the one before: the upper
/// bytes of what changes little stand together.
void WriteTrajectory(const JointTrajectory& trajectory, ByteWriter& out) {
  const std::size_t count = trajectory.points.size();
  out.Varint(count);
  std::vector<std::array<double, kPointNumbers>> rows;
  rows.reserve(count);
  for (const TrajectoryPoint& point : trajectory.points) rows.push_back(Numbers(point));
  std::string planes(8 * count, '\0');
  for (std::size_t column = 0; column < kPointNumbers; ++column) {
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto bits = std::bit_cast<std::uint64_t>(rows[i][column]);
      const std::uint64_t changed = bits ^ before;
      for (std::size_t b = 0; b < 8; ++b) {
        planes[b * count + i] = static_cast<char>(changed >> (8 * b));
      }
      before = bits;
    }
    out.Raw(planes.data(), planes.size());
  }
}

class Writer {
 public:
  Writer(EventContext& context, std::string& out) : c_(context), out_(out) {}

  void operator()(const TimeRead& e) {
    Put(Tag::kTimeRead);
    WriteTime(e.now, c_.now, out_);
    c_.now = e.now;
  }
  void operator()(const TimeAdvanced& e) {
    if (e.to == c_.now + kControlPeriod && e.now == e.to) {
      Put(Tag::kOnePeriod);
    } else {
      Put(Tag::kTimeAdvanced);
      WriteTime(e.to, c_.now, out_);
      WriteTime(e.now, e.to, out_);
    }
    c_.now = e.now;
  }
  void operator()(const ArmRead& e);
  void operator()(const ArmStarted& e) {
    BeginCommand(e.appended ? Tag::kArmAppended : Tag::kArmStarted, e.at, c_, out_);
    WriteAnswer(e.answer, out_);
    WriteTrajectory(e.trajectory, out_);
  }
  void operator()(const ArmStopped& e) {
    BeginCommand(Tag::kArmStopped, e.at, c_, out_);
    out_.U8(static_cast<std::uint8_t>(e.kind));
  }
  void operator()(const ArmRecovered& e) {
    BeginCommand(Tag::kArmRecovered, e.at, c_, out_);
    WriteAnswer(e.answer, out_);
  }
  void operator()(const PayloadSet& e) {
    BeginCommand(Tag::kPayloadSet, e.at, c_, out_);
    out_.F64(e.mass_kg);
    for (int i = 0; i < 3; ++i) out_.F64(e.p_FC[i]);
  }
  void operator()(const GripperRead& e) {
    const GripperState& s = e.state;
    GripperState& last = c_.gripper;
    const bool changed = s.activated != last.activated || s.object != last.object ||
                         s.fault != last.fault || !SameBits(s.opening_m, last.opening_m) ||
                         !SameBits(s.requested_m, last.requested_m);
    Put(Tag::kGripperRead);
    std::uint8_t flags = TimeFlag(s.time, last.time, c_.now) | (changed ? kRest : 0);
    if (s.problem != last.problem) flags |= kProblem;
    out_.U8(flags);
    if (flags & kTimeOther) WriteTime(s.time, c_.now, out_);
    if (changed) {
      out_.U8(s.activated ? 1 : 0);
      out_.U8(static_cast<std::uint8_t>(s.object));
      out_.Signed(s.fault);
      out_.F64(s.opening_m);
      out_.F64(s.requested_m);
    }
    if (flags & kProblem) out_.Text(s.problem);
    last = s;
  }
  void operator()(const GripperCommanded& e) {
    BeginCommand(Tag::kGripperCommanded, e.at, c_, out_);
    out_.F64(e.command.opening_m);
    out_.F64(e.command.speed_m_s);
    out_.F64(e.command.force_N);
  }
  void operator()(const WristRead& e);
  void operator()(const ScanTriggered& e) {
    BeginCommand(Tag::kScanTriggered, e.at, c_, out_);
    WriteAnswer(e.answer, out_);
  }
  void operator()(const ScanStatusRead& e) {
    Put(Tag::kScanStatusRead);
    out_.U8(static_cast<std::uint8_t>(e.status));
  }
  void operator()(const ScanTaken& e) { BeginCommand(Tag::kScanTaken, e.at, c_, out_); }
  void operator()(const ScanFailureRead& e) {
    Put(Tag::kScanFailureRead);
    out_.Text(e.reason);
  }
  void operator()(const PipelineNote& e) {
    const bool caption = e.kind == PipelineNote::Kind::kCaption;
    BeginCommand(caption ? Tag::kCaption : Tag::kResult, e.at, c_, out_);
    out_.Text(e.text);
  }

 private:
  void Put(Tag tag) { out_.U8(static_cast<std::uint8_t>(tag)); }
  EventContext& c_;
  ByteWriter out_;
};

void Writer::operator()(const ArmRead& e) {
  const ArmState& s = e.state;
  ArmState& last = c_.arm;
  std::uint8_t flags = TimeFlag(s.time, last.time, c_.now);
  if (s.mode != last.mode || s.done != last.done || !SameBits(s.planned_s, last.planned_s) ||
      s.fault != last.fault) {
    flags |= kRest;
  }
  bool moved = false, sped = false;
  for (int i = 0; i < kNumJoints; ++i) {
    moved = moved || !SameBits(s.q[i], last.q[i]);
    sped = sped || !SameBits(s.qd[i], last.qd[i]);
  }
  if (moved) flags |= kNumbers;
  if (sped) flags |= kMoreNumbers;
  if (!SameBits(s.progress_s, last.progress_s)) {
    flags |= SameBits(s.progress_s, last.progress_s + kPeriod_s) ? kProgressOn : kProgressOther;
  }
  Put(Tag::kArmRead);
  out_.U8(flags);
  if (flags & kTimeOther) WriteTime(s.time, c_.now, out_);
  if (flags & kRest) {
    out_.U8(static_cast<std::uint8_t>(s.mode));
    out_.U8(s.done ? 1 : 0);
    out_.F64(s.planned_s);
    out_.Text(s.fault);
  }
  if (flags & kProgressOther) out_.F64(s.progress_s);
  for (int i = 0; i < kNumJoints && moved; ++i) c_.q[i].Write(s.q[i], out_);
  for (int i = 0; i < kNumJoints && sped; ++i) c_.qd[i].Write(s.qd[i], out_);
  last = s;
}

void Writer::operator()(const WristRead& e) {
  const WrenchSample& s = e.sample;
  std::uint8_t flags = TimeFlag(s.time, c_.wrist.time, c_.now);
  bool changed = false;
  for (int i = 0; i < 3; ++i) {
    changed = changed || !SameBits(s.wrench_K.force_N[i], c_.wrist.wrench_K.force_N[i]) ||
              !SameBits(s.wrench_K.torque_Nm[i], c_.wrist.wrench_K.torque_Nm[i]);
  }
  if (changed) flags |= kNumbers;
  if (s.saturated) flags |= kSaturated;
  if (s.problem != c_.wrist.problem) flags |= kProblem;
  Put(Tag::kWristRead);
  out_.U8(flags);
  if (flags & kTimeOther) WriteTime(s.time, c_.now, out_);
  for (int i = 0; i < 3 && changed; ++i) c_.wrench[i].Write(s.wrench_K.force_N[i], out_);
  for (int i = 0; i < 3 && changed; ++i) c_.wrench[3 + i].Write(s.wrench_K.torque_Nm[i], out_);
  if (flags & kProblem) out_.Text(s.problem);
  c_.wrist = s;
}

}  // namespace

void EventEncoder::Reset() {
  const TimeNs now = context_.now;
  context_ = EventContext();
  context_.now = now;
}

void EventEncoder::Encode(const CellEvent& event, std::string& out) {
  std::visit(Writer(context_, out), event);
}

}  // namespace tubetwin
