#include "hw_bridge/recording/command_difference.h"

#include <array>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

std::string Milliseconds(TimeNs t) { return Number(1e-6 * static_cast<double>(t.count())) + " ms"; }

const char* ToString(StopKind kind) { return kind == StopKind::kFast ? "fast" : "on the path"; }

std::string ListText(const Vector3& p) {
  return Number(p.x()) + " " + Number(p.y()) + " " + Number(p.z());
}

/// Collects the first difference.
class Comparison {
 public:
  void Compare(const std::string& field, double recorded, double asked) {
    // Written so that two numbers that are none agree.
    const bool same = recorded == asked || (recorded != recorded && asked != asked);
    if (!found_ && !same) found_ = {field, Number(recorded), Number(asked)};
  }
  void Compare(const std::string& field, const std::string& recorded, const std::string& asked) {
    if (!found_ && recorded != asked) found_ = {field, recorded, asked};
  }
  std::optional<CommandDifference> found() const { return found_; }

 private:
  std::optional<CommandDifference> found_;
};

void ComparePoint(const TrajectoryPoint& recorded, const TrajectoryPoint& asked,
                  const std::string& name, Comparison& out) {
  if (recorded.time_s == asked.time_s && recorded.q == asked.q && recorded.qd == asked.qd &&
      recorded.qdd == asked.qdd) {
    return;
  }
  out.Compare(name + ", time_s", recorded.time_s, asked.time_s);
  const auto each = [&](const char* what, const JointVector& a, const JointVector& b) {
    for (int i = 0; i < kNumJoints; ++i) {
      out.Compare(name + ", " + what + " of joint " + std::to_string(i + 1), a[i], b[i]);
    }
  };
  each("q", recorded.q, asked.q);
  each("qd", recorded.qd, asked.qd);
  each("qdd", recorded.qdd, asked.qdd);
}

struct Fields {
  const CellEvent& asked_event;
  Comparison& out;

  template <typename E>
  const E& Asked() const {
    return std::get<E>(asked_event);
  }

  void operator()(const TimeAdvanced& e) const {
    out.Compare("to", Milliseconds(e.to), Milliseconds(Asked<TimeAdvanced>().to));
  }
  void operator()(const ArmStarted& e) const {
    const auto& a = e.trajectory.points;
    const auto& b = Asked<ArmStarted>().trajectory.points;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      ComparePoint(a[i], b[i],
                   "trajectory point " + std::to_string(i + 1) + " of " + std::to_string(a.size()),
                   out);
      if (out.found()) return;
    }
    out.Compare("number of trajectory points", static_cast<double>(a.size()),
                static_cast<double>(b.size()));
  }
  void operator()(const ArmStopped& e) const {
    out.Compare("kind of stop", ToString(e.kind), ToString(Asked<ArmStopped>().kind));
  }
  void operator()(const PayloadSet& e) const {
    out.Compare("mass_kg", e.mass_kg, Asked<PayloadSet>().mass_kg);
    for (int i = 0; i < 3; ++i) {
      out.Compare(std::string("p_FC ") + "xyz"[i], e.p_FC[i], Asked<PayloadSet>().p_FC[i]);
    }
  }
  void operator()(const GripperCommanded& e) const {
    const GripperCommand& a = e.command;
    const GripperCommand& b = Asked<GripperCommanded>().command;
    out.Compare("opening_m", a.opening_m, b.opening_m);
    out.Compare("speed_m_s", a.speed_m_s, b.speed_m_s);
    out.Compare("force_N", a.force_N, b.force_N);
  }
  void operator()(const PipelineNote& e) const {
    out.Compare("text", e.text, Asked<PipelineNote>().text);
  }
  // Triggering, taking and recovering have no content; reads are not compared.
  template <typename Other>
  void operator()(const Other&) const {}
};

struct Describer {
  std::string operator()(const TimeAdvanced& e) const { return "advance to " + Milliseconds(e.to); }
  std::string operator()(const ArmStarted& e) const {
    return std::string(e.appended ? "arm append" : "arm start") + " of " +
           std::to_string(e.trajectory.points.size()) + " points, " +
           Number(e.trajectory.duration_s()) + " s";
  }
  std::string operator()(const ArmStopped& e) const {
    return std::string("arm stop ") + ToString(e.kind);
  }
  std::string operator()(const PayloadSet& e) const {
    return "payload " + Number(e.mass_kg) + " kg at " + ListText(e.p_FC);
  }
  std::string operator()(const GripperCommanded& e) const {
    return "gripper command to " + Number(e.command.opening_m) + " m, " +
           Number(e.command.speed_m_s) + " m/s, " + Number(e.command.force_N) + " N";
  }
  std::string operator()(const PipelineNote& e) const { return "result " + e.text; }
  template <typename Other>
  std::string operator()(const Other& e) const {
    return KindOf(CellEvent(e));
  }
};

}  // namespace

std::string KindOf(const CellEvent& event) {
  if (const auto* start = std::get_if<ArmStarted>(&event)) {
    return start->appended ? "arm append" : "arm start";
  }
  if (const auto* note = std::get_if<PipelineNote>(&event)) {
    return note->kind == PipelineNote::Kind::kCaption ? "caption" : "result";
  }
  static constexpr std::array<const char*, std::variant_size_v<CellEvent>> kNames = {
      "time read",   "advance",       "arm state",       "arm start", "arm stop",
      "payload",     "gripper state", "gripper command", "wrench",    "scan trigger",
      "scan status", "scan taken",    "scan failure",    "note",      "arm recover"};
  return kNames[event.index()];
}

std::string Describe(const CellEvent& event) { return std::visit(Describer{}, event); }

std::optional<CommandDifference> DifferenceOf(const CellEvent& recorded, const CellEvent& asked) {
  if (KindOf(recorded) != KindOf(asked)) {
    return CommandDifference{"kind", Describe(recorded), Describe(asked)};
  }
  Comparison comparison;
  std::visit(Fields{asked, comparison}, recorded);
  return comparison.found();
}

}  // namespace tubetwin
