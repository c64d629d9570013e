#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "hw_bridge/emulators/link_faults.h"

namespace tubetwin {

/// Messages that an emulator sends over a link with faults: they get lost, delayed, doubled or
/// damaged. Holds 4096 messages; more are lost.
class SendQueue {
 public:
  /// Takes a message for `to`, a number that the owner chooses.
  void Put(const LinkFaults& link, TimeNs now, std::uint64_t to, std::string message);
  /// Hands over what is due, in the order in which it was put in.
  void Deliver(TimeNs now,
               const std::function<void(std::uint64_t to, const std::string& message)>& send);

 private:
  struct Letter {
    TimeNs due{0};
    std::uint64_t to = 0;
    std::string message;
  };
  std::deque<Letter> letters_;
};

/// The same number of bytes, the first and every fifth after it changed.
std::string Corrupted(std::string bytes);

}  // namespace tubetwin
