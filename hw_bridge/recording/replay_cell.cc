#include "hw_bridge/recording/replay_cell.h"

#include <deque>
#include <exception>
#include <tuple>
#include <utility>

#include "hw_bridge/recording/command_difference.h"
#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

/// More reads than this between two commands are no recording of a pick cycle.
constexpr std::size_t kMaxReads = 1000000;

/// The recording under the replayed devices.
class Script {
 public:
  explicit Script(CellRecording recording) : recording_(std::move(recording)) {
    std::get<std::optional<TimeRead>>(newest_) = TimeRead{};  // Rounds begin at 0.
  }

  /// The answer to a read: the next one of its kind before the next command, else the newest.
  template <typename Event>
  Event Read() {
    CheckGoing();
    Load();
    for (auto event = reads_.begin(); event != reads_.end(); ++event) {
      auto* found = std::get_if<Event>(&*event);
      if (found == nullptr) continue;
      std::optional<Event>& newest = std::get<std::optional<Event>>(newest_);
      newest = std::move(*found);
      reads_.erase(event);
      ++tally.reads;
      return *newest;
    }
    const std::optional<Event>& newest = std::get<std::optional<Event>>(newest_);
    if (newest) {
      ++tally.more_reads;
      return *newest;
    }
    if (!command_ && !recording_.complete()) RunOut();
    Differ({"read", "nothing of it so far", "a read"}, Event{});
  }

  /// The recorded command that `asked` is, with its answer.
  template <typename Event>
  Event Command(const Event& asked_command) {
    CheckGoing();
    Load();
    const CellEvent asked = asked_command;
    if (!command_) {
      if (!recording_.complete()) RunOut();
      Differ({"kind", "the end of the round", Describe(asked)}, asked);
    }
    if (const auto difference = DifferenceOf(*command_, asked)) Differ(*difference, asked);
    tally.missing_reads += reads_.size();
    reads_.clear();
    ++tally.commands;
    Event recorded = std::get<Event>(std::move(*command_));
    command_.reset();
    loaded_ = false;
    return recorded;
  }

  /// The cell's time; never throws: destructors ask for it, also when the replay is over. What goes
  /// wrong on the way is thrown at the next call of a device.
  TimeNs Now() noexcept {
    if (tally.difference || tally.ran_out || failure_) return now;
    try {
      now = Read<TimeRead>().now;
    } catch (...) {
      failure_ = std::current_exception();
    }
    return now;
  }

  void Finish() {
    if (tally.difference || tally.ran_out) return;
    Load();
    if (command_) {
      Note({"kind", Describe(*command_), "the end of the round"}, KindOf(*command_));
    }
    tally.missing_reads += reads_.size();
  }

  /// Time has passed: who asks for it without a recorded read hears this.
  void SetNow(TimeNs t) {
    now = t;
    std::get<std::optional<TimeRead>>(newest_) = TimeRead{t};
  }

  const CellRecording& recording() const { return recording_; }

  ReplayTally tally;
  TimeNs now{0};  ///< Of the newest answer.
  std::string caption;

 private:
  /// Reads ahead up to the next command.
  void Load() {
    if (loaded_) return;
    loaded_ = true;
    while (std::optional<CellEvent> event = recording_.Next()) {
      if (const auto* note = std::get_if<PipelineNote>(&*event);
          note != nullptr && note->kind == PipelineNote::Kind::kCaption) {
        continue;
      }
      if (!IsRead(*event)) {
        command_ = std::move(event);
        return;
      }
      if (reads_.size() == kMaxReads) {
        throw Error(ErrorKind::kBadData, recording_.path() + ": " + std::to_string(kMaxReads) +
                                             " reads without a command between them");
      }
      reads_.push_back(std::move(*event));
    }
  }

  void CheckGoing() const {
    if (tally.difference) throw ReplayOver(ToString(*tally.difference));
    if (tally.ran_out) throw ReplayOver("the recording was cut short here");
    if (failure_) std::rethrow_exception(failure_);
  }

  void Note(const CommandDifference& found, const std::string& kind) {
    tally.difference = ReplayDifference{kind,        now,     found.field,   found.recorded,
                                        found.asked, caption, tally.commands};
  }

  [[noreturn]] void Differ(const CommandDifference& found, const CellEvent& asked) {
    Note(found, KindOf(asked));
    throw ReplayOver(ToString(*tally.difference));
  }

  [[noreturn]] void RunOut() {
    tally.ran_out = true;
    throw ReplayOver("the recording was cut short here");
  }

