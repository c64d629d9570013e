#include "scenes/engine/stepping.h"

#include "models/base/error.h"
#include "scenes/engine/engine_error.h"

namespace tubetwin {

const char* ToString(StepStatus status) {
  switch (status) {
    case StepStatus::kOk:
      return "ok";
    case StepStatus::kDiverged:
      return "diverged";
    case StepStatus::kOverflow:
      return "overflow";
  }
  return "?";
}

StepStatus StatusOf(const mjData& data) {
  for (const int kind : {mjWARN_INERTIA, mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
    if (data.warning[kind].number > 0) return StepStatus::kDiverged;
  }
  for (const int kind : {mjWARN_CONTACTFULL, mjWARN_CNSTRFULL}) {
    if (data.warning[kind].number > 0) return StepStatus::kOverflow;
  }
  return StepStatus::kOk;
}

StepStatus Step(const mjModel& model, mjData& data, int steps) {
  StepStatus status = StatusOf(data);
  GuardEngine([&] {
    for (int i = 0; i < steps && status == StepStatus::kOk; ++i) {
      mj_step(&model, &data);
      status = StatusOf(data);
    }
  });
  return status;
}

Snapshot::Snapshot(const mjModel& model, const mjData& data)
    : state_(mj_stateSize(&model, mjSTATE_INTEGRATION)) {
  GuardEngine([&] { mj_getState(&model, &data, state_.data(), mjSTATE_INTEGRATION); });
}

void Snapshot::Restore(const mjModel& model, mjData& data) const {
  TT_CHECK(static_cast<int>(state_.size()) == mj_stateSize(&model, mjSTATE_INTEGRATION));
  for (mjWarningStat& warning : data.warning) warning = {};
  GuardEngine([&] {
    mj_setState(&model, &data, state_.data(), mjSTATE_INTEGRATION);
    mj_forward(&model, &data);
    // mj_forward replaces the warm start; the first step must see the stored one.
    mj_setState(&model, &data, state_.data(), mjSTATE_INTEGRATION);
  });
}

}  // namespace tubetwin
