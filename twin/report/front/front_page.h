#pragma once

#include <string>

#include "twin/report/front/study_facts.h"
#include "twin/report/sections.h"

namespace tubetwin {

// What a customer reads first: a page of paper with what was run and how many parts an hour, and
// the sections that say where the time goes, what fails and what would help. HTML; of several
// variants each is told on its own, never their mix.

/// Title, parts an hour with definition and interval, pictures, facts, assumptions and what is not
/// modelled. `cards`: rates that stand beside.
std::string FrontPage(const ReportInput& input, const std::string& cards);

/// How far to trust the rates: what they rest on, what was checked, their intervals, seed and
/// purpose, and what the twin cannot tell.
std::string Credibility(const ReportInput& input);

/// Facts of all variants as a list: what they share once, what differs variant by variant. Empty
/// where nothing is known.
std::string FactTable(const ReportInput& input, FactTexts (*facts_of)(const StudySetup&));

/// The median pick as a Gantt chart, with the spread of every phase over all picks.
std::string CycleTime(const ReportInput& input);

/// Every failure class with rate, interval by rounds and its share of the time.
std::string FailureModes(const ReportInput& input);

/// How wide the interval is now and would be with twice and four times the rounds.
std::string MoreRounds(const ReportInput& input);

/// What would raise the rate most, by the measured times.
std::string Levers(const ReportInput& input);

}  // namespace tubetwin
