#include "hw_bridge/drivers/yaskawa/tcp_client.h"

#include <array>
#include <asio.hpp>
#include <optional>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {

using asio::ip::tcp;

struct NetLoop::Impl {
  asio::io_context io{1};
  asio::executor_work_guard<asio::io_context::executor_type> guard = asio::make_work_guard(io);
};

NetLoop::NetLoop() : impl_(std::make_unique<Impl>()) {}
NetLoop::~NetLoop() = default;

void NetLoop::Wait(std::chrono::nanoseconds max_wait) {
  if (impl_->io.run_one_for(max_wait) > 0) impl_->io.poll();
}

void NetLoop::Wake() {
  asio::post(impl_->io, [] {});
}

struct TcpClient::Impl : std::enable_shared_from_this<Impl> {
  Impl(asio::io_context& i, std::string n) : io(i), socket(i), name(std::move(n)) {}

  void Read();
  void Close(const std::string& why) {
    if (open) problem = why;
    open = false;
    asio::error_code ignored;
    socket.close(ignored);
  }

  asio::io_context& io;
  tcp::socket socket;
  std::string name, host, problem, received;
  int port = 0;
  bool open = false;
  std::array<char, 4096> buffer{};
};

void TcpClient::Impl::Read() {
  socket.async_read_some(
      asio::buffer(buffer),
      [weak = weak_from_this()](const asio::error_code& error, std::size_t size) {
        const auto self = weak.lock();
        if (!self || !self->open) return;
        if (error) {
          return self->Close(error == asio::error::eof ? "connection closed by the controller"
                                                       : error.message());
        }
        constexpr std::size_t kMax = 1 << 20;  // Nobody takes it: the driver's thread is stuck.
        if (self->received.size() > kMax) return self->Close("flooded by the controller");
        self->received.append(self->buffer.data(), size);
        self->Read();
      });
}

TcpClient::TcpClient(NetLoop& loop, const std::string& who, const std::string& host, int port)
    : impl_(std::make_shared<Impl>(loop.impl_->io,
                                   who + " at " + host + ":" + std::to_string(port))) {
  impl_->host = host;
  impl_->port = port;
}

TcpClient::~TcpClient() { impl_->Close("closed"); }

void TcpClient::Connect(std::chrono::steady_clock::time_point deadline) {
  const auto fail = [this](const std::string& why) {
    asio::error_code ignored;
    impl_->socket.close(ignored);
    throw Error(ErrorKind::kDevice, impl_->name + ": " + why);
  };
  asio::error_code error;
  tcp::resolver resolver(impl_->io);
  const auto endpoints = resolver.resolve(impl_->host, std::to_string(impl_->port), error);
  if (error) fail(error.message());
  impl_->socket = tcp::socket(impl_->io);
  impl_->received.clear();
  impl_->problem.clear();
  // Shared with the handler, which may run after this has given up.
  const auto result = std::make_shared<std::optional<asio::error_code>>();
  asio::async_connect(impl_->socket, endpoints,
                      [result](const asio::error_code& e, const tcp::endpoint&) { *result = e; });
  while (!result->has_value()) {
    const auto left = deadline - std::chrono::steady_clock::now();
    if (left <= left.zero()) fail("no connection in time");
    impl_->io.run_one_for(left);
  }
  if (**result) fail((*result)->message());
  impl_->socket.set_option(tcp::no_delay(true), error);
  impl_->socket.non_blocking(true, error);
  impl_->open = true;
  impl_->Read();
}

bool TcpClient::open() const { return impl_->open; }
const std::string& TcpClient::problem() const { return impl_->problem; }
const std::string& TcpClient::name() const { return impl_->name; }

void TcpClient::Send(const std::string& bytes) {
  if (!impl_->open) return;
  asio::error_code error;
  const std::size_t sent = impl_->socket.write_some(asio::buffer(bytes), error);
  if (error) return impl_->Close(error.message());
  if (sent != bytes.size()) impl_->Close("the controller does not read");
}

std::string TcpClient::TakeReceived() { return std::exchange(impl_->received, {}); }

void TcpClient::Close(const std::string& why) { impl_->Close(why); }

}  // namespace tubetwin
