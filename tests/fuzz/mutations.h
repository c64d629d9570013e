#pragma once

#include <functional>
#include <string>

#include "models/base/random.h"

namespace tubetwin {

/// One input damaged; `other` is another one, to take pieces from.
using Mutation =
    std::function<std::string(std::string input, const std::string& other, RandomStream& stream)>;

/// The main function of a fuzz target without a fuzzer: seeded mutations of ByteCorpus().
///   NAME_mutations COUNT [SEED [FILE]]  COUNT mutated inputs; each is written to FILE before it is
///                                       tried, so FILE is what killed the process
///   NAME_mutations --corpus FOLDER      the inputs that mutations start from, as files
int RunMutations(int argc, char** argv, const Mutation& mutated);

}  // namespace tubetwin
