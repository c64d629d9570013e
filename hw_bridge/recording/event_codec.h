#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hw_bridge/recording/byte_stream.h"
#include "hw_bridge/recording/cell_event.h"

namespace tubetwin {

/// A number that a device reports again and again, usually a whole number of its steps. Told what
/// came, it expects the next: the same again, or (`linear`) as far on as last time. Every double
/// comes back with the same bits.
class NumberTrack {
 public:
  NumberTrack() = default;
  NumberTrack(double step, bool linear) : step_(step), linear_(linear) {}
  void Write(double value, ByteWriter& out);
  double Read(ByteReader& in);
  double last() const { return last_; }

 private:
  std::int64_t Expected() const;
  void Remember(double value);
  double step_ = 1.0;
  bool linear_ = false;
  double last_ = 0.0;
  std::int64_t steps_ = 0, steps_before_ = 0;
};

/// What encoder and decoder both know of the events so far.
struct EventContext {
  EventContext();
  TimeNs now{0};
  ArmState arm;
  std::array<NumberTrack, kNumJoints> q, qd;
  GripperState gripper;
  WrenchSample wrist;
  std::array<NumberTrack, 6> wrench;
};

/// Events as bytes, each told by its difference to what came before: a state that did not change
/// takes two bytes. A cloud is not among them, only that one was taken: whoever stores the bytes
/// stores it before them. One thread.
class EventEncoder {
 public:
  /// Forgets what came before but the time: what follows can be read by who knows now().
  void Reset();
  void Encode(const CellEvent& event, std::string& out);
  /// Cell time of the newest event.
  TimeNs now() const { return context_.now; }

 private:
  EventContext context_;
};

/// The events of bytes that an encoder wrote after a Reset at `now`, or of anything. A view.
class EventDecoder {
 public:
  EventDecoder(std::string_view bytes, TimeNs now, std::string source);
  /// The next event, nothing at the end. A ScanTaken comes without its cloud. Throws
  /// Error(kBadData) naming source and byte.
  std::optional<CellEvent> Next();

 private:
  ByteReader in_;
  EventContext context_;
};

}  // namespace tubetwin
