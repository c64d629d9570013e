#include <functional>
#include <map>

#include "models/base/error.h"
#include "twin/live/fault_script.h"

namespace tubetwin {
namespace {

using Act = std::function<void(EmulatedCell&, const ScriptedFault&, bool undo)>;
using Actions = std::map<std::string, Act>;
using LinkOf = std::function<LinkFaults&(EmulatedCell&)>;

Actions LinkActions(const LinkOf& link) {
  return {
      {"drop", [link](auto& cell, auto&, bool undo) { link(cell).drop = !undo; }},
      {"delay", [link](auto& cell, auto& f,
                       bool undo) { link(cell).delay = undo ? TimeNs(0) : FromSeconds(f.value); }},
      {"duplicate", [link](auto& cell, auto&, bool undo) { link(cell).duplicate = !undo; }},
      {"corrupt", [link](auto& cell, auto&, bool undo) { link(cell).corrupt = !undo; }},
      {"freeze", [link](auto& cell, auto&, bool undo) { link(cell).freeze = !undo; }},
  };
}

/// Of what cannot be undone.
Act Once(std::function<void(EmulatedCell&, const ScriptedFault&)> act) {
  return [act = std::move(act)](EmulatedCell& cell, const ScriptedFault& f, bool undo) {
    if (!undo) act(cell, f);
  };
}

Actions ArmActions() {
  return {
      {"refuse", Once([](auto& cell, auto& f) {
         cell.arm().Refuse(static_cast<std::int32_t>(f.value), f.count);
       })},
      {"alarm",
       [](auto& cell, auto& f, bool undo) {
         if (undo) return cell.arm().ClearAlarmCause();
         cell.arm().Alarm(static_cast<std::int32_t>(f.value), f.for_s > 0.0);
       }},
      {"emergency_stop",
       [](auto& cell, auto&, bool undo) {
         undo ? cell.arm().ReleaseEmergencyStop() : cell.arm().EmergencyStop();
       }},
      {"protective_stop", Once([](auto& cell, auto&) { cell.arm().ProtectiveStop(); })},
      {"hold", [](auto& cell, auto&, bool undo) { cell.arm().Hold(!undo); }},
      {"servo_off", [](auto& cell, auto&, bool undo) { cell.arm().SwitchServo(undo); }},
      {"stick_job", [](auto& cell, auto&, bool undo) { cell.arm().controller().StickJob(!undo); }},
      {"limit_speed", [](auto& cell, auto& f,
                         bool undo) { cell.arm().controller().LimitSpeed(undo ? 0.0 : f.value); }},
      {"local", [](auto& cell, auto&, bool undo) { cell.arm().SetRemote(undo); }},
      {"teach", [](auto& cell, auto&, bool undo) { cell.arm().SetPlay(undo); }},
  };
}

Actions GripperActions() {
  return {
      {"fault",
       [](auto& cell, auto& f, bool undo) {
         GripperController& gripper = cell.gripper().controller();
         undo ? gripper.ClearFault() : gripper.RaiseFault(static_cast<int>(f.value));
       }},
      {"lose_object", Once([](auto& cell, auto&) { cell.gripper().controller().LoseObject(); })},
  };
}

Actions WristActions() {
  return {
      {"saturate", [](auto& cell, auto&, bool undo) { cell.wrist().Saturate(!undo); }},
      {"status",
       [](auto& cell, auto& f, bool undo) {
         cell.wrist().InjectStatus(undo ? 0 : static_cast<std::uint32_t>(f.value));
       }},
      {"threshold", Once([](auto& cell, auto&) { cell.wrist().LatchThreshold(); })},
      {"skip", Once([](auto& cell, auto& f) {
         cell.wrist().SkipSequence(static_cast<std::uint32_t>(f.count));
       })},
  };
}

Actions ScannerActions() {
  const auto order = [](ScanFault fault) {
    return Once([fault](auto& cell, auto& f) { cell.scanner().faults().Order(fault, f.count); });
  };
  return {
      {"no_answer", order(ScanFault::kNoAnswer)},
      {"truncate", order(ScanFault::kTruncated)},
      {"garbage", order(ScanFault::kGarbage)},
      {"cover", order(ScanFault::kEmptyCloud)},
      {"late",
       Once([](auto& cell, auto& f) { cell.scanner().faults().OrderLate(f.value, f.count); })},
      {"refuse", Once([](auto& cell, auto& f) {
         cell.scanner().faults().OrderRefusal("ordered by the fault script", f.count);
       })},
  };
}

const std::map<std::string, Actions>& AllActions() {
  static const std::map<std::string, Actions> all = [] {
    std::map<std::string, Actions> out;
    out["arm"] = ArmActions();
    out["arm.motion"] = LinkActions([](auto& c) -> LinkFaults& { return c.arm().motion_link(); });
    out["arm.motion"]["close"] = Once([](auto& cell, auto&) { cell.arm().CloseMotion(); });
    out["arm.state"] = LinkActions([](auto& c) -> LinkFaults& { return c.arm().state_link(); });
    out["arm.state"]["close"] = Once([](auto& cell, auto&) { cell.arm().CloseState(); });
    out["arm.io"] = LinkActions([](auto& c) -> LinkFaults& { return c.arm().io_link(); });
    out["arm.supervision"] =
        LinkActions([](auto& c) -> LinkFaults& { return c.arm().hses_link(); });
    out["gripper"] = GripperActions();
    out["gripper.link"] = LinkActions([](auto& c) -> LinkFaults& { return c.gripper().link(); });
    out["wrist"] = WristActions();
    out["wrist.link"] = LinkActions([](auto& c) -> LinkFaults& { return c.wrist().link(); });
    out["scanner"] = ScannerActions();
    out["scanner.link"] = LinkActions([](auto& c) -> LinkFaults& { return c.scanner().link(); });
    return out;
  }();
  return all;
}

}  // namespace

const std::vector<std::string>& FaultDevices() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const auto& [name, actions] : AllActions()) out.push_back(name);
    return out;
  }();
  return names;
}

std::vector<std::string> FaultActions(const std::string& device) {
  std::vector<std::string> out;
  for (const auto& [name, act] : AllActions().at(device)) out.push_back(name);
  return out;
}

void ApplyFault(EmulatedCell& cell, const ScriptedFault& fault, bool undo) {
  AllActions().at(fault.device).at(fault.action)(cell, fault, undo);
}

}  // namespace tubetwin
