#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/base/json_fwd.h"
#include "models/bin.h"
#include "perception/scene/tube_scene.h"
#include "planner/pick/pick_plan.h"
#include "twin/report/front/study_facts.h"

namespace tubetwin {

/// What a rehearsal saw and would do. Nothing of it was sent to arm or gripper.
struct DryRunStory {
  Bin bin;
  std::optional<TubeScene> scene;  ///< Nothing: it came to no look.
  std::optional<PickPlan> plan;    ///< Of the last look; nothing: none was found.
  std::string end;                 ///< How the rehearsal ended, where there is no plan.
  FactTexts checked;               ///< What following the motions in thought showed.
  std::string told;                ///< The same as one text.
  Json figures;                    ///< dry_run.json, for scripts.
};

/// "saw 7 tubes (5 free, 1 weak, 1 strong); would take tube 3 (free) by motion up, grasped at x 12,
/// y -34, z 56 mm in the bin".
std::string DryRunText(const DryRunStory& story);

/// The page of a rehearsal: what was seen, what would be done, what was checked, and that nothing
/// was sent. `setup` says what cell it is.
std::string DryRunHtml(const DryRunStory& story, const StudySetup& setup);

}  // namespace tubetwin
