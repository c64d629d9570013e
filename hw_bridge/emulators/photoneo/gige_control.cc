#include "hw_bridge/emulators/photoneo/gige_control.h"

#include <netinet/in.h>
#include <poll.h>

#include <array>
#include <asio.hpp>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "hw_bridge/emulators/photoneo/gige_registers.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

using asio::ip::udp;
using SteadyClock = std::chrono::steady_clock;

constexpr std::uint16_t kControlPort = 3956;
// A loopback interface takes packets of 64 KiB. This size fills the kernel's buffers best: few
// packets, each with little waste.
constexpr std::uint32_t kLoopbackPacket = 16000;
constexpr int kLookMs = 20;  ///< The thread looks whether it is to end.
constexpr int kMaxRequests = 256;
/// A client that asks for more at once has lost its frame.
constexpr std::uint32_t kMaxResent = 1000;

[[noreturn]] void CannotListen(const std::string& listen, const std::string& why) {
  throw Error(ErrorKind::kDevice, "emulated scanner (GigE Vision): cannot listen on " + listen +
                                      ":" + std::to_string(kControlPort) + ", UDP: " + why);
}

}  // namespace

struct GigeControl::Impl {
  Impl(const std::string& listen, int width, int height, double focal_px, GvspSender& frames)
      : sender(frames), main(io) {
    asio::error_code error;
    const auto address = asio::ip::make_address_v4(listen, error);
    if (error) CannotListen(listen, "this is no IPv4 address");
    main.open(udp::v4());
    main.bind({address, kControlPort}, error);
    if (error == asio::error::address_in_use) {
      CannotListen(listen, error.message() + "; GigE Vision has no other port than this");
    }
    if (error) CannotListen(listen, error.message());
    main.non_blocking(true);
    ListenForDiscovery(address);
    GigeDevice device;
    device.width = width;
    device.height = height;
    device.focal_px = focal_px;
    device.address = address.to_uint();
    if (address.is_loopback()) device.packet_size = device.jumbo_packet_size = kLoopbackPacket;
    registers.emplace(device);
    thread = std::jthread([this](const std::stop_token& stop) { Serve(stop); });
  }

  /// Discovery is broadcast. Not to hear it is no reason to end: clients may know the address.
  void ListenForDiscovery(const asio::ip::address_v4& address) {
    std::vector<asio::ip::address_v4> broadcast = {asio::ip::address_v4::broadcast()};
    if (address.is_loopback()) broadcast.push_back(asio::ip::make_address_v4("127.255.255.255"));
    for (const auto& at : broadcast) {
      asio::error_code error;
      udp::socket socket(io, udp::v4());
      socket.set_option(udp::socket::reuse_address(true), error);
      socket.bind({at, kControlPort}, error);
      if (!error) socket.non_blocking(true, error);
      if (!error) discovery.push_back(std::move(socket));
    }
  }

  void Serve(const std::stop_token& stop) {
    std::vector<pollfd> ready = {{main.native_handle(), POLLIN, 0}};
    for (udp::socket& socket : discovery) ready.push_back({socket.native_handle(), POLLIN, 0});
    while (!stop.stop_requested()) {
      ::poll(ready.data(), ready.size(), kLookMs);
      const std::lock_guard lock(mutex);
      Take(main, false);
      for (udp::socket& socket : discovery) Take(socket, true);
      EndSilentControl();
    }
  }

  void Take(udp::socket& socket, bool discovery_only) {
    std::array<char, 2048> bytes;
    for (int i = 0; i < kMaxRequests; ++i) {
      udp::endpoint from;
      asio::error_code error;
      const std::size_t size = socket.receive_from(asio::buffer(bytes), from, 0, error);
      if (error == asio::error::would_block || error == asio::error::try_again) return;
      if (error) continue;  // Of a client that is gone.
      const auto decoded = DecodeGvcpRequest({bytes.data(), size});
      const auto* request = std::get_if<GvcpRequest>(&decoded);
      if (request == nullptr) continue;
      const bool discovers =
          request->command == static_cast<std::uint16_t>(GvcpCommand::kDiscovery);
      if (discovery_only && !discovers) continue;
      Answer(*request, from);
    }
  }

