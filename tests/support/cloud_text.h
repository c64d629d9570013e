#pragma once

#include <optional>
#include <string>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {

/// The cloud that a file of this name (its ending is the format) and content holds.
inline OrganizedCloud CloudIn(const std::string& name, const std::string& content,
                              std::optional<double> unit_m = std::nullopt) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / name, content);
  return ReadCloud(folder / name, unit_m);
}

/// Checks that such a file is refused as bad data, by its name and what is `said`.
inline void CheckBadCloud(const std::string& name, const std::string& content,
                          const std::string& said) {
  INFO(content.substr(0, 400));
  try {
    CloudIn(name, content);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kBadData);
    CHECK_THAT(error.what(), Catch::Matchers::Contains(said));
    CHECK_THAT(error.what(), Catch::Matchers::Contains(name));
    return;
  }
  FAIL("not refused");
}

/// Checks that such a file holds (0.1, 0.2, 0.3) and (0.4, 0.5, 0.6), in metres, and nothing else.
inline void CheckTwoPoints(const std::string& name, const std::string& content,
                           std::optional<double> unit_m = std::nullopt) {
  INFO(content.substr(0, 400));
  const OrganizedCloud cloud = CloudIn(name, content, unit_m);
  REQUIRE(cloud.size() == 2);
  CHECK(cloud.p_SP[0] == Eigen::Vector3f(0.1f, 0.2f, 0.3f));
  CHECK(cloud.p_SP[1] == Eigen::Vector3f(0.4f, 0.5f, 0.6f));
}

/// The text, with the first `from`, which must be there, replaced.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace tubetwin
