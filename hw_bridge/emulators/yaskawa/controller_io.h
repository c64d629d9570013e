#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "hw_bridge/codecs/simple_message.h"

namespace tubetwin {

/// The I/O of a YRC1000: bits in groups of eight, by the addresses that MotoROS and the concurrent
/// I/O use, and M registers. Nothing is wired to it but what the controller itself writes.
class ControllerIo {
 public:
  /// Answers a request for bits, groups or registers; nothing when it is none. Failures are told by
  /// result and reply code.
  std::optional<simple_message::Message> Answer(const simple_message::Body& request);

  /// A bit (0 or 1), or a register from 1000000 on, by its address.
  std::uint16_t Word(std::uint32_t address) const;
  void SetWord(std::uint32_t address, std::uint16_t value);

  /// OUT#`number`, from 1; what MotoROS tells the cell by it is 889 to 896.
  void SetOutput(int number, bool on);
  bool Output(int number) const;
  /// Any bit, by its address.
  void SetBit(std::int32_t address, bool on);

  /// Whole groups by address (a bit's / 10), for supervision. Nothing: no such address.
  std::optional<std::uint8_t> Group(std::int32_t address) const;
  /// Of M000 to M999.
  std::uint16_t Register(int number) const;
  void SetRegister(int number, std::uint16_t value);

 private:
  std::map<std::int32_t, std::uint8_t> groups_;
  std::map<std::int32_t, std::uint16_t> registers_;
};

inline constexpr int kOutWaiting = 889, kOutDone = 890, kOutInitDone = 891, kOutServer = 892,
                     kOutMotionClient = 893, kOutStateClient = 894, kOutIoClient = 895,
                     kOutFailure = 896;

}  // namespace tubetwin
