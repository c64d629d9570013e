#pragma once

#include <string>

#include "models/base/json_fwd.h"
#include "twin/render/recording.h"

namespace tubetwin {

/// Draws ROUND_FOLDER/failures/attempt_NNN/picture.jpg: the cell when the pipeline decided how many
/// tubes hang, or half a second before the attempt ended when it never did. `row` counts rows of
/// picks.jsonl from 0, `pick` is that row. Throws as RenderSmallPicture() does.
void DrawFailurePicture(const Recording& recording, int row, const Json& pick,
                        const std::string& round_folder);

}  // namespace tubetwin
