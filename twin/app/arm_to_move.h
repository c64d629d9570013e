#pragma once

#include <string>

#include "models/base/joint.h"
#include "twin/app/common.h"

namespace tubetwin {

/// The cell of a verb that moves its arm, by the verb's name: sound, and with an armed device for
/// an arm. Throws Error(kConfig) saying what it lacks.
Scenario LoadCellToMove(const std::string& cell_file, const std::string& verb,
                        const Common& common);

/// Prints the joints that the arm was brought to, in degrees.
void PrintJoints(const JointVector& q, const Common& common);

}  // namespace tubetwin
