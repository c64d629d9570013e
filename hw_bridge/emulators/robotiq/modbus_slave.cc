#include "hw_bridge/emulators/robotiq/modbus_slave.h"

#include <modbus/modbus.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>

#include "hw_bridge/codecs/big_endian.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

struct FreeLine {
  void operator()(modbus_t* line) const { modbus_free(line); }
};
struct FreeMap {
  void operator()(modbus_mapping_t* map) const { modbus_mapping_free(map); }
};

// The protocol's own limits, whatever the registers.
constexpr int kMaxRead = 125, kMaxWritten = 123, kMaxWrittenAndRead = 121;

/// What a request asks for.
struct Request {
  int function = 0;
  int read_start = 0, read_count = 0;  ///< Count 0: nothing is read.
  int write_start = 0;
  std::vector<std::uint16_t> values;  ///< Empty: nothing is written.
};

std::vector<std::uint16_t> Values(std::string_view pdu, std::size_t at, int count) {
  std::vector<std::uint16_t> values;
  for (int i = 0; i < count; ++i)
    values.push_back(U16At(pdu, at + 2 * static_cast<std::size_t>(i)));
  return values;
}

/// The request of a PDU that libmodbus has found whole; nothing when libmodbus is to refuse it:
/// another function, counts that disagree or are out of the protocol's limits.
std::optional<Request> Parsed(std::string_view pdu) {
  Request request;
  request.function = U8At(pdu, 0);
  switch (request.function) {
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_READ_INPUT_REGISTERS:
      request.read_start = U16At(pdu, 1);
      request.read_count = U16At(pdu, 3);
      break;
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS: {
      const int count = U16At(pdu, 3);
      if (count < 1 || count > kMaxWritten || U8At(pdu, 5) != 2 * count) return std::nullopt;
      request.write_start = U16At(pdu, 1);
      request.values = Values(pdu, 6, count);
      return request;
    }
    case MODBUS_FC_WRITE_AND_READ_REGISTERS: {
      const int count = U16At(pdu, 7);
      if (count < 1 || count > kMaxWrittenAndRead || U8At(pdu, 9) != 2 * count) {
        return std::nullopt;
      }
      request.read_start = U16At(pdu, 1);
      request.read_count = U16At(pdu, 3);
      request.write_start = U16At(pdu, 5);
      request.values = Values(pdu, 10, count);
      break;
    }
    default:
      return std::nullopt;
  }
  if (request.read_count < 1 || request.read_count > kMaxRead) return std::nullopt;
  return request;
}

}  // namespace

