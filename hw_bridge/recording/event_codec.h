#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hw_bridge/recording/byte_stream.h"
#include "hw_bridge/recording/cell_event.h"

namespace tubetwin {

/// Codes the successive values of one number that a device reports, usually a multiple of the
/// device's resolution `step`. What is stored is the difference to a prediction: the last value
/// again, or
/// (`linear`) the last value plus its last change. Any double is restored with the same bits.
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

/// State that encoder and decoder share: the newest values, from which the next are predicted.
struct EventContext {
  EventContext();
  TimeNs now{0};
  ArmState arm;
  std::array<NumberTrack, kNumJoints> q, qd;
  GripperState gripper;
  WrenchSample wrist;
  std::array<NumberTrack, 6> wrench;
};

/// Encodes events as bytes, each by its difference to the ones before: a state that did not change
/// takes two bytes. Of a cloud only the fact is encoded that it was taken; the caller stores the
/// cloud itself before these bytes. One thread.
class EventEncoder {
 public:
  /// Forgets all earlier events but the time, so that decoding can start here, given now().
  void Reset();
  void Encode(const CellEvent& event, std::string& out);
  /// Cell time of the newest event.
  TimeNs now() const { return context_.now; }

 private:
  EventContext context_;
};

/// Decodes bytes that an encoder wrote after a Reset at time `now`. Any other bytes end in an
/// error, too. Keeps a view of them.
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
