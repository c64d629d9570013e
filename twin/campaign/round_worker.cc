#include "twin/campaign/round_worker.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>

#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "twin/campaign/record_line.h"

namespace tubetwin {
namespace {

/// Whether the error speaks of the machine rather than of the round: then running on is pointless,
/// and a row about it would be wrong on another machine.
bool SpeaksOfMachine(ErrorKind kind) {
  return kind != ErrorKind::kBadData && kind != ErrorKind::kInternal;
}

void Send(int fd, const Json& message) {
  const std::string line = message.dump() + "\n";
  std::size_t sent = 0;
  while (sent < line.size()) {
    const ssize_t step = ::write(fd, line.data() + sent, line.size() - sent);
    if (step < 0 && errno == EINTR) continue;
    if (step <= 0) ::_exit(1);  // The parent is gone, and with it everyone who would care.
    sent += static_cast<std::size_t>(step);
  }
}

void SendError(int fd, const Error& error) {
  Send(fd, Json{{SpeaksOfMachine(error.kind()) ? "refused" : "thrown", error.what()},
                {"kind", static_cast<int>(error.kind())}});
}

/// Everything that the child does; never returns into the parent's code.
[[noreturn]] void RunInChild(const RoundTask& task, const RoundFunction& run, int fd) {
  try {
    RoundOutput output = run(task);
    output.record.variant = task.variant;
    output.record.round = task.round;
    output.record.seed = task.seed;
    Send(fd, ToJson(output.record));
    if (output.afterwards) {
      std::string note;
      try {
        note = output.afterwards();
      } catch (const std::exception& e) {  // The rows are safe; a film less is no failure.
        note = e.what();
      }
      if (!note.empty()) Send(fd, Json{{"note", note}});
    }
  } catch (const Error& e) {
    SendError(fd, e);
  } catch (const std::exception& e) {
    const std::optional<Error> machine = MachineError(e);
    // Memory that one round lacks it lacks again: trying for ever helps nobody.
    const bool passes = machine && machine->kind() == ErrorKind::kInterrupted;
    SendError(fd, machine && !passes ? *machine : Error(ErrorKind::kInternal, e.what()));
  } catch (...) {
    Send(fd, Json{{"thrown", "an exception of unknown type"}});
  }
  ::_exit(0);  // No destructor and no buffer of the parent's may run twice.
}

}  // namespace

RoundWorker::RoundWorker(const RoundTask& task, const RoundFunction& run,
                         const std::function<void()>& in_child)
    : task_(task), began_s_(WallClock_s()) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(ErrorKind::kInternal, std::string("no pipe for a round: ") + std::strerror(errno));
  }
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    // The machine's limit on processes or memory: later there may be room.
    throw Error(ErrorKind::kInterrupted,
                std::string("no process for a round: ") + std::strerror(error));
  }
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // It died before that was set.
    for (const int ignored : {SIGINT, SIGTERM, SIGHUP}) ::signal(ignored, SIG_IGN);
    // What crashes is to die of it, whatever handlers the parent has.
    for (const int fatal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) ::signal(fatal, SIG_DFL);
    ::close(ends[0]);
    if (in_child) in_child();
    RunInChild(task, run, ends[1]);
  }
  ::close(ends[1]);
  fd_ = ends[0];
  ::fcntl(fd_, F_SETFL, O_NONBLOCK);
}

RoundWorker::~RoundWorker() {
  if (!ended_) {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(fd_);
}

double RoundWorker::seconds() const { return WallClock_s() - began_s_; }

std::optional<RoundWorker::Result> RoundWorker::Read() {
  char chunk[65536];
  for (;;) {
    const ssize_t got = ::read(fd_, chunk, sizeof chunk);
    if (got > 0) {
      buffer_.append(chunk, static_cast<std::size_t>(got));
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return TakeLine();  // Nothing more for now.
    break;
  }
  if (has_result_) TakeLine();  // A last note.
  std::optional<Result> result = has_result_ ? std::nullopt : TakeLine();
  int status = 0;
  rusage used{};
  while (::wait4(pid_, &status, 0, &used) < 0 && errno == EINTR) {
  }
  ended_ = true;
  peak_memory_kB_ = used.ru_maxrss;
  if (!has_result_) {
    has_result_ = true;
    return FromExit(status);
  }
  TakeLine();
  return result;
}

std::optional<RoundWorker::Result> RoundWorker::TakeLine() {
  const auto end = buffer_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  const Json message = Json::parse(buffer_.substr(0, end));
  buffer_.erase(0, end + 1);
  if (message.contains("note")) {
    note_ = message["note"];
    return std::nullopt;
  }
  has_result_ = true;
  Result result;
  if (message.contains("refused")) {
    result.kind = Result::Kind::kRefused;
    result.error.emplace(static_cast<ErrorKind>(message["kind"].get<int>()),
                         message["refused"].get<std::string>());
  } else if (message.contains("thrown")) {
    result.kind = Result::Kind::kThrown;
    result.reason = message["thrown"];
  } else {
    result.output.record = RecordFromJson(JsonView(message, "a round's process"));
  }
  return result;
}

RoundWorker::Result RoundWorker::FromExit(int status) const {
  Result result;
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    const bool own = number == SIGSEGV || number == SIGABRT || number == SIGFPE ||
                     number == SIGBUS || number == SIGILL || number == SIGSYS || number == SIGTRAP;
    result.kind = own ? Result::Kind::kCrashed : Result::Kind::kKilled;
    result.reason =
        "its process ended by signal " + std::to_string(number) + " (" + ::strsignal(number) + ")";
    return result;
  }
  result.kind = Result::Kind::kCrashed;
  result.reason = "its process ended with exit code " + std::to_string(WEXITSTATUS(status)) +
                  " before the round did";
  return result;
}

}  // namespace tubetwin