  void Answer(const GvcpRequest& request, const udp::endpoint& from) {
    const bool controlled = registers->Get(gige::kControl) != 0;
    const bool controller = !controlled || from == owner;
    if (controlled && from == owner) heard = SteadyClock::now();
    if (request.command == static_cast<std::uint16_t>(GvcpCommand::kPacketResend)) {
      if (controlled && controller) SendAgain(request);
      return;
    }
    const auto [status, data] = registers->Do(request, controller);
    if (!controlled && registers->Get(gige::kControl) != 0) {
      owner = from;
      heard = SteadyClock::now();
    }
    if (controlled && registers->Get(gige::kControl) == 0) registers->EndControl();
    FireTestPacket();
    if (!request.wants_answer) return;
    asio::error_code lost;
    main.send_to(asio::buffer(EncodeGvcpAnswer(request, status, data)), from, 0, lost);
  }

  void EndSilentControl() {
    const auto limit = std::chrono::milliseconds(registers->Get(gige::kHeartbeat));
    if (registers->Get(gige::kControl) == 0 || SteadyClock::now() - heard <= limit) return;
    registers->EndControl();
  }

  GvspClient Stream() const {
    return {registers->Get(gige::kStreamAddress), registers->Get(gige::kStreamPort) & 0xffff};
  }
  /// Whom frames can be sent to.
  std::optional<GvspClient> Client() const {
    const bool sends =
        registers->Get(gige::kControl) != 0 && registers->Get(gige::kAcquisition) != 0;
    if (!sends) return std::nullopt;
    return Stream();
  }
  std::uint32_t PacketSize() const { return registers->Get(gige::kPacketSize) & 0xffff; }

  /// How a client finds the largest packet that comes through.
  void FireTestPacket() {
    const std::uint32_t size = registers->Get(gige::kPacketSize);
    if ((size & gige::kFireTestPacket) == 0) return;
    registers->Set(gige::kPacketSize, size & ~gige::kFireTestPacket);
    sender.SendTestPacket(Stream(), PacketSize());
  }

  void SendAgain(const GvcpRequest& request) {
    const auto wanted = GvcpResendOf(request);
    const auto* packets = std::get_if<GvcpResend>(&wanted);
    if (packets == nullptr || packets->last < packets->first) return;
    if (packets->last - packets->first >= kMaxResent) return;
    sender.SendAgain(*packets, Stream());
  }

  GvspSender& sender;
  asio::io_context io;
  udp::socket main;                    ///< Of the thread.
  std::vector<udp::socket> discovery;  ///< Of the thread.
  mutable std::mutex mutex;            ///< Of what follows but the thread.
  std::optional<GigeRegisters> registers;
  udp::endpoint owner;  ///< Who has control, if anybody.
  SteadyClock::time_point heard;
  std::jthread thread;  ///< Last: ends before what it uses.
};

GigeControl::GigeControl(const std::string& listen, int width, int height, double focal_px,
                         GvspSender& sender)
    : impl_(std::make_unique<Impl>(listen, width, height, focal_px, sender)) {}
GigeControl::~GigeControl() = default;

bool GigeControl::triggered() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->registers->Get(gige::kTrigger) != 0;
}

std::optional<GvspClient> GigeControl::TakeTrigger() {
  const std::lock_guard lock(impl_->mutex);
  const bool wanted = impl_->registers->Get(gige::kTrigger) != 0 || impl_->registers->free_runs();
  if (!wanted) return std::nullopt;
  // A trigger that comes after this is answered by a scan of its own.
  impl_->registers->Set(gige::kTrigger, 0);
  return impl_->Client();
}

std::optional<GvspClient> GigeControl::client() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->Client();
}

GigeFrameSettings GigeControl::frame_settings() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->registers->FrameSettings();
}

std::uint32_t GigeControl::packet_size() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->PacketSize();
}

}  // namespace tubetwin
