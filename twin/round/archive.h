#pragma once

#include <string>
#include <vector>

#include "twin/round/scenario.h"

namespace tubetwin {

/// A file of the result folder that belongs to its configuration.
struct ArchivedFile {
  std::string name;  ///< In the result folder.
  std::string text;
};

/// Names the scenario's own files (meshes, part, cell model with its devices) by what their copies
/// in the result folder are called, so that the resolved configuration runs wherever the folder is
/// moved, and gives the copies. Shipped ones stay names. Throws
/// Error(kMissing | kIo) for a file that cannot be read.
std::vector<ArchivedFile> ArchiveInputs(Scenario& scenario);

}  // namespace tubetwin
