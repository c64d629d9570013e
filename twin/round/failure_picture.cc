#include "twin/round/failure_picture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "models/base/error.h"
#include "twin/round/round.h"

namespace tubetwin {

void DrawFailurePicture(const Recording& recording, int row, const AttemptRecord& attempt,
                        const std::string& round_folder) {
  constexpr int kWidth_px = 960;
  TT_CHECK(row >= 0 && row < static_cast<int>(recording.attempt_ends.size()));
  const int from = row == 0 ? 0 : recording.attempt_ends[row - 1];
  const int to = recording.attempt_ends[row];
  if (to <= from) return;
  const int frame =
      attempt.detection
          ? from +
                static_cast<int>(std::lround(attempt.detection->at_s * Recording::kFramesPerSecond))
          : to - Recording::kFramesPerSecond / 2;
  const auto folder = std::filesystem::path(round_folder) / "failures" / FailureFolderName(row);
  RenderSmallPicture(recording, std::clamp(frame, from, to - 1), kWidth_px,
                     (folder / "picture.jpg").string());
}

}  // namespace tubetwin
