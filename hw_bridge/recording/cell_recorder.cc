#include "hw_bridge/recording/cell_recorder.h"

#include <optional>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

/// What the recording devices share.
struct Tape {
  CellRecordingWriter writer;
  CellClock& clock;

  /// Of writing. The cell goes on unrecorded: no device may be left alone in the middle of a motion
  /// because a disk is full.
  std::optional<Error> failure = {};

  void Add(const CellEvent& event) {
    if (failure) return;
    try {
      writer.Add(event);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kIo) throw;
      failure = error;
    }
  }
  /// Writes down a read's answer and hands it on.
  template <typename Event, typename Answer>
  Answer Read(Answer answer) {
    Add(Event{answer});
    return answer;
  }
  TimeNs now() const { return clock.Now(); }
};

class RecordedClock : public CellClock {
 public:
  explicit RecordedClock(Tape& tape) : tape_(tape) {}
  TimeNs Now() const override { return tape_.Read<TimeRead>(tape_.clock.Now()); }
  void AdvanceTo(TimeNs t) override {
    tape_.clock.AdvanceTo(t);
    tape_.Add(TimeAdvanced{t, tape_.now()});
  }

 private:
  Tape& tape_;
};

class RecordedArm : public Arm {
 public:
  RecordedArm(Arm& inner, Tape& tape) : inner_(inner), tape_(tape) {}
  ArmState State() const override { return tape_.Read<ArmRead>(inner_.State()); }
  CommandResult Start(const CheckedTrajectory& trajectory) override {
    const TimeNs at = tape_.now();
    const CommandResult answer = inner_.Start(trajectory);
    tape_.Add(ArmStarted{at, false, trajectory.trajectory(), answer});
    return answer;
  }
  CommandResult Append(const CheckedTrajectory& continuation) override {
    const TimeNs at = tape_.now();
    const CommandResult answer = inner_.Append(continuation);
    tape_.Add(ArmStarted{at, true, continuation.trajectory(), answer});
    return answer;
  }
  void Stop(StopKind kind) override {
    tape_.Add(ArmStopped{tape_.now(), kind});
    inner_.Stop(kind);
  }
  CommandResult Recover() override {
    const TimeNs at = tape_.now();
    const CommandResult answer = inner_.Recover();
    tape_.Add(ArmRecovered{at, answer});
    return answer;
  }
  void SetPayload(double mass_kg, const Vector3& p_FC) override {
    tape_.Add(PayloadSet{tape_.now(), mass_kg, p_FC});
    inner_.SetPayload(mass_kg, p_FC);
  }

 private:
  Arm& inner_;
  Tape& tape_;
};

class RecordedGripper : public Gripper {
 public:
  RecordedGripper(Gripper& inner, Tape& tape) : inner_(inner), tape_(tape) {}
  void Command(const GripperCommand& command) override {
    tape_.Add(GripperCommanded{tape_.now(), command});
    inner_.Command(command);
  }
  GripperState State() const override { return tape_.Read<GripperRead>(inner_.State()); }

 private:
  Gripper& inner_;
  Tape& tape_;
};

class RecordedWrist : public ForceTorqueSensor {
 public:
  RecordedWrist(ForceTorqueSensor& inner, Tape& tape) : inner_(inner), tape_(tape) {}
  WrenchSample Read() const override { return tape_.Read<WristRead>(inner_.Read()); }

 private:
  ForceTorqueSensor& inner_;
  Tape& tape_;
};

class RecordedScanner : public Scanner {
 public:
  RecordedScanner(Scanner& inner, Tape& tape) : inner_(inner), tape_(tape) {}
  CommandResult Trigger() override {
    const TimeNs at = tape_.now();
    const CommandResult answer = inner_.Trigger();
    tape_.Add(ScanTriggered{at, answer});
    return answer;
  }
  ScanStatus Status() const override { return tape_.Read<ScanStatusRead>(inner_.Status()); }
  OrganizedCloud Take() override {
    // Through the event and back: the cloud is large.
    CellEvent event = ScanTaken{tape_.now(), inner_.Take()};
    tape_.Add(event);
    return std::move(std::get<ScanTaken>(event).cloud_S);
  }
  std::string FailureReason() const override {
    return tape_.Read<ScanFailureRead>(inner_.FailureReason());
  }

 private:
  Scanner& inner_;
  Tape& tape_;
};

CellRecordingHeader Completed(CellRecordingHeader header, const Cell& cell) {
  header.model = cell.model;
  header.bin = cell.bin;
  return header;
}

}  // namespace

struct CellRecorder::Impl {
  Impl(Cell& inner, const CellRecordingHeader& header, const std::string& path)
      : tape{{path, Completed(header, inner)}, inner.clock},
        clock(tape),
        arm(inner.arm, tape),
        gripper(inner.gripper, tape),
        wrist(inner.wrist, tape),
        scanner(inner.scanner, tape),
        cell{clock, arm, gripper, wrist, scanner, inner.model, inner.bin, inner.safety} {}

  Tape tape;
  RecordedClock clock;
  RecordedArm arm;
  RecordedGripper gripper;
  RecordedWrist wrist;
  RecordedScanner scanner;
  Cell cell;
};

CellRecorder::CellRecorder(Cell& inner, CellRecordingHeader header, const std::string& path)
    : impl_(std::make_unique<Impl>(inner, header, path)) {}
CellRecorder::~CellRecorder() = default;

Cell& CellRecorder::cell() { return impl_->cell; }

void CellRecorder::Caption(const std::string& text) {
  impl_->tape.Add(PipelineNote{PipelineNote::Kind::kCaption, impl_->tape.now(), text});
}

void CellRecorder::Result(const std::string& text) {
  impl_->tape.Add(PipelineNote{PipelineNote::Kind::kResult, impl_->tape.now(), text});
}

const std::optional<Error>& CellRecorder::failure() const { return impl_->tape.failure; }

void CellRecorder::Finish(const std::string& reason) {
  if (impl_->tape.failure) throw Error(*impl_->tape.failure);
  impl_->tape.writer.Finish(reason);
}

}  // namespace tubetwin
