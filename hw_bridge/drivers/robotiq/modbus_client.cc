#include "hw_bridge/drivers/robotiq/modbus_client.h"

#include <modbus/modbus.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include "models/base/error.h"

namespace tubetwin {
namespace {

struct Limit {
  std::uint32_t s, us;
};

Limit Split(std::chrono::nanoseconds limit) {
  const auto us = std::max<std::int64_t>(
      1000, std::chrono::duration_cast<std::chrono::microseconds>(limit).count());
  return {static_cast<std::uint32_t>(us / 1000000), static_cast<std::uint32_t>(us % 1000000)};
}

}  // namespace

struct ModbusClient::Line {
  explicit Line(modbus_t* made) : modbus(made) {}
  ~Line() {
    if (connected) modbus_close(modbus);
    modbus_free(modbus);
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  modbus_t* modbus;
  bool connected = false;
};

ModbusClient::ModbusClient(const RobotiqConfig& config, std::chrono::nanoseconds limit)
    : action_start_(config.action_start), status_start_(config.status_start) {
  const bool rtu = config.transport == "rtu";
  modbus_t* made =
      rtu ? modbus_new_rtu(config.device.c_str(), 115200, 'N', 8, 1)
          : modbus_new_tcp_pi(config.host.c_str(), std::to_string(config.port).c_str());
  const auto fail = [&] {
    throw Error(ErrorKind::kDevice, config.Name() + ": no connection by Modbus " +
                                        (rtu ? "RTU: " : "TCP: ") + modbus_strerror(errno));
  };
  if (made == nullptr) fail();
  line_ = std::make_unique<Line>(made);
  const Limit wait = Split(limit);
  TT_CHECK(modbus_set_slave(made, config.slave) == 0);
  TT_CHECK(modbus_set_response_timeout(made, wait.s, wait.us) == 0);
  if (modbus_connect(made) != 0) fail();
  line_->connected = true;
}

ModbusClient::~ModbusClient() = default;

void ModbusClient::SetAnswerLimit(std::chrono::nanoseconds limit) {
  const Limit wait = Split(limit);
  TT_CHECK(modbus_set_response_timeout(line_->modbus, wait.s, wait.us) == 0);
  TT_CHECK(modbus_set_byte_timeout(line_->modbus, wait.s, wait.us) == 0);
}

ModbusClient::Result ModbusClient::Write(const GripperRegisters& words) {
  modbus_flush(line_->modbus);  // Answers that came too late or twice.
  const int count = static_cast<int>(words.size());
  return Judge(modbus_write_registers(line_->modbus, action_start_, count, words.data()) == count);
}

ModbusClient::Result ModbusClient::Read(GripperRegisters& words) {
  modbus_flush(line_->modbus);
  const int count = static_cast<int>(words.size());
  const auto read = by_input_registers_ ? modbus_read_input_registers : modbus_read_registers;
  const bool done = read(line_->modbus, status_start_, count, words.data()) == count;
  if (!done && errno == EMBXILFUN) by_input_registers_ = !by_input_registers_;
  return Judge(done);
}

ModbusClient::Result ModbusClient::Judge(bool done) {
  const int why = errno;
  if (done) {
    problem_.clear();
    return Result::kDone;
  }
  problem_ = modbus_strerror(why);
  if (why >= EMBXILFUN && why <= EMBXGTAR) return Result::kRefused;
  switch (why) {
    case EPIPE:
    case ECONNRESET:
    case ECONNREFUSED:
    case ECONNABORTED:
    case EBADF:
    case EIO:
    case ENODEV:
    case ENXIO:
    case EHOSTUNREACH:
    case ENETUNREACH:
      return Result::kLost;
    default:
      return Result::kNoAnswer;
  }
}

}  // namespace tubetwin
