// The emulated GigE Vision scanner, byte by byte: what a client sends and gets on its two sockets.

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/codecs/big_endian.h"
#include "hw_bridge/emulators/photoneo/gige_registers.h"
#include "tests/codecs/hex.h"
#include "tests/contract/gige_client.h"

namespace tubetwin {
namespace {

using test::FromHex;
using test::ToSpacedHex;

sockaddr_in Loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A UDP port of loopback.
class UdpPort {
 public:
  UdpPort() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    REQUIRE(socket_ >= 0);
    sockaddr_in address = Loopback(0);
    REQUIRE(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
    socklen_t size = sizeof address;
    REQUIRE(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    number_ = ntohs(address.sin_port);
  }
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;
  ~UdpPort() { ::close(socket_); }

  std::uint16_t number() const { return number_; }
  void Send(const std::string& bytes) const {
    constexpr std::uint16_t kControlPort = 3956;
    const sockaddr_in to = Loopback(kControlPort);
    REQUIRE(::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                     sizeof to) >= 0);
  }
  std::optional<std::string> Receive(int patience_ms = 5000) const {
    pollfd ready = {socket_, POLLIN, 0};
    if (::poll(&ready, 1, patience_ms) <= 0) return std::nullopt;
    std::array<char, 65536> bytes;
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    REQUIRE(size >= 0);
    return std::string(bytes.data(), static_cast<std::size_t>(size));
  }

 private:
  int socket_ = -1;
  std::uint16_t number_ = 0;
};

struct Wire {
  std::string Ask(const std::string& hex) const {
    control.Send(FromHex(hex));
    const auto answer = control.Receive();
    REQUIRE(answer);
    return ToSpacedHex(*answer);
  }
  void Write(std::uint32_t address, std::uint32_t value) const {
    std::string words;
    PutU32(words, address);
    PutU32(words, value);
    CHECK(Ask("42 01 0082 0008 0007 " + ToSpacedHex(words)) ==
          "00 00 00 83 00 04 00 07 00 00 00 01");
  }
  void TakeControl(std::uint32_t packet_size) const {
    Write(0xa00, 2);
    Write(0xd18, INADDR_LOOPBACK);
    Write(0xd00, stream.number());
    Write(0xd04, packet_size);
    Write(gige::kTriggerMode, 1);
    Write(gige::kTriggerSource, 1);
    Write(gige::ComponentBlock(ScanComponent::kConfidence) + gige::kEnabled, 1);
  }
  /// All packets of one scan.
  std::vector<std::string> Scan() const {
    Write(gige::kAcquisition, 1);
    Write(gige::kTrigger, 1);
    std::vector<std::string> packets;
    constexpr unsigned kTrailer = 2;
    do {
      const auto packet = stream.Receive();
      REQUIRE(packet);
      packets.push_back(*packet);
    } while ((U8At(packets.back(), 4) & 0x7fu) != kTrailer);
    return packets;
  }

