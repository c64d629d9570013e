#pragma once

#include <string>
#include <vector>

#include "twin/report/kept_attempt.h"
#include "twin/report/text.h"

namespace tubetwin {

/// Pieces that sections of pages are made of; all return HTML.

/// A rate in large, with its interval. `label` is HTML.
std::string RateCard(const std::string& label, const Rate& rate, const Pointer& at);

/// Where a rate and its interval lie between 0 and 100 %; nothing for no trial.
std::string RateMark(const Rate& rate);

/// A row of small facts: names (HTML) and values (HTML).
std::string FactList(const std::vector<std::pair<std::string, std::string>>& facts);

/// A section with a heading (HTML); nothing when `content` is empty.
std::string Section(const std::string& id, const std::string& heading, const std::string& content);

/// A chart with its caption (HTML); nothing when there is no chart.
std::string Figure(const std::string& chart, const std::string& caption);

/// "[] scan [] move ..." of CSS classes and names.
std::string Legend(const std::vector<std::pair<std::string, std::string>>& classes_and_names);

/// Failure classes as people say them: "several placed".
std::string FailureName(const std::string& failure);

/// The 3-D view with its controls, filled by report/viewer.js; nothing without a scene.
std::string ViewerHtml(const std::vector<ShownAttempt>& attempts);

/// Cards of the failures among `attempts`: picture, plan, load, film, the command that repeats it.
std::string GalleryHtml(const std::vector<ShownAttempt>& attempts);

/// The loads at the wrist of attempts as small charts; nothing without a trace.
std::string TracesHtml(const std::vector<ShownAttempt>& attempts);

/// The page's head line with the switch between light and dark. `eyebrow`, `title`: HTML.
std::string HeaderHtml(const std::string& eyebrow, const std::string& title,
                       const std::string& lead);

}  // namespace tubetwin
