#include "hw_bridge/emulators/photoneo/gige_fake_camera.h"

#include <arv.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <asio.hpp>
#include <random>
#include <string_view>
#include <utility>

#include "hw_bridge/emulators/photoneo/gige_genicam.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

using asio::ip::udp;
namespace registers = gige_registers;

constexpr std::uint16_t kControlPort = 3956;
// Of the GigE Vision bootstrap registers.
constexpr std::uint32_t kManufacturer = 0x48, kModel = 0x68, kManufacturerInfo = 0xa8;
constexpr std::uint32_t kControlPrivilege = 0xa00;
constexpr std::uint32_t kStreamPort = 0xd00, kPacketSize = 0xd04, kStreamAddress = 0xd18;
constexpr std::uint32_t kAcquisition = ARV_FAKE_CAMERA_REGISTER_ACQUISITION;
// A loopback interface takes packets of 64 KiB. This size fills the kernel's buffers best: few
// packets, each with little waste.
constexpr std::uint32_t kLoopbackPacket = 16000, kEthernetPacket = 1500;

[[noreturn]] void CannotListen(const std::string& listen, const std::string& why) {
  throw Error(ErrorKind::kDevice, "emulated scanner (GigE Vision): cannot listen on " + listen +
                                      ":" + std::to_string(kControlPort) + ", UDP: " + why);
}

/// Aravis says nothing when the port is taken.
void RequireFreePort(const std::string& listen) {
  asio::error_code error;
  const auto address = asio::ip::make_address_v4(listen, error);
  if (error) CannotListen(listen, "this is no IPv4 address");
  asio::io_context io;
  udp::socket probe(io, udp::v4());
  probe.bind({address, kControlPort}, error);
  if (!error) return;
  CannotListen(listen, error.message() + "; GigE Vision has no other port than this");
}

/// What whoever serves the port says of a register; nothing when nobody answers.
std::optional<std::uint32_t> AskRegister(const std::string& listen, std::uint32_t address) {
  asio::io_context io;
  udp::socket socket(io, udp::v4());
  const auto byte = [address](int shift) { return static_cast<std::uint8_t>(address >> shift); };
  // Read register, answer wanted, 4 bytes follow, request 1.
  const std::array<std::uint8_t, 12> question = {0x42, 0x01, 0x00,     0x80,     0x00,    0x04,
                                                 0x00, 0x01, byte(24), byte(16), byte(8), byte(0)};
  asio::error_code error;
  socket.connect({asio::ip::make_address_v4(listen), kControlPort}, error);
  for (int attempt = 0; attempt < 5 && !error; ++attempt) {
    socket.send(asio::buffer(question), 0, error);
    pollfd ready = {socket.native_handle(), POLLIN, 0};
    constexpr int kPatienceMs = 500;
    if (error || ::poll(&ready, 1, kPatienceMs) <= 0) continue;
    std::array<std::uint8_t, 64> answer{};
    const std::size_t size = socket.receive(asio::buffer(answer), 0, error);
    if (error || size < 12 || answer[3] != 0x81) continue;
    return std::uint32_t{answer[8]} << 24 | std::uint32_t{answer[9]} << 16 |
           std::uint32_t{answer[10]} << 8 | std::uint32_t{answer[11]};
  }
  return std::nullopt;
}

/// A file without a name, for a library that reads files only.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view text) : fd_(::memfd_create("genicam", MFD_CLOEXEC)) {
    TT_CHECK(fd_ >= 0);
    TT_CHECK(::write(fd_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(fd_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

}  // namespace

struct GigeFakeCamera::Impl {
  Impl(const std::string& listen, int width, int height) {
    RequireFreePort(listen);
    const MemoryFile genicam(kScannerGenicam);
    gv = arv_gv_fake_camera_new_full(listen.c_str(), "1", genicam.path().c_str());
    camera = arv_gv_fake_camera_get_fake_camera(gv);
    if (!arv_gv_fake_camera_is_running(gv)) {
      g_object_unref(gv);
      CannotListen(listen, "no interface of this machine has this address");
    }
    Describe(width, height, asio::ip::make_address_v4(listen).is_loopback());
    const std::uint32_t nonce = std::random_device()();
    Write(registers::kNonce, nonce);
    if (AskRegister(listen, registers::kNonce) != nonce) {  // Somebody was faster by a hair.
      g_object_unref(gv);
      CannotListen(listen, "somebody else answers there");
    }
  }
  ~Impl() { g_object_unref(gv); }  // Ends its thread.

  void Describe(int width, int height, bool loopback) {
    // No packets from the fake camera itself, whatever a client writes into its registers.
    g_object_set(gv, "gvsp-lost-ratio", 1.0, nullptr);
    Write(ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, static_cast<std::uint32_t>(width));
    Write(ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, static_cast<std::uint32_t>(height));
    Write(ARV_FAKE_CAMERA_REGISTER_WIDTH, static_cast<std::uint32_t>(width));
    Write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, static_cast<std::uint32_t>(height));
    Write(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, ARV_PIXEL_FORMAT_COORD3D_ABC_32F);
    Write(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US, 0);
    Write(registers::kComponent, registers::kRangeComponent);
    Write(registers::kComponentEnabled, 1);
    Write(kPacketSize, loopback ? kLoopbackPacket : kEthernetPacket);
    WriteText(kManufacturer, "tubetwin", 32);
    WriteText(kModel, "emulated scanner", 32);
    WriteText(kManufacturerInfo, "no real device", 48);
  }

  void Write(std::uint32_t address, std::uint32_t value) {
    arv_fake_camera_write_register(camera, address, value);
  }
  std::uint32_t Read(std::uint32_t address) const {
    guint32 value = 0;
    arv_fake_camera_read_register(camera, address, &value);
    return value;
  }
  void WriteText(std::uint32_t address, std::string text, std::size_t room) {
    text.resize(room);
    arv_fake_camera_write_memory(camera, address, static_cast<guint32>(room), text.data());
  }
  ArvGvFakeCamera* gv = nullptr;
  ArvFakeCamera* camera = nullptr;  ///< Belongs to `gv`.
};

GigeFakeCamera::GigeFakeCamera(const std::string& listen, int width, int height)
    : impl_(std::make_unique<Impl>(listen, width, height)) {}
GigeFakeCamera::~GigeFakeCamera() = default;

bool GigeFakeCamera::triggered() const { return impl_->Read(registers::kTrigger) != 0; }

std::optional<GvspClient> GigeFakeCamera::TakeTrigger() {
  if (!triggered()) return std::nullopt;
  const std::optional<GvspClient> asks = client();
  // A trigger that comes just now is answered by the scan that starts after this.
  impl_->Write(registers::kTrigger, 0);
  return asks;
}

std::optional<GvspClient> GigeFakeCamera::client() const {
  if (impl_->Read(kControlPrivilege) == 0 || impl_->Read(kAcquisition) == 0) return std::nullopt;
  return GvspClient{impl_->Read(kStreamAddress), impl_->Read(kStreamPort) & 0xffff};
}

std::uint32_t GigeFakeCamera::packet_size() const { return impl_->Read(kPacketSize) & 0xffff; }

}  // namespace tubetwin
