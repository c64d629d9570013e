#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "models/base/disk/build_id.h"
#include "models/base/error.h"
#include "twin/app/command_line/suggest.h"
#include "twin/app/common.h"
#include "twin/app/input/file_advice.h"

namespace tubetwin {
namespace {

constexpr const char* kDescription =
    "Example: tubetwin run --seed 1 --video --out out/first\n\n"
    "A digital twin of a robotic cell that empties a bin of entangled tubes, and the picking\n"
    "pipeline itself. `tubetwin help VERB` shows a verb with an example.";

int Run(int argc, char** argv) {
  CLI::App app(kDescription, "tubetwin");
  app.set_version_flag("--version", [] {
    return std::string("tubetwin ") + TUBETWIN_VERSION + ", build " + BuildId();
  });
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default(false);
  Common common;
  AddRunVerb(app, common);
  AddPileVerb(app, common);
  AddScanVerb(app, common);
  AddPerceiveVerb(app, common);
  AddPlanVerb(app, common);
  AddEvaluateVerb(app, common);
  AddCampaignVerb(app, common);
  AddReproduceVerb(app, common);
  AddEmulateVerb(app, common);
  AddReplayVerb(app, common);
  AddRenderVerb(app, common);
  AddPartVerb(app, common);
  AddDoctorVerb(app, common);
  AddJogVerb(app, common);
  AddHomeVerb(app, common);
  AddCalibrateVerb(app, common);
  AddConfigVerb(app, common);
  std::vector<std::string> words = HelpWords({argv + 1, argv + argc});
  const auto refuse = [](const std::string& why) {
    Complain(why + "\nTry `tubetwin help`, or `tubetwin help VERB`.");
    return static_cast<int>(ErrorKind::kUsage);
  };
  // The parser's own words name neither verbs nor options.
  if (const std::string why = MisspeltVerb(app, words); !why.empty()) return refuse(why);
  try {
    // It takes the last word first.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    const std::string why = MisspeltOption(app, words);
    return refuse(why.empty() ? e.what() : why);
  }
  RefuseUnusedKeys(common.overrides, common.used_keys, common.verb);
  RefuseSaidTwice(*VerbOf(app, words).verb, common.overrides);
  try {
    return common.action();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kConfig) throw;
    throw Error(error.kind(), error.what() + AdviceForWords(error.what(), common.verb, words));
  }
}

int RunAndTell(int argc, char** argv) {
  const auto fail = [](const Error& error) {
    Complain(error.what());
    return static_cast<int>(error.kind());
  };
  try {
    return Run(argc, argv);
  } catch (const Error& e) {
    return fail(e);
  } catch (const std::exception& e) {
    if (const auto machine = MachineError(e)) return fail(*machine);
    Complain(std::string("internal error: ") + e.what());
    return static_cast<int>(ErrorKind::kInternal);
  }
}

/// Where standard input, output or messages are closed, the next file that is opened would get
/// their number, and with it every line that is printed.
void OpenStandardFiles() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF) {
      [[maybe_unused]] const int opened = ::open("/dev/null", O_RDWR);  // The lowest free number.
    }
  }
}

/// The exit code after all that was printed has left the program: whoever reads what did not
/// arrive must not take it for whole.
int CloseOutput(int code) {
  bool whole = std::ferror(stdout) == 0;
  errno = 0;
  whole = std::fflush(stdout) == 0 && whole;
  int error = errno;
  std::cout.flush();  // It keeps nothing back, but knows what it could not write.
  whole = std::cout.good() && whole;
  // What a file server refuses only when a file is closed.
  const int copy = ::dup(STDOUT_FILENO);
  if (copy >= 0 && ::close(copy) != 0 && whole) {
    whole = false;
    error = errno;
  }
  if (whole) return code;
  // The library keeps no reason of what failed before: the next byte has the same.
  if (error == 0 && ::write(STDOUT_FILENO, "\n", 1) < 0) error = errno;
  Complain(std::string("standard output cannot be written: ") +
           (error != 0 ? std::strerror(error) : "what was printed is not whole"));
  return code == 0 ? static_cast<int>(ErrorKind::kIo) : code;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  tubetwin::OpenStandardFiles();
  std::signal(SIGXFSZ, SIG_IGN);  // A limit on the size of files is told like a full disk.
  return tubetwin::CloseOutput(tubetwin::RunAndTell(argc, argv));
}
