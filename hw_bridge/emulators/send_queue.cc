#include "hw_bridge/emulators/send_queue.h"

#include <utility>

namespace tubetwin {
namespace {

constexpr std::size_t kMax = 4096;

}  // namespace

void SendQueue::Put(const LinkFaults& link, TimeNs now, std::uint64_t to, std::string message) {
  if (link.drop) return;
  if (link.corrupt) message = Corrupted(std::move(message));
  const int copies = link.duplicate ? 2 : 1;
  for (int i = 0; i < copies && letters_.size() < kMax; ++i) {
    letters_.push_back({now + link.delay, to, message});
  }
}

void SendQueue::Deliver(
    TimeNs now, const std::function<void(std::uint64_t to, const std::string& message)>& send) {
  while (!letters_.empty() && letters_.front().due <= now) {
    const Letter letter = std::move(letters_.front());
    letters_.pop_front();
    send(letter.to, letter.message);
  }
}

std::string Corrupted(std::string bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += 5) bytes[i] = static_cast<char>(bytes[i] ^ 0x95);
  return bytes;
}

}  // namespace tubetwin
