#pragma once

#include <string>

#include "scenes/engine/mj_handles.h"

namespace tubetwin {

/// The cell of a recording, whoever wrote it, from its XML. The engine's parser would open any file
/// that the text names and take any memory that it asks for; so only those elements are let through
/// that the program's own cells consist of, none of which names files, and sizes within limits.
/// Throws Error(kBadData) naming `source`, line and what is not allowed.
MjSpec ParseCellXml(const std::string& xml, const std::string& source);

}  // namespace tubetwin
