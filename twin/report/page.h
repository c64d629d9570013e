#pragma once

#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/report/kept_attempt.h"

namespace tubetwin {

/// The whole page: one file that asks no server for anything, which its Content-Security-Policy
/// makes sure of (inline style and script, nothing else). `title` is text, `body` is HTML, `data`
/// is what the scripts draw; they put texts in as text only.
std::string ReportPage(const std::string& title, const std::string& body, const Json& data);

/// What the scripts need to show attempts: {attempts: [{label, failure, scene}], cells, pictures};
/// shapes that several attempts share stand there once.
Json AttemptData(const std::vector<ShownAttempt>& attempts);

}  // namespace tubetwin