  CellRecording recording_;
  std::deque<CellEvent> reads_;       ///< Before the next command.
  std::optional<CellEvent> command_;  ///< The next one; nothing at the end.
  bool loaded_ = false;
  std::exception_ptr failure_;
  std::tuple<std::optional<TimeRead>, std::optional<ArmRead>, std::optional<GripperRead>,
             std::optional<WristRead>, std::optional<ScanStatusRead>,
             std::optional<ScanFailureRead>>
      newest_;
};

class ReplayedClock : public CellClock {
 public:
  explicit ReplayedClock(Script& script) : script_(script) {}
  TimeNs Now() const override { return script_.Now(); }
  void AdvanceTo(TimeNs t) override {
    const TimeAdvanced done = script_.Command(TimeAdvanced{t, t});
    script_.SetNow(done.now);
  }

 private:
  Script& script_;
};

class ReplayedArm : public Arm {
 public:
  explicit ReplayedArm(Script& script) : script_(script) {}
  ArmState State() const override { return script_.Read<ArmRead>().state; }
  CommandResult Start(const CheckedTrajectory& trajectory) override {
    return script_.Command(ArmStarted{script_.now, false, trajectory.trajectory(), {}}).answer;
  }
  CommandResult Append(const CheckedTrajectory& continuation) override {
    return script_.Command(ArmStarted{script_.now, true, continuation.trajectory(), {}}).answer;
  }
  void Stop(StopKind kind) override { script_.Command(ArmStopped{script_.now, kind}); }
  CommandResult Recover() override { return script_.Command(ArmRecovered{script_.now, {}}).answer; }
  void SetPayload(double mass_kg, const Vector3& p_FC) override {
    script_.Command(PayloadSet{script_.now, mass_kg, p_FC});
  }

 private:
  Script& script_;
};

class ReplayedGripper : public Gripper {
 public:
  explicit ReplayedGripper(Script& script) : script_(script) {}
  void Command(const GripperCommand& command) override {
    script_.Command(GripperCommanded{script_.now, command});
  }
  GripperState State() const override { return script_.Read<GripperRead>().state; }

 private:
  Script& script_;
};

class ReplayedWrist : public ForceTorqueSensor {
 public:
  explicit ReplayedWrist(Script& script) : script_(script) {}
  WrenchSample Read() const override { return script_.Read<WristRead>().sample; }

 private:
  Script& script_;
};

class ReplayedScanner : public Scanner {
 public:
  explicit ReplayedScanner(Script& script) : script_(script) {}
  CommandResult Trigger() override {
    return script_.Command(ScanTriggered{script_.now, {}}).answer;
  }
  ScanStatus Status() const override { return script_.Read<ScanStatusRead>().status; }
  OrganizedCloud Take() override {
    return std::move(script_.Command(ScanTaken{script_.now, {}}).cloud_S);
  }
  std::string FailureReason() const override { return script_.Read<ScanFailureRead>().reason; }

 private:
  Script& script_;
};

}  // namespace

std::string ToString(const ReplayDifference& d) {
  return "at " + Number(Seconds(d.time)) + " s (" + d.after + "), after " +
         std::to_string(d.command) + " commands that agreed: " + d.kind + ", " + d.field +
         ": recorded " + d.recorded + ", asked " + d.asked;
}

struct ReplayCell::Impl {
  explicit Impl(CellRecording recording)
      : script(std::move(recording)),
        clock(script),
        arm(script),
        gripper(script),
        wrist(script),
        scanner(script),
        cell{clock,
             arm,
             gripper,
             wrist,
             scanner,
             script.recording().header().model,
             script.recording().header().bin,
             {}} {}

  Script script;
  ReplayedClock clock;
  ReplayedArm arm;
  ReplayedGripper gripper;
  ReplayedWrist wrist;
  ReplayedScanner scanner;
  Cell cell;
};

ReplayCell::ReplayCell(CellRecording recording)
    : impl_(std::make_unique<Impl>(std::move(recording))) {}
ReplayCell::~ReplayCell() = default;

Cell& ReplayCell::cell() { return impl_->cell; }
const CellRecordingHeader& ReplayCell::header() const { return impl_->script.recording().header(); }
const ReplayTally& ReplayCell::tally() const { return impl_->script.tally; }

void ReplayCell::Caption(const std::string& text) { impl_->script.caption = text; }

void ReplayCell::Result(const std::string& text) {
  impl_->script.Command(PipelineNote{PipelineNote::Kind::kResult, impl_->script.now, text});
}

void ReplayCell::Finish() { impl_->script.Finish(); }

}  // namespace tubetwin
