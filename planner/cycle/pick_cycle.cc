#include "planner/cycle/pick_cycle.h"

#include "planner/cycle/round.h"

namespace tubetwin {

RoundReport RunPickCycle(Cell& cell, const PickCycleSetup& setup, CycleObserver& observer) {
  Round round(cell, setup, observer);
  if (auto end = round.Begin()) return *end;
  for (;;) {
    if (setup.stop_requested && setup.stop_requested()) {
      return round.End(RoundEnd::kInterrupted, "asked to stop");
    }
    if (!round.AttemptsLeft()) return round.End(RoundEnd::kAttemptLimit, "too many attempts");
    if (auto end = round.Attempt()) return *end;
  }
}

RoundReport ResumeAttempt(Cell& cell, const PickCycleSetup& setup, const AttemptCheckpoint& state,
                          CycleObserver& observer) {
  Round round(cell, setup, observer);
  if (auto end = round.FinishStored(state)) return *end;
  return round.End(RoundEnd::kStored, "the attempt of the stored state is over");
}

}  // namespace tubetwin