/// libmodbus reads and writes one end of a pair of sockets; what is received is put into the other
/// end first, so it never waits.
struct ModbusSlave::Impl {
  Impl(Transport how, int number) : transport(how), slave(number) {
    TT_CHECK(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) ==
             0);
    line.reset(transport == Transport::kTcp ? modbus_new_tcp("127.0.0.1", 502)
                                            : modbus_new_rtu("pair", 115200, 'N', 8, 1));
    TT_CHECK(line != nullptr);
    TT_CHECK(modbus_set_slave(line.get(), slave) == 0);
    TT_CHECK(modbus_set_socket(line.get(), ends[0]) == 0);
    // The shortest waits that it knows: all that there is is there.
    TT_CHECK(modbus_set_indication_timeout(line.get(), 0, 1) == 0);
    TT_CHECK(modbus_set_response_timeout(line.get(), 0, 1) == 0);
    TT_CHECK(modbus_set_byte_timeout(line.get(), 0, 1) == 0);
  }
  ~Impl() {
    ::close(ends[0]);
    ::close(ends[1]);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::string Drain(int end) const {
    std::string all;
    std::array<char, 512> bytes;
    while (true) {
      const ssize_t size = ::recv(end, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size <= 0) return all;
      all.append(bytes.data(), static_cast<std::size_t>(size));
    }
  }

  /// Bytes of the frame at the begin of `received`; 0 when it is not there yet, nothing when there
  /// can be none. RTU frames tell no length: all that is there.
  std::optional<std::size_t> FrameSize(std::string_view received) const {
    if (transport == Transport::kRtu) {
      return std::min<std::size_t>(received.size(), MODBUS_RTU_MAX_ADU_LENGTH);
    }
    if (received.size() >= 4 && U16At(received, 2) != 0) return std::nullopt;
    if (received.size() < 6) return 0;
    const std::size_t size = 6u + U16At(received, 4);
    if (size < 8 || size > MODBUS_TCP_MAX_ADU_LENGTH) return std::nullopt;
    return received.size() < size ? 0 : size;
  }

  /// What the registers and libmodbus make of the request in `frame`.
  void Reply(const std::uint8_t* frame, int size, ModbusRegisters& registers) {
    const int header = modbus_get_header_length(line.get());
    const std::string_view pdu(reinterpret_cast<const char*>(frame) + header,
                               static_cast<std::size_t>(size - header));
    const int unit = frame[header - 1];
    if (transport == Transport::kTcp && unit != slave && unit != 0 && unit != 255) {
      modbus_reply_exception(line.get(), frame, MODBUS_EXCEPTION_GATEWAY_TARGET);
      return;
    }
    const auto request = Parsed(pdu);
    if (!request) {
      const int function = U8At(pdu, 0);
      const bool known = function == MODBUS_FC_READ_HOLDING_REGISTERS ||
                         function == MODBUS_FC_READ_INPUT_REGISTERS ||
                         function == MODBUS_FC_WRITE_MULTIPLE_REGISTERS ||
                         function == MODBUS_FC_WRITE_AND_READ_REGISTERS;
      modbus_reply_exception(
          line.get(), frame,
          known ? MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE : MODBUS_EXCEPTION_ILLEGAL_FUNCTION);
      return;
    }
    const int written = static_cast<int>(request->values.size());
    if ((written > 0 && !registers.IsWritable(request->write_start, written)) ||
        (request->read_count > 0 &&
         !registers.IsReadable(request->read_start, request->read_count))) {
      modbus_reply_exception(line.get(), frame, MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
      return;
    }
    if (written > 0) registers.Write(request->write_start, request->values);
    Confirm(frame, size, *request, registers);
  }

  void Confirm(const std::uint8_t* frame, int size, const Request& request,
               ModbusRegisters& registers) {
    const int written = static_cast<int>(request.values.size());
    // The span of all that the request names, so that libmodbus finds each at its address.
    int low = written > 0 ? request.write_start : request.read_start;
    int high = written > 0 ? request.write_start + written : low;
    if (request.read_count > 0) {
      low = std::min(low, request.read_start);
      high = std::max(high, request.read_start + request.read_count);
    }
    const auto base = static_cast<unsigned>(low), count = static_cast<unsigned>(high - low);
    const std::unique_ptr<modbus_mapping_t, FreeMap> map(
        modbus_mapping_new_start_address(0, 0, 0, 0, base, count, base, count));
    TT_CHECK(map != nullptr);
    if (request.read_count > 0) {
      const std::vector<std::uint16_t> words =
          registers.Read(request.read_start, request.read_count);
      TT_CHECK(words.size() == static_cast<std::size_t>(request.read_count));
      std::copy(words.begin(), words.end(), map->tab_registers + (request.read_start - low));
      std::copy(words.begin(), words.end(), map->tab_input_registers + (request.read_start - low));
    }
    modbus_reply(line.get(), frame, size, map.get());
  }

  Transport transport;
  int slave;
  std::array<int, 2> ends{-1, -1};
  std::unique_ptr<modbus_t, FreeLine> line;
};

ModbusSlave::ModbusSlave(Transport transport, int slave)
    : impl_(std::make_unique<Impl>(transport, slave)) {}

ModbusSlave::~ModbusSlave() = default;

ModbusSlave::Found ModbusSlave::Take(std::string& received, ModbusRegisters& registers,
                                     std::string& answer) {
  answer.clear();
  const std::optional<std::size_t> size = impl_->FrameSize(received);
  if (!size) return Found::kGarbage;
  if (*size == 0) return Found::kNothing;
  // Not left to libmodbus: after a request to another slave it waits for that one's answer.
  if (impl_->transport == Transport::kRtu && U8At(received, 0) != impl_->slave) {
    received.clear();
    return Found::kIgnored;
  }
  TT_CHECK(::write(impl_->ends[1], received.data(), *size) == static_cast<ssize_t>(*size));
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> frame;
  errno = 0;
  const int got = modbus_receive(impl_->line.get(), frame.data());
  const int why = errno;
  impl_->Drain(impl_->ends[0]);
  const bool tcp = impl_->transport == Transport::kTcp;
  if (got <= 0) {
    if (tcp) return Found::kGarbage;
    if (got < 0 && why == ETIMEDOUT && received.size() < MODBUS_RTU_MAX_ADU_LENGTH) {
      return Found::kNothing;
    }
    received.clear();
    return Found::kIgnored;
  }
  if (tcp && static_cast<std::size_t>(got) != *size) return Found::kGarbage;
  received.erase(0, static_cast<std::size_t>(got));
  impl_->Reply(frame.data(), got, registers);
  answer = impl_->Drain(impl_->ends[1]);
  return Found::kRequest;
}

}  // namespace tubetwin
