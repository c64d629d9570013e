#pragma once

#include <string>

#include "models/files/embedded.h"
#include "tests/support/catch.h"

namespace tubetwin {

/// The text of a model file that comes with the program ("arms/hc10.toml").
inline std::string Shipped(const std::string& path) {
  for (const EmbeddedText& text : EmbeddedTexts()) {
    if (text.path == path) return std::string(text.text);
  }
  FAIL("no such text: " << path);
  return "";
}

}  // namespace tubetwin
