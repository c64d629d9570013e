#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "twin/round/records/throughput.h"

namespace tubetwin {

/// Seconds of something, in the order of a pick.
using NamedSeconds = std::vector<std::pair<std::string, double>>;

/// What the rows say of one attempt's time: the phases, or where an earlier version wrote the rows
/// what it knew (scan, move, weigh, settle).
NamedSeconds PhaseSeconds(const AttemptRecord& attempt);

/// Where the time of the rounds of one variant went. Phases and rest sum up to the whole.
struct TimeShares {
  int placed = 0;
  double total_s = 0.0;
  NamedSeconds phases_s;   ///< Of all attempts, failed ones included; the last is "compute".
  double rest_s = 0.0;     ///< In no attempt: the last look, waits for a person.
  bool has_phases = true;  ///< The rows tell the phases.
  struct Failure {
    std::string name;  ///< Class of AttemptFacts.
    int attempts = 0;
    int lost = 0;         ///< Tubes that came to lie outside.
    double time_s = 0.0;  ///< Of these attempts, cell and computing.
  };
  std::vector<Failure> failures;  ///< Most attempts first.
  double placed_attempt_s = 0.0;  ///< Mean of the attempts that placed one.
};
/// Nothing when no round can be counted (WorkOf()).
std::optional<TimeShares> TimeSharesOf(const std::vector<RoundFacts>& rounds, HourOf hour);

/// What the rate would be if one thing were otherwise and all else the same.
struct Lever {
  std::string what;  ///< "half the time of look", "no attempt ends with nothing held".
  double parts_per_hour = 0.0;
  double gain = 0.0;  ///< Over the rate as it is.
};
/// Each phase in half its time; each class of failures without the time of its attempts, and with
/// the tubes that these lost outside placed in the mean time of a pick. Largest gain first; those
/// that gain nothing are left out.
std::vector<Lever> LeversOf(const TimeShares& shares);

/// The attempt that stands for all that placed one tube: that of median time, of an even number the
/// quicker of the two in the middle.
struct MedianPick {
  const RoundRecord* record = nullptr;
  int row = 0;            ///< Of the round's attempts, from 0.
  NamedSeconds phases_s;  ///< With "compute" behind "look" where times are asked for.
  double total_s = 0.0;
  int picks = 0;  ///< Of which it is the median.
};
std::optional<MedianPick> MedianPickOf(const std::vector<RoundFacts>& rounds, HourOf hour);

}  // namespace tubetwin
