#include "tests/codecs/rtu_line.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using test::FromHex;
using test::ToSpacedHex;

constexpr int kActions = 0x03E8, kStates = 0x07D0;

modbus_t* Line(int end) {
  modbus_t* line = modbus_new_rtu("in memory", 115200, 'N', 8, 1);
  REQUIRE(line != nullptr);
  REQUIRE(modbus_set_slave(line, 9) == 0);
  REQUIRE(modbus_set_socket(line, end) == 0);
  REQUIRE(modbus_set_response_timeout(line, 0, 1000) == 0);  // Answers are there beforehand.
  REQUIRE(modbus_set_byte_timeout(line, 0, 1000) == 0);
  return line;
}

int FunctionOf(const std::string& answer_hex) { return FromHex(answer_hex).at(1) & 0x7f; }

}  // namespace

RtuLine::RtuLine() {
  int ends[2];
  REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0);
  client_end_ = ends[0];
  slave_end_ = ends[1];
  client_ = Line(client_end_);
  slave_ = Line(slave_end_);
}

RtuLine::~RtuLine() {
  modbus_free(client_);
  modbus_free(slave_);
  ::close(client_end_);
  ::close(slave_end_);
}

std::string RtuLine::Taken() {
  std::string bytes(512, '\0');
  const ssize_t size = ::recv(slave_end_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return ToSpacedHex(bytes);
}

void RtuLine::Put(const std::string& hex) {
  const std::string bytes = FromHex(hex);
  REQUIRE(::write(slave_end_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
}

std::string RtuLine::Written(const Registers& values, const std::string& answer_hex) {
  Put(answer_hex);
  REQUIRE(modbus_write_registers(client_, kActions, 3, values.data()) == 3);
  return Taken();
}

std::string RtuLine::Asked(int function, int count) {
  std::uint16_t words[3];
  const auto ask = function == 3 ? modbus_read_registers : modbus_read_input_registers;
  REQUIRE(ask(client_, kStates, count, words) == -1);
  REQUIRE(errno == ETIMEDOUT);
  return Taken();
}

std::vector<std::uint16_t> RtuLine::Read(const std::string& answer_hex, int count) {
  Put(answer_hex);
  std::vector<std::uint16_t> words(static_cast<std::size_t>(count));
  const auto ask =
      FunctionOf(answer_hex) == 3 ? modbus_read_registers : modbus_read_input_registers;
  REQUIRE(ask(client_, kStates, count, words.data()) == count);
  return words;
}

std::string RtuLine::Answer(const Registers& registers, const std::string& answer_hex) {
  modbus_mapping_t* map = modbus_mapping_new_start_address(0, 0, 0, 0, kStates, 3, kStates, 3);
  REQUIRE(map != nullptr);
  std::copy(registers.begin(), registers.end(), map->tab_registers);
  std::copy(registers.begin(), registers.end(), map->tab_input_registers);
  std::uint16_t words[3];
  const auto ask =
      FunctionOf(answer_hex) == 3 ? modbus_read_registers : modbus_read_input_registers;
  CHECK(ask(client_, kStates, 3, words) == -1);  // Nobody answers yet.
  std::uint8_t request[MODBUS_RTU_MAX_ADU_LENGTH];
  const int size = modbus_receive(slave_, request);
  REQUIRE(size > 0);
  REQUIRE(modbus_reply(slave_, request, size, map) > 0);
  modbus_mapping_free(map);
  std::string bytes(512, '\0');
  const ssize_t got = ::recv(client_end_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return ToSpacedHex(bytes);
}

int RtuLine::Refusal(const std::string& answer_hex, const std::optional<Registers>& values) {
  Put(answer_hex);
  std::uint16_t word = 0;
  const int done = values ? modbus_write_registers(client_, kActions, 3, values->data())
                          : modbus_read_registers(client_, kStates, 1, &word);
  REQUIRE(done == -1);
  return errno;
}

}  // namespace tubetwin
