#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tubetwin {

/// The registers of a slave, as its client sees them.
class ModbusRegisters {
 public:
  virtual ~ModbusRegisters() = default;
  virtual bool IsReadable(int start, int count) const = 0;
  virtual bool IsWritable(int start, int count) const = 0;
  /// Precondition of both: the addresses are such.
  virtual std::vector<std::uint16_t> Read(int start, int count) = 0;
  virtual void Write(int start, const std::vector<std::uint16_t>& values) = 0;
};

/// The slave's side of Modbus without its link: bytes in, bytes out. Framing, check sums, answers
/// and exceptions are libmodbus's; the functions are 3, 4, 16 and 23, any other is illegal.
class ModbusSlave {
 public:
  enum class Transport { kTcp, kRtu };
  /// RTU: requests to other slaves are ignored. TCP: units `slave`, 0 and 255 are this one, others
  /// do not answer their gateway.
  ModbusSlave(Transport transport, int slave);
  ~ModbusSlave();

  enum class Found {
    kNothing,  ///< The begin of a request.
    kRequest,  ///< It is answered.
    kIgnored,  ///< No request to this slave; RTU: all that was received is gone.
    kGarbage,  ///< TCP: no request can begin so, close the connection.
  };
  /// Takes the first request off `received`; `answer` is what the slave says to it.
  Found Take(std::string& received, ModbusRegisters& registers, std::string& answer);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
