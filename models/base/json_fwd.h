#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tubetwin {

// For headers that only name these types: the whole of json.h takes seconds to compile.

/// Keeps the order in which keys were added: files read like their description.
using Json = nlohmann::ordered_json;
class JsonView;

}  // namespace tubetwin
