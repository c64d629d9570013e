#include "tests/support/program.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "models/base/files.h"
#include "tests/support/catch.h"

namespace tubetwin {

Outcome RunProgram(const TemporaryFolder& folder, const std::string& arguments,
                   const std::string& environment, const std::string& files) {
  const std::string command = "cd '" + folder.path() + "' && " + environment + "'" +
                              TUBETWIN_BINARY "' " + arguments + " > out.txt 2> err.txt " + files;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadFile(folder.path() + "/out.txt"),
          ReadFile(folder.path() + "/err.txt")};
}

void Write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.path() + "/" + name, std::ios::binary) << text;
}

int Lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

void CheckRefused(const TemporaryFolder& folder, const std::string& arguments, int code,
                  const std::string& said, const std::string& environment) {
  INFO(arguments);
  const Outcome outcome = RunProgram(folder, arguments, environment);
  INFO(outcome.err);
  CHECK(outcome.code == code);
  CHECK(outcome.err.find(said) != std::string::npos);
  CHECK(Lines(outcome.err) >= 1);
  CHECK(Lines(outcome.err) <= 4);
}

}  // namespace tubetwin
