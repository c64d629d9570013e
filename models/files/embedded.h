#pragma once

#include <string_view>
#include <vector>

namespace tubetwin {

/// A text file of this room that was compiled into the program, so that it can be moved anywhere.
struct EmbeddedText {
  std::string_view path;  ///< Relative to models, "arms/hc10.toml".
  std::string_view text;
};

/// All of them, in the order of models/CMakeLists.txt. Lives for the whole program.
const std::vector<EmbeddedText>& EmbeddedTexts();

}  // namespace tubetwin
