#include "hw_bridge/emulators/tcp_server.h"

#include <array>
#include <asio.hpp>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "hw_bridge/emulators/corrupt.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

using asio::ip::tcp;

constexpr std::size_t kReceive = 4096;
constexpr std::size_t kMaxUnsent = 64 * 1024;
// Of each period.
constexpr int kMaxAccepts = 32, kMaxReceives = 16;
constexpr TimeNs kStuck = std::chrono::seconds(2);
/// Of the kernel: so that what a client does not read is noticed here.
constexpr int kSendBuffer = 16 * 1024;

struct Connection {
  explicit Connection(tcp::socket s) : socket(std::move(s)) {}
  tcp::socket socket;
  std::array<char, kReceive> receive{};
  std::string held;  ///< Received while frozen or paused; nothing more is read then.
  bool reading = false, paused = false, writing = false, closing = false;
  int receives = 0;  ///< Of this period.
  TimeNs wrote{0};   ///< When the newest write was begun.
  std::deque<std::string> unsent;
  std::size_t unsent_bytes = 0;
  std::deque<std::pair<TimeNs, std::string>> delayed;
};

}  // namespace

struct TcpServer::Impl : std::enable_shared_from_this<Impl> {
  Impl(asio::io_context& io, Callbacks c) : acceptor(io), callbacks(std::move(c)) {}

  void Accept();
  void Admit(tcp::socket socket);
  void Read(Client id);
  void Received(Client id, std::string_view bytes);
  void Give(Client id, std::string_view bytes);
  void Put(Client id, std::string bytes);
  void Write(Client id);
  void Drop(Client id);
  void Send(Client id, const std::string& message);
  void Tick(TimeNs now);
  /// What one period allows is over: the next one begins.
  void Refresh();

  Connection* Find(Client id) {
    const auto found = connections.find(id);
    return found == connections.end() ? nullptr : found->second.get();
  }

  tcp::acceptor acceptor;
  Callbacks callbacks;
  LinkFaults faults;
  Corruption corruption;
  std::map<Client, std::unique_ptr<Connection>> connections;
  Client next = 1;
  TimeNs now{0};
  bool accepting = true;
  int accepts = 0;  ///< Of this period.
};

void TcpServer::Impl::Accept() {
  acceptor.async_accept(
      [weak = weak_from_this()](const asio::error_code& error, tcp::socket socket) {
        const auto self = weak.lock();
        if (!self || error == asio::error::operation_aborted) return;
        if (!error) self->Admit(std::move(socket));
        // An error (no more descriptors) would come again at once.
        self->accepting = !error && ++self->accepts < kMaxAccepts;
        if (self->accepting) self->Accept();
      });
}

void TcpServer::Impl::Admit(tcp::socket socket) {
  switch (callbacks.admit(static_cast<int>(connections.size()))) {
    case Admission::kRefuse:
      return;  // The socket closes.
    case Admission::kReplace:
      while (!connections.empty()) Drop(connections.begin()->first);
      break;
    case Admission::kAdd:
      break;
  }
  asio::error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  const Client id = next++;
  connections.emplace(id, std::make_unique<Connection>(std::move(socket)));
  if (callbacks.joined) callbacks.joined(id);
  Read(id);
}

void TcpServer::Impl::Read(Client id) {
  Connection* const c = Find(id);
  if (c == nullptr || c->reading || c->paused || c->closing || !c->held.empty()) return;
  if (c->receives >= kMaxReceives) return;  // Until the next period.
  ++c->receives;
  c->reading = true;
  c->socket.async_read_some(
      asio::buffer(c->receive),
      [weak = weak_from_this(), id](const asio::error_code& error, std::size_t size) {
        const auto self = weak.lock();
        Connection* const here = self ? self->Find(id) : nullptr;
        if (here == nullptr) return;
        here->reading = false;
        if (error) return self->Drop(id);
        self->Received(id, std::string_view(here->receive.data(), size));
        self->Read(id);
      });
}

void TcpServer::Impl::Received(Client id, std::string_view bytes) {
  Connection* const c = Find(id);
  if (faults.freeze || c->paused) {
    c->held.assign(bytes);
  } else if (!faults.drop) {
    Give(id, bytes);
  }
}

void TcpServer::Impl::Give(Client id, std::string_view bytes) {
  const std::string copy(bytes);  // The callback may close the connection.
  callbacks.received(id, copy);
}

void TcpServer::Impl::Put(Client id, std::string bytes) {
  Connection* const c = Find(id);
  if (c == nullptr || c->closing) return;
  if (c->unsent_bytes + bytes.size() > kMaxUnsent) return Drop(id);
  c->unsent_bytes += bytes.size();
  c->unsent.push_back(std::move(bytes));
  Write(id);
}

void TcpServer::Impl::Write(Client id) {
  Connection* const c = Find(id);
  if (c == nullptr || c->writing) return;
  if (c->unsent.empty()) {
    if (c->closing && c->delayed.empty()) Drop(id);
    return;
  }
  c->writing = true;
  c->wrote = now;
  asio::async_write(c->socket, asio::buffer(c->unsent.front()),
                    [weak = weak_from_this(), id](const asio::error_code& error, std::size_t) {
                      const auto self = weak.lock();
                      Connection* const here = self ? self->Find(id) : nullptr;
                      if (here == nullptr) return;
                      here->writing = false;
                      here->unsent_bytes -= here->unsent.front().size();
                      here->unsent.pop_front();
                      if (error) return self->Drop(id);
                      self->Write(id);
                    });
}

