#pragma once

#include "scenes/engine/mj_handles.h"
#include "scenes/tube_body.h"

namespace tubetwin::test {

/// Holds a hose's first link where it is in the world; the softer the lighter that link is.
inline void ClampFirstLink(mjSpec& spec, const TubeBody& hose) {
  mjsEquality* weld = mjs_addEquality(&spec, nullptr);
  weld->type = mjEQ_WELD;
  weld->objtype = mjOBJ_BODY;
  SetString(weld->name1, hose.body_names()[0]);
  weld->solref[0] = 0.004;
  weld->solimp[0] = weld->solimp[1] = 0.9999;
}

}  // namespace tubetwin::test
