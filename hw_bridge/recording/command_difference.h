#pragma once

#include <optional>
#include <string>

#include "hw_bridge/recording/cell_event.h"

namespace tubetwin {

/// The first field in which two commands differ.
struct CommandDifference {
  std::string field, recorded, asked;
};

/// "arm start", "gripper command": what people call the kind of event.
std::string KindOf(const CellEvent& event);

/// Compares what was commanded, not when and not the answers. Different kinds differ in "kind".
/// Numbers are compared exactly.
std::optional<CommandDifference> DifferenceOf(const CellEvent& recorded, const CellEvent& asked);

/// A command in a few words, for people.
std::string Describe(const CellEvent& event);

}  // namespace tubetwin
