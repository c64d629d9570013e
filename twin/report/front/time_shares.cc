#include "twin/report/front/time_shares.h"

#include <algorithm>
#include <map>

#include "twin/report/parts.h"

namespace tubetwin {
namespace {

double Sum(const NamedSeconds& seconds) {
  double sum = 0.0;
  for (const auto& [name, s] : seconds) sum += s;
  return sum;
}

double ComputeSeconds(const AttemptFacts& facts, HourOf hour) {
  const bool told = facts.timing != nullptr && facts.timing->compute_s;
  return hour == HourOf::kCellAndComputing && told ? facts.timing->compute_s->total : 0.0;
}

double AttemptSeconds(const AttemptFacts& facts, HourOf hour) {
  return Sum(PhaseSeconds(*facts.attempt)) + ComputeSeconds(facts, hour);
}

void Add(const NamedSeconds& more, NamedSeconds& sum) {
  for (const auto& [name, seconds] : more) {
    const auto found = std::find_if(sum.begin(), sum.end(),
                                    [&name = name](const auto& one) { return one.first == name; });
    if (found == sum.end()) {
      sum.emplace_back(name, seconds);
    } else {
      found->second += seconds;
    }
  }
}

void AddRound(const RoundFacts& round, HourOf hour, TimeShares& out,
              std::map<std::string, TimeShares::Failure>& failures) {
  for (const AttemptFacts& facts : round.attempts) {
    out.has_phases = out.has_phases && facts.attempt->phases_s.has_value();
    Add(PhaseSeconds(*facts.attempt), out.phases_s);
    if (facts.failure.empty()) continue;
    TimeShares::Failure& failure = failures[facts.failure];
    failure.name = facts.failure;
    ++failure.attempts;
    failure.lost += std::max(0, facts.outside);
    failure.time_s += AttemptSeconds(facts, hour);
  }
}

}  // namespace

NamedSeconds PhaseSeconds(const AttemptRecord& attempt) {
  NamedSeconds out;
  if (attempt.phases_s) {
    for (const NamedPhase& named : AttemptPhases()) {
      out.emplace_back(named.name, *attempt.phases_s.*named.phase);
    }
  } else if (attempt.sim_s) {
    out = {{"scan", attempt.sim_s->scan},
           {"move", attempt.sim_s->move},
           {"weigh", attempt.sim_s->weigh},
           {"settle", attempt.sim_s->settle}};
  }
  return out;
}

std::optional<TimeShares> TimeSharesOf(const std::vector<RoundFacts>& rounds, HourOf hour) {
  TimeShares out;
  std::map<std::string, TimeShares::Failure> failures;
  double compute_s = 0.0, placed_s = 0.0;
  int placed_attempts = 0;
  for (const RoundFacts& round : rounds) {
    const std::optional<RoundWork> work = WorkOf(round, hour);
    if (!work) continue;
    out.placed += work->placed;
    out.total_s += work->cell_s + work->compute_s;
    compute_s += work->compute_s;
    AddRound(round, hour, out, failures);
    for (const AttemptFacts& facts : round.attempts) {
      if (!facts.PlacedOne()) continue;
      placed_s += AttemptSeconds(facts, hour);
      ++placed_attempts;
    }
  }
  if (!(out.total_s > 0.0)) return std::nullopt;
  if (placed_attempts > 0) out.placed_attempt_s = placed_s / placed_attempts;
  if (hour == HourOf::kCellAndComputing) out.phases_s.emplace_back("compute", compute_s);
  out.rest_s = std::max(0.0, out.total_s - Sum(out.phases_s));
  for (auto& [name, failure] : failures) out.failures.push_back(failure);
  std::stable_sort(out.failures.begin(), out.failures.end(),
                   [](const auto& a, const auto& b) { return a.attempts > b.attempts; });
  return out;
}

std::vector<Lever> LeversOf(const TimeShares& shares) {
  const double now = 3600.0 * shares.placed / shares.total_s;
  std::vector<Lever> out;
  const auto add = [&](const std::string& what, double placed, double time_s) {
    if (!(time_s > 0.0)) return;
    const double rate = 3600.0 * placed / time_s;
    if (rate > now) out.push_back({what, rate, rate - now});
  };
  for (const auto& [phase, seconds] : shares.phases_s) {
    add("half the time of " + phase, shares.placed, shares.total_s - 0.5 * seconds);
  }
  for (const TimeShares::Failure& failure : shares.failures) {
    add("no attempt ends as " + FailureName(failure.name), shares.placed + failure.lost,
        shares.total_s - failure.time_s + failure.lost * shares.placed_attempt_s);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Lever& a, const Lever& b) { return a.gain > b.gain; });
  return out;
}

std::optional<MedianPick> MedianPickOf(const std::vector<RoundFacts>& rounds, HourOf hour) {
  std::vector<MedianPick> picks;
  for (const RoundFacts& round : rounds) {
    for (std::size_t i = 0; i < round.attempts.size(); ++i) {
      const AttemptFacts& facts = round.attempts[i];
      if (!facts.PlacedOne() || !facts.attempt->sim_s) continue;
      MedianPick pick;
      pick.record = round.record;
      pick.row = static_cast<int>(i);
      pick.phases_s = PhaseSeconds(*facts.attempt);
      if (hour == HourOf::kCellAndComputing && !pick.phases_s.empty()) {
        // Perception and planning come between the look and the reach.
        pick.phases_s.insert(pick.phases_s.begin() + 1, {"compute", ComputeSeconds(facts, hour)});
      }
      pick.total_s = Sum(pick.phases_s);
      picks.push_back(std::move(pick));
    }
  }
  if (picks.empty()) return std::nullopt;
  std::stable_sort(picks.begin(), picks.end(),
                   [](const MedianPick& a, const MedianPick& b) { return a.total_s < b.total_s; });
  MedianPick out = picks[(picks.size() - 1) / 2];
  out.picks = static_cast<int>(picks.size());
  return out;
}

}  // namespace tubetwin