  GigeBench scanner;
  UdpPort control, stream;
};

TEST_CASE("Discovery and registers are answered by the bytes of GVCP", "[contract]") {
  const Wire wire;
  const std::string found = wire.Ask("42 11 0002 0000 0001");
  CHECK(found.substr(0, 23) == "00 00 00 03 00 F8 00 01");
  CHECK(found.substr(3 * (8 + 0x48), 23) == "50 68 6F 74 6F 6E 65 6F");
  CHECK(wire.Ask("42 01 0080 0004 0002 00000D20") == "00 00 00 81 00 04 00 02 00 00 00 40");
  CHECK(wire.Ask("42 01 0080 0004 0003 00012000") == "80 03 00 81 00 00 00 03");
  CHECK(wire.Ask("42 01 0082 0008 0004 00000D04 00000040") ==
        "80 02 00 83 00 04 00 04 00 00 00 00");
}

TEST_CASE("A test packet is as large as asked for", "[contract]") {
  const Wire wire;
  wire.TakeControl(1400);
  for (const std::uint32_t size : {576u, 1500u, 9000u}) {
    wire.Write(0xd04, 0xc0000000 | size);
    const auto packet = wire.stream.Receive();
    REQUIRE(packet);
    CHECK(packet->size() == size - 28);
    std::string word;
    PutU32(word, 0x40000000 | size);  // It is fired once.
    CHECK(wire.Ask("42 01 0080 0004 0002 00000D04") ==
          "00 00 00 81 00 04 00 02 " + ToSpacedHex(word));
  }
}

TEST_CASE("Parts travel in packets of the agreed size, and again when asked for", "[contract]") {
  const Wire wire;
  wire.TakeControl(1400);
  wire.Write(0xd24, 0x40);
  const std::vector<std::string> packets = wire.Scan();
  constexpr std::size_t kRoom = 1400 - 56;
  const std::size_t range = kScanPixels * 12, confidence = kScanPixels;
  const std::size_t of_range = (range + kRoom - 1) / kRoom;
  const std::size_t of_confidence = (confidence + kRoom - 1) / kRoom;
  REQUIRE(packets.size() == 1 + of_range + of_confidence + 1);
  CHECK(packets.front().size() == 32 + 2 * 48);
  std::string payload;
  for (std::size_t i = 1; i + 1 < packets.size(); ++i) {
    const std::string& packet = packets[i];
    CHECK(packet.size() + 28 <= 1400);
    CHECK(U32At(packet, 16) == i);
    CHECK(U8At(packet, 20) == (i <= of_range ? 0 : 1));
    CHECK(U32At(packet, 24) == payload.size());
    payload += packet.substr(28);
  }
  CHECK(payload.size() == range + confidence);

  // Two of the middle, by the frame's long id; nothing of another frame, or by a short id.
  const std::string id = ToSpacedHex(packets.front().substr(8, 8));
  CHECK(id == "00 00 00 00 00 00 00 01");
  wire.control.Send(FromHex("42 10 0040 0014 0009 00000000 00000005 00000006" + id));
  CHECK(wire.stream.Receive() == packets[5]);
  CHECK(wire.stream.Receive() == packets[6]);
  wire.control.Send(FromHex("42 10 0040 0014 0009 00000000 00000000 00000000" + id));
  CHECK(wire.stream.Receive() == packets[0]);
  wire.control.Send(FromHex("42 10 0040 0014 0009 00000000 00000005 00000006 0000000000000002"));
  wire.control.Send(FromHex("42 00 0040 000C 0009 00000001 00000005 00000006"));
  CHECK_FALSE(wire.stream.Receive(100).has_value());
}

TEST_CASE("An image has its components as chunks, and its packets again by its short id",
          "[contract]") {
  const Wire wire;
  wire.TakeControl(9000);
  const std::vector<std::string> packets = wire.Scan();
  const std::size_t range = kScanPixels * 12, confidence = kScanPixels;
  std::string payload;
  for (std::size_t i = 1; i + 1 < packets.size(); ++i) payload += packets[i].substr(8);
  REQUIRE(payload.size() == range + 8 + confidence + 8);
  CHECK(U32At(payload, range) == 4);
  CHECK(U32At(payload, range + 4) == range);
  CHECK(U32At(payload, range + 8 + confidence) == 6);
  CHECK(U32At(payload, range + 8 + confidence + 4) == confidence);
  CHECK(ToSpacedHex(packets.front().substr(0, 12)) == "00 00 00 01 01 00 00 00 00 00 40 01");
  wire.control.Send(FromHex("42 00 0040 000C 0009 00000001 00000002 00000002"));
  CHECK(wire.stream.Receive() == packets[2]);
}

TEST_CASE("Nothing is sent while no component is enabled, and after control has ended",
          "[contract]") {
  const Wire wire;
  wire.TakeControl(1400);
  wire.Write(gige::ComponentBlock(ScanComponent::kConfidence) + gige::kEnabled, 0);
  wire.Write(gige::ComponentBlock(ScanComponent::kRange) + gige::kEnabled, 0);
  wire.Write(gige::kAcquisition, 1);
  wire.Write(gige::kTrigger, 1);
  CHECK_FALSE(wire.stream.Receive(200).has_value());
  wire.Write(gige::ComponentBlock(ScanComponent::kRange) + gige::kEnabled, 1);
  CHECK(wire.Scan().size() > 2);
  wire.Write(gige::kTriggerMode, 0);  // Frame after frame,
  CHECK(wire.stream.Receive().has_value());
  wire.Write(0xa00, 0);
  int left = 1000;  // until control ends: what is under way ends too.
  while (left > 0 && wire.stream.Receive(200)) --left;
  CHECK(left > 0);
}

}  // namespace
}  // namespace tubetwin
