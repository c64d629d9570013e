#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/drivers/ati/netft_config.h"

namespace tubetwin {

/// An ATI force/torque sensor behind a Net F/T box, by raw data transfer over UDP. A thread of its
/// own receives; the methods only take a lock. The destructor stops the stream.
///
/// Read() is the newest record in sensor axes, not tared, with the time at which it came. A record
/// with a fault in its status word is no sample, and neither is one that is late, damaged or
/// missing: the newest sample then gets old, which the cell's watch over the wrist sees. No sensor
/// counts the same on all axes for long: after 0.1 s of it the samples' `problem` says that it is
/// stuck, until it counts something else. The driver does not ask for a stream again.
class NetftSensor : public ForceTorqueSensor {
 public:
  /// Reads the box's configuration page, starts the stream and waits for its first sample, at most
  /// 8 s (of cell time where that is slower than the wall's). `clock` must outlive it and tell
  /// Now() to any thread. Throws Error(kConfig), also when the page's counts, in N and N m, are not
  /// the configured ones; Error(kDevice) naming device, place and what was awaited.
  NetftSensor(const NetftConfig& config, const CellClock& clock);
  ~NetftSensor() override;

  WrenchSample Read() const override;

  struct Statistics {
    std::uint64_t samples = 0;    ///< Records that were used.
    std::uint64_t lost = 0;       ///< Gaps in their sequence.
    std::uint64_t late = 0;       ///< Records not newer than one before.
    std::uint64_t malformed = 0;  ///< Datagrams that are no records.
    std::uint64_t faulty = 0;     ///< Records with a fault.
    std::uint32_t status = 0;     ///< Of the newest record.
  };
  Statistics statistics() const;
  /// The fault in the newest record's status in words; empty: none. Saturation and a latched
  /// threshold are none.
  std::string FaultText() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
