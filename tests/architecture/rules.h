#pragma once

#include <string>
#include <vector>

#include "tests/architecture/tree.h"

namespace tubetwin::architecture {

/// The room of a path, by its longest known folder ("hw_bridge/drivers/ati/x.h" is
/// "hw_bridge/drivers"); empty for a path in no room.
std::string RoomOf(const std::string& path);

/// Each of these returns one sentence per break of its rule, naming file and include.

/// Includes between rooms follow the table of rooms; tests may include everything.
std::vector<std::string> CheckRoomIncludes(const std::vector<SourceFile>& files);

/// The table of rooms itself has no cycle.
std::vector<std::string> CheckNoCycles();

/// Only twin/round (and tests) see what is true in the twin.
std::vector<std::string> CheckTruthStaysInRound(const std::vector<SourceFile>& files);

/// A third-party header appears only in the rooms that may use it, and some only in .cc files; an
/// unknown third-party header is a break too.
std::vector<std::string> CheckThirdParty(const std::vector<SourceFile>& files);

/// Every room, for what holds for each.
std::vector<std::string> RoomNames();

/// Nothing in a source, build or text file names a place of one machine.
std::vector<std::string> CheckForbiddenWords(const std::string& path, const std::string& text);

}  // namespace tubetwin::architecture
