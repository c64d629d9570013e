#pragma once

#include <string>

#include "tests/support/temporary_folder.h"

namespace tubetwin {

/// One straight tube of pvc_a in a small bin, as a file.
inline constexpr char kPile[] =
    R"({"schema": "tubetwin/pile/1", "bin": {"size_m": [0.77, 0.58, 0.09]}, "part": "pvc_a",
 "tubes": [{"id": 4, "centerline_m": [[-0.24, 0, 0.0125], [0.26, 0, 0.0125]], "radius_m": 0.0125, "mass_kg": 0.055}],
 "seed": 1, "settled": false})";

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
