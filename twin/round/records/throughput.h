#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "models/base/random.h"
#include "twin/round/records/attempt_facts.h"
#include "twin/statistics/statistics.h"

namespace tubetwin {

/// What an hour is made of.
enum class HourOf {
  kCell,              ///< Time of the cell alone: the same on every machine.
  kCellAndComputing,  ///< That and what perception and planning took on the machine that ran it.
};
/// What is counted, in a sentence for files and pages.
const char* DefinitionOf(HourOf hour);

/// What one round counts for.
struct RoundWork {
  int placed = 0;        ///< Tubes that it placed; of one resumed in the middle, since then.
  double cell_s = 0.0;   ///< From its begin to its end: looks, failures and waits included.
  double compute_s = 0;  ///< Of all attempts and of the last look.
};
/// Nothing of a crashed round, and of one whose computing times nobody kept where they are asked
/// for: how long it took is not known.
std::optional<RoundWork> WorkOf(const RoundFacts& round, HourOf hour);

/// Placed tubes an hour, over all rounds together.
struct PartsPerHour {
  HourOf hour = HourOf::kCell;
  int rounds = 0, left_out = 0;  ///< Rounds counted, and those of which WorkOf() says nothing.
  int placed = 0;
  double time_s = 0.0;
  std::optional<double> value;  ///< Nothing: no time at all.
  /// 95 % interval of a bootstrap over rounds; nothing for fewer than two, or without a stream.
  std::optional<Interval> interval;
};

/// Parts an hour of the rounds. `random`: same stream, same interval. `times`: the interval that so
/// many times as many rounds of the same kind would give (RatioBootstrap95()).
PartsPerHour PartsPerHourOf(const std::vector<RoundFacts>& rounds, HourOf hour,
                            const std::optional<RandomStream>& random, int times = 1);

/// As a person reads it: "62 [58, 66]", "62 (one round: no interval)", "-".
std::string ToText(const PartsPerHour& rate);
/// A rate as people write it: whole from 10 on, else with one digit.
std::string ToText(double parts_per_hour);

/// {value, low, high, definition, rounds, left_out}; null where there is no value or no interval.
Json ToJson(const PartsPerHour& rate);

}  // namespace tubetwin
