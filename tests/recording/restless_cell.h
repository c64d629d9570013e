#pragma once

#include <memory>
#include <string>

#include "hw_bridge/cell/cell.h"

namespace tubetwin::test {

/// A cell whose devices say something else at every look: numbers in the devices' steps, numbers in
/// none, negative zeros, repeats, faults, refusals. The same for the same seed. What it is told
/// changes nothing but the arm's trajectory; scans are ready at the third look.
class RestlessCell {
 public:
  explicit RestlessCell(std::uint64_t seed, int cloud_width = 37, int cloud_height = 11);
  ~RestlessCell();
  Cell& cell();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A fixed procedure of a few hundred calls that uses every function of every device, also after
/// what they answer. `rounds`: how often. Returns what it heard, as text.
std::string Exercise(Cell& cell, int rounds);

/// The same, but command number `planted` from 0 is a little different.
std::string ExerciseWithPlant(Cell& cell, int rounds, int planted);

}  // namespace tubetwin::test
