#pragma once

#include <string>
#include <vector>

#include "models/base/json.h"
#include "twin/round/records/round_record.h"

namespace tubetwin {

/// An attempt of which more than its row was kept, as a report shows it.
struct ShownAttempt {
  int row = 0;           ///< In its round's picks, from 0.
  std::string label;     ///< "variant 0, round 5, attempt 3"; "attempt 3" on a round's own page.
  std::string failure;   ///< Class of AttemptFacts; empty for a success.
  std::string believed;  ///< The pipeline's outcome.
  std::string reason;    ///< Why, in the pipeline's words; may be empty.
  std::string folder;    ///< Of its round, relative to the page; empty for the page's own.
  std::string film;      ///< Relative to the page; empty when there is none.
  std::string picture;   ///< JPEG or PNG in base 64, or empty.
  std::string trace_svg, plan_svg;  ///< Empty without recording.
  Json scene;                       ///< Of AttemptScene(), or null.
};

enum class ShownKind { kFailures, kSuccesses, kAll };

/// How much a page may show.
struct ShownLimits {
  int attempts = 24;
  std::size_t scene_bytes = 4'500'000;    ///< Of all scenes as text; the page stays below 10 MB.
  std::size_t picture_bytes = 2'000'000;  ///< Likewise.
};

/// Attempts of one round whose result folder is `round_folder`, failures before successes; `link`
/// is that folder as seen from the page ("" for the page's own). What the folder lacks (recording,
/// film, picture) stays empty, and so does what `limits` no longer allow, which are reduced by what
/// was taken. A damaged recording throws Error(kBadData).
std::vector<ShownAttempt> ShownAttempts(const RoundRecord& record, const std::string& round_folder,
                                        const std::string& link, ShownKind kind,
                                        ShownLimits& limits);

/// Command that repeats the round of result folder `link`, as a shell takes it, run beside the
/// page.
std::string RepeatCommand(const std::string& link);

}  // namespace tubetwin
