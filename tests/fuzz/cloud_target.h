#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tubetwin {

/// Gives `bytes` to the PCD and the PLY reader. A reader may refuse them with Error(kBadData) in at
/// most four lines, or return a cloud that is whole: sizes that agree, a rigid finite pose, points
/// that are finite or invalid in all three coordinates. Anything else aborts the process, as a
/// fuzzer wants it.
void TryCloudBytes(std::string_view bytes);

/// Small files of every kind that the readers take, made by the writers and by hand: where
/// mutations start.
std::vector<std::string> CloudCorpus();

}  // namespace tubetwin
