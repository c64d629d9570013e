#pragma once

#include <string>

#include "tests/support/temporary_folder.h"

namespace tubetwin {

struct Outcome {
  int code = 0;
  std::string out, err;
};

/// Runs `tubetwin ARGUMENTS` in `folder`; `environment` goes before it ("A=b "). What `files` say
/// ("> /dev/full", "2>&-") is used instead of the two that the outcome is read from.
Outcome RunProgram(const TemporaryFolder& folder, const std::string& arguments,
                   const std::string& environment = "", const std::string& files = "");

/// Writes a file into `folder`.
void Write(const TemporaryFolder& folder, const std::string& name, const std::string& text);

int Lines(const std::string& text);

/// Checks that the program ends with `code` and one to four lines on stderr that contain `said`.
void CheckRefused(const TemporaryFolder& folder, const std::string& arguments, int code,
                  const std::string& said, const std::string& environment = "");

}  // namespace tubetwin
