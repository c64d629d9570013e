#pragma once

#include <functional>
#include <string>

#include "models/base/config/config.h"
#include "models/base/json.h"

namespace tubetwin {

/// JSON Schema of the keys that a model file's table lists. A key has its default, or is required
/// where there is none to fall back on (kNotGiven, an empty text, a number that is not allowed).
Json TableSchema(const std::function<void(ConfigVisitor&)>& visit);

/// Adds `[[key]]`, tables of which there are `min_count` to `max_count` (0: any number).
void AddTables(const std::string& key, const std::string& doc, Json table, int min_count,
               int max_count, Json& schema);

// Of each kind of file, next to its reader.
Json CellFileSchema();
Json ArmFileSchema();
Json GripperFileSchema();
Json WristFileSchema();
Json ScannerFileSchema();
Json ShapeSchema(const std::function<void(ConfigVisitor&)>& more = {});

}  // namespace tubetwin
