#pragma once

#include <string>

#include "twin/render/recording.h"
#include "twin/round/records/attempt_record.h"

namespace tubetwin {

/// Draws ROUND_FOLDER/failures/attempt_NNN/picture.jpg: the cell when the pipeline decided how many
/// tubes hang, or half a second before the attempt ended when it never did. `row` counts rows of
/// picks.jsonl from 0, `attempt` is that row. Throws as RenderSmallPicture() does.
void DrawFailurePicture(const Recording& recording, int row, const AttemptRecord& attempt,
                        const std::string& round_folder);

}  // namespace tubetwin
