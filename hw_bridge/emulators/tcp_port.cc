#include "hw_bridge/emulators/tcp_port.h"

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <list>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

using asio::ip::tcp;

constexpr std::size_t kMaxClients = 8;
constexpr int kMaxAccepts = 32;  // Per look.
constexpr std::size_t kMaxReceived = 8192, kMaxUnsent = 65536;
constexpr TimeNs kSilent = std::chrono::seconds(1);

struct Client {
  std::uint64_t id = 0;
  tcp::socket socket;
  std::string received, unsent;
  TimeNs heard{0};  ///< When its newest whole message came; of its begin before that.
  bool finishing = false, gone = false;
};

bool WouldBlock(const asio::error_code& error) {
  return error == asio::error::would_block || error == asio::error::try_again ||
         error == asio::error::interrupted;
}

}  // namespace

struct TcpPort::Impl {
  explicit Impl(asio::io_context& io) : acceptor(io) {}

  void Accept(TimeNs now) {
    for (int i = 0; i < kMaxAccepts; ++i) {
      asio::error_code error;
      tcp::socket socket(acceptor.get_executor());
      acceptor.accept(socket, error);
      if (error) return;  // None is waiting, or it is gone already.
      if (!MakeRoom(now)) continue;
      socket.non_blocking(true, error);
      if (!error) socket.set_option(tcp::no_delay(true), error);
      if (error) continue;
      list.push_back({next_id++, std::move(socket), "", "", now});
    }
  }

  bool MakeRoom(TimeNs now) {
    if (list.size() < kMaxClients) return true;
    const auto oldest =
        std::min_element(list.begin(), list.end(),
                         [](const Client& a, const Client& b) { return a.heard < b.heard; });
    if (now - oldest->heard < kSilent) return false;
    list.erase(oldest);
    return true;
  }

  static void Receive(Client& client) {
    std::array<char, 4096> bytes;
    while (client.received.size() <= kMaxReceived) {
      asio::error_code error;
      const std::size_t size = client.socket.read_some(asio::buffer(bytes), error);
      if (error) {
        client.gone = !WouldBlock(error);
        return;
      }
      client.received.append(bytes.data(), size);
    }
  }

  static void Flush(Client& client) {
    while (!client.unsent.empty() && !client.gone) {
      asio::error_code error;
      const std::size_t size = client.socket.write_some(asio::buffer(client.unsent), error);
      client.unsent.erase(0, size);
      if (error) {
        client.gone = !WouldBlock(error);
        break;
      }
    }
    if (client.unsent.size() > kMaxUnsent) client.gone = true;
    if (client.finishing && client.unsent.empty()) client.gone = true;
  }

  Client* Find(std::uint64_t id) {
    const auto found =
        std::find_if(list.begin(), list.end(), [id](const Client& c) { return c.id == id; });
    return found == list.end() ? nullptr : &*found;
  }

  tcp::acceptor acceptor;
  std::list<Client> list;
  std::uint64_t next_id = 1;
};

TcpPort::TcpPort(asio::io_context& io, const std::string& who, const std::string& listen, int port)
    : impl_(std::make_unique<Impl>(io)) {
  asio::error_code error;
  const asio::ip::address address = asio::ip::make_address(listen, error);
  const auto at = tcp::endpoint(address, static_cast<std::uint16_t>(port));
  if (!error) impl_->acceptor.open(at.protocol(), error);
  if (!error) impl_->acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) impl_->acceptor.bind(at, error);
  if (!error) impl_->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) impl_->acceptor.non_blocking(true, error);
  if (error) {
    throw Error(ErrorKind::kDevice, who + ": cannot listen on " + listen + ":" +
                                        std::to_string(port) + ": " + error.message());
  }
}

TcpPort::~TcpPort() = default;

int TcpPort::port() const { return impl_->acceptor.local_endpoint().port(); }

int TcpPort::clients() const { return static_cast<int>(impl_->list.size()); }

void TcpPort::Poll(TimeNs now, const Take& take) {
  impl_->Accept(now);
  for (Client& client : impl_->list) {
    Impl::Receive(client);
    const std::size_t before = client.received.size();
    if (before > 0 && take(client.id, client.received) == Verdict::kClose) {
      client.finishing = true;
      client.received.clear();
    }
    if (client.received.size() < before) client.heard = now;
    if (client.received.size() > kMaxReceived) client.gone = true;
    Impl::Flush(client);
  }
  impl_->list.remove_if([](const Client& client) { return client.gone; });
}

void TcpPort::Send(std::uint64_t id, std::string_view bytes) {
  if (Client* client = impl_->Find(id)) {
    client->unsent.append(bytes);
    Impl::Flush(*client);
  }
}

void TcpPort::Finish(std::uint64_t id) {
  if (Client* client = impl_->Find(id)) client->finishing = true;
}

}  // namespace tubetwin
