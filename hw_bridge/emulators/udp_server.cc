#include "hw_bridge/emulators/udp_server.h"

#include <array>
#include <asio.hpp>
#include <deque>
#include <utility>

#include "hw_bridge/emulators/corrupt.h"
#include "models/base/error.h"

namespace tubetwin {

using asio::ip::udp;

namespace {
constexpr int kMaxReceives = 64;  ///< Each period: a flood must not keep the others waiting.
}

struct UdpServer::Impl : std::enable_shared_from_this<Impl> {
  Impl(asio::io_context& io, Answer a) : socket(io), answer(std::move(a)) {}

  void Receive();
  void Received(std::size_t size);
  void Put(const std::string& bytes, const udp::endpoint& to);

  struct Delayed {
    TimeNs due{0};
    std::string bytes;
    udp::endpoint to;
  };

  udp::socket socket;
  Answer answer;
  LinkFaults faults;
  Corruption corruption;
  std::array<char, 2048> buffer{};
  udp::endpoint sender;
  std::deque<Delayed> delayed;
  TimeNs now{0};
  bool receiving = true;
  int receives = 0;  ///< Of this period.
};

void UdpServer::Impl::Receive() {
  socket.async_receive_from(
      asio::buffer(buffer), sender,
      [weak = weak_from_this()](const asio::error_code& error, std::size_t size) {
        const auto self = weak.lock();
        if (!self || error == asio::error::operation_aborted) return;
        // Errors are those of earlier answers to closed ports.
        if (!error) self->Received(size);
        self->receiving = ++self->receives < kMaxReceives;
        if (self->receiving) self->Receive();
      });
}

void UdpServer::Impl::Received(std::size_t size) {
  if (faults.drop || faults.freeze) return;  // A frozen controller's buffer soon overflows.
  const std::optional<std::string> bytes = answer(std::string_view(buffer.data(), size));
  if (!bytes) return;
  constexpr std::size_t kMaxDelayed = 1024;
  for (int i = 0; i < (faults.duplicate ? 2 : 1); ++i) {
    std::string out = *bytes;
    if (faults.corrupt) corruption.Change(out);
    if (faults.delay == TimeNs{0}) {
      Put(out, sender);
    } else if (delayed.size() < kMaxDelayed) {
      delayed.push_back({now + faults.delay, std::move(out), sender});
    }
  }
}

void UdpServer::Impl::Put(const std::string& bytes, const udp::endpoint& to) {
  asio::error_code ignored;  // Datagrams may get lost.
  socket.send_to(asio::buffer(bytes), to, 0, ignored);
}

UdpServer::UdpServer(asio::io_context& io, const std::string& who, const std::string& listen,
                     int port, Answer answer)
    : impl_(std::make_shared<Impl>(io, std::move(answer))) {
  const auto check = [&](const asio::error_code& error) {
    if (!error) return;
    throw Error(ErrorKind::kDevice, who + " cannot listen on " + listen + ":" +
                                        std::to_string(port) + ": " + error.message());
  };
  asio::error_code error;
  const asio::ip::address address = asio::ip::make_address(listen, error);
  check(error);
  const udp::endpoint endpoint(address, static_cast<std::uint16_t>(port));
  impl_->socket.open(endpoint.protocol(), error);
  check(error);
  impl_->socket.bind(endpoint, error);
  check(error);
  impl_->socket.non_blocking(true, error);
  check(error);
  impl_->Receive();
}

UdpServer::~UdpServer() {
  asio::error_code ignored;
  impl_->socket.close(ignored);
}

int UdpServer::port() const { return impl_->socket.local_endpoint().port(); }

void UdpServer::Tick(TimeNs now) {
  impl_->now = now;
  impl_->receives = 0;
  if (!std::exchange(impl_->receiving, true)) impl_->Receive();
  while (!impl_->delayed.empty() && impl_->delayed.front().due <= now) {
    impl_->Put(impl_->delayed.front().bytes, impl_->delayed.front().to);
    impl_->delayed.pop_front();
  }
}

LinkFaults& UdpServer::faults() { return impl_->faults; }

}  // namespace tubetwin
