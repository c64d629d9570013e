#pragma once

#include <chrono>
#include <string>
#include <variant>

#include "hw_bridge/codecs/decode_error.h"

namespace tubetwin {

/// The body of http://host:port`path`, 64 KB at most; fails with a reason for any answer but 200
/// and after `limit`.
std::variant<std::string, DecodeError> HttpGet(const std::string& host, int port,
                                               const std::string& path,
                                               std::chrono::nanoseconds limit);

}  // namespace tubetwin
