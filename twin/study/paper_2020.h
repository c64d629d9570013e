#pragma once

#include <array>

#include "twin/statistics/statistics.h"

namespace tubetwin {

/// Figures of Leão, Costa, Sousa, Veiga, "Detecting and Solving Tube Entanglement in Bin Picking
/// Operations", Appl. Sci. 2020, 10, 2264, Tables 3 to 9, of one set of tubes. Arrays run over 7 to
/// 1 tubes in the bin.
struct PaperSet {
  Counts emptied;
  std::array<Counts, 7> first_attempt;      ///< Of picked tubes.
  std::array<int, 7> attempts;              ///< Picking attempts.
  std::array<int, 7> up_uses, escape_uses;  ///< With the simulator.
  Counts up, escape;                        ///< Successes with the simulator.
  std::array<int, 7> resolution_uses;
  Counts resolution;  ///< Successes.
  struct Time {
    double mean_s, sd_s;
  };
  /// All attempts, those without the simulator, those with it.
  std::array<Time, 3> total, planning;
  Time modelling;
};

extern const PaperSet kPaperSetA, kPaperSetB;

}  // namespace tubetwin
