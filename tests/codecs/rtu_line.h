#pragma once

#include <modbus/modbus.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tubetwin {

/// libmodbus as the client of an RTU line in memory, on which the test plays slave 9: what does it
/// write there, what does it read in what is answered?
class RtuLine {
 public:
  using Registers = std::array<std::uint16_t, 3>;
  RtuLine();
  ~RtuLine();
  RtuLine(const RtuLine&) = delete;
  RtuLine& operator=(const RtuLine&) = delete;

  /// Writes three registers from 0x03E8 and is answered; what went over the line, as hex. The
  /// client must have taken the answer.
  std::string Written(const Registers& values, const std::string& answer_hex);
  /// Asks for registers from 0x07D0 and is not answered; what went over the line, as hex.
  std::string Asked(int function, int count);
  /// The registers in an answer to the function that it names.
  std::vector<std::uint16_t> Read(const std::string& answer_hex, int count);
  /// A slave of libmodbus that holds `registers` from 0x07D0 on is asked with the function that
  /// `answer_hex` names; its answer, as hex.
  std::string Answer(const Registers& registers, const std::string& answer_hex);
  /// The error of libmodbus when this answers a write of values, or a question for one register.
  int Refusal(const std::string& answer_hex, const std::optional<Registers>& values);

 private:
  std::string Taken();
  void Put(const std::string& hex);
  modbus_t* client_;
  modbus_t* slave_;
  int client_end_ = -1, slave_end_ = -1;
};

}  // namespace tubetwin
