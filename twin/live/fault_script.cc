#include "twin/live/fault_script.h"

#include <algorithm>
#include <utility>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

/// What the ranges of single keys cannot say.
void CheckFault(const ScriptedFault& fault, const std::string& where) {
  const auto fail = [&](const std::string& what) { throw Error(ErrorKind::kConfig, where + what); };
  if ((fault.at_s < 0.0) == fault.on.empty()) {
    fail("either 'at_s' (seconds from the start) or 'on' (one of " + Join(CycleMoments::Names()) +
         ") is needed");
  }
  const std::vector<std::string> actions = FaultActions(fault.device);
  if (std::find(actions.begin(), actions.end(), fault.action) == actions.end()) {
    fail("action: '" + fault.action + "' cannot happen to " + fault.device + "; nearest: '" +
         NearestName(fault.action, actions) + "'; there are " + Join(actions));
  }
}

}  // namespace

void ScriptedFault::Visit(ConfigVisitor& v) {
  std::vector<std::string> moments = CycleMoments::Names();
  moments.insert(moments.begin(), "");
  v.Field("at_s", "cell time since the start; negative: `on` says when", at_s, {-1, 1e6});
  v.Choice("on", "moment of the pick cycle", on, moments);
  v.Field("nth", "the how manieth of these moments", nth, {1, 1000000});
  v.Field("delay_s", "after the moment", delay_s, {0, 1e6});
  v.Choice("device", "device, or what it sends and receives", device, FaultDevices());
  v.Field("action", "what happens", action);
  v.Field("value", "delay, late: seconds; alarm, refuse, fault, status: the code", value,
          {0, 4294967295.0});
  v.Field("count", "refuse: points; scans: how many; skip: records", count, {1, 1000000});
  v.Field("for_s", "undone after so long; 0: it stays", for_s, {0, 1e6});
}

std::vector<ScriptedFault> ReadFaultScript(const std::string& path) {
  ConfigSource source;
  source.AddFile(path);
  std::vector<ScriptedFault> faults;
  for (ConfigSource& table : source.TakeTables("fault")) {
    ScriptedFault fault;
    fault.device = FaultDevices().front();
    table.ReadInto(fault);
    CheckFault(fault, path + ": fault " + std::to_string(faults.size() + 1) + ": ");
    faults.push_back(std::move(fault));
  }
  source.Read([](ConfigVisitor&) {});  // No other key means anything.
  if (faults.empty()) {
    throw Error(ErrorKind::kConfig, path +
                                        ": no [[fault]] in it; each needs at_s or on, device, "
                                        "action");
  }
  return faults;
}

FaultScript::FaultScript(std::vector<ScriptedFault> faults) {
  for (ScriptedFault& fault : faults) {
    Pending pending;
    if (fault.at_s >= 0.0) pending.due = FromSeconds(fault.at_s);
    pending.fault = std::move(fault);
    pending_.push_back(std::move(pending));
  }
}

void FaultScript::Hear(const std::string& moment, TimeNs now) {
  for (Pending& p : pending_) {
    if (p.fault.on != moment || p.due >= TimeNs(0)) continue;
    if (++p.heard == p.fault.nth) p.due = now + FromSeconds(p.fault.delay_s);
  }
}

std::vector<std::string> FaultScript::Act(EmulatedCell& cell, TimeNs now) {
  std::vector<std::string> said;
  for (Pending& p : pending_) {
    if (p.over || p.due < TimeNs(0) || now < p.due) continue;
    const std::string what = p.fault.device + " " + p.fault.action;
    if (!p.begun) {
      ApplyFault(cell, p.fault, false);
      said.push_back(what);
      p.begun = true;
      ++done_;
      p.over = p.fault.for_s <= 0.0;
      p.due = now + FromSeconds(p.fault.for_s);
      continue;
    }
    ApplyFault(cell, p.fault, true);
    said.push_back(what + " undone");
    p.over = true;
  }
  return said;
}

}  // namespace tubetwin