void TcpServer::Impl::Drop(Client id) {
  const auto found = connections.find(id);
  if (found == connections.end()) return;
  // A write under way still points into the connection: it goes when its handler has run.
  std::shared_ptr<Connection> dying = std::move(found->second);
  connections.erase(found);
  asio::error_code ignored;
  dying->socket.close(ignored);
  asio::post(acceptor.get_executor(), [dying] {});
  if (callbacks.left) callbacks.left(id);
}

void TcpServer::Impl::Send(Client id, const std::string& message) {
  Connection* const c = Find(id);
  if (c == nullptr || faults.drop || faults.freeze) return;
  const int times = faults.duplicate ? 2 : 1;
  for (int i = 0; i < times; ++i) {
    std::string bytes = message;
    if (faults.corrupt) corruption.Change(bytes);
    if (faults.delay > TimeNs{0} || !c->delayed.empty()) {
      constexpr std::size_t kMaxDelayed = 4096;
      if (c->delayed.size() >= kMaxDelayed) return Drop(id);
      c->delayed.emplace_back(now + faults.delay, std::move(bytes));
    } else {
      Put(id, std::move(bytes));
      if (Find(id) != c) return;
    }
  }
}

void TcpServer::Impl::Refresh() {
  std::vector<Client> ids, stuck;
  for (const auto& [id, connection] : connections) {
    ids.push_back(id);
    if (connection->writing && now - connection->wrote > kStuck) stuck.push_back(id);
  }
  for (const Client id : stuck) Drop(id);
  for (const Client id : ids) {
    if (Connection* const c = Find(id)) c->receives = 0;
    Read(id);
  }
}

void TcpServer::Impl::Tick(TimeNs t) {
  now = t;
  accepts = 0;
  if (!std::exchange(accepting, true)) Accept();
  Refresh();
  if (faults.freeze) return;
  for (auto it = connections.begin(); it != connections.end();) {
    const Client id = (it++)->first;
    Connection* c = Find(id);
    while (c != nullptr && !c->delayed.empty() && c->delayed.front().first <= now) {
      std::string bytes = std::move(c->delayed.front().second);
      c->delayed.pop_front();
      Put(id, std::move(bytes));
      c = Find(id);
    }
    if (c == nullptr) return;  // Somebody left: the rest waits for the next period.
    if (c->closing) Write(id);
    if ((c = Find(id)) == nullptr) return;
    if (!c->held.empty() && !c->paused) {
      const std::string held = std::exchange(c->held, {});
      if (!faults.drop) Give(id, held);
      Read(id);
      if (Find(id) == nullptr) return;
    }
  }
}

TcpServer::TcpServer(asio::io_context& io, const std::string& who, const std::string& listen,
                     int port, Callbacks callbacks)
    : impl_(std::make_shared<Impl>(io, std::move(callbacks))) {
  const auto check = [&](const asio::error_code& error) {
    if (!error) return;
    throw Error(ErrorKind::kDevice, who + " cannot listen on " + listen + ":" +
                                        std::to_string(port) + ": " + error.message());
  };
  asio::error_code error;
  const asio::ip::address address = asio::ip::make_address(listen, error);
  check(error);
  const tcp::endpoint endpoint(address, static_cast<std::uint16_t>(port));
  impl_->acceptor.open(endpoint.protocol(), error);
  check(error);
  impl_->acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  check(error);
  impl_->acceptor.bind(endpoint, error);
  check(error);
  impl_->acceptor.listen(16, error);
  check(error);
  impl_->Accept();
}

TcpServer::~TcpServer() {
  impl_->callbacks.left = nullptr;
  asio::error_code ignored;
  impl_->acceptor.close(ignored);
  CloseAll();
}

int TcpServer::port() const { return impl_->acceptor.local_endpoint().port(); }

int TcpServer::clients() const { return static_cast<int>(impl_->connections.size()); }

void TcpServer::Send(Client client, const std::string& message) { impl_->Send(client, message); }

void TcpServer::SendAll(const std::string& message) {
  std::vector<Client> ids;
  for (const auto& [id, connection] : impl_->connections) ids.push_back(id);
  for (const Client id : ids) impl_->Send(id, message);
}

void TcpServer::Pause(Client client, bool pause) {
  Connection* const c = impl_->Find(client);
  if (c == nullptr) return;
  c->paused = pause;
  if (!pause) impl_->Read(client);
}

void TcpServer::Close(Client client) {
  Connection* const c = impl_->Find(client);
  if (c == nullptr) return;
  c->closing = true;
  impl_->Write(client);
}

void TcpServer::Cut(Client client) { impl_->Drop(client); }

void TcpServer::CloseAll() {
  while (!impl_->connections.empty()) impl_->Drop(impl_->connections.begin()->first);
}

void TcpServer::Tick(TimeNs now) { impl_->Tick(now); }

LinkFaults& TcpServer::faults() { return impl_->faults; }

}  // namespace tubetwin
