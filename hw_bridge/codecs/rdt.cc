#include "hw_bridge/codecs/rdt.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "hw_bridge/codecs/big_endian.h"

namespace tubetwin {
namespace {

constexpr std::uint16_t kRequestHeader = 0x1234;

bool IsCommand(std::uint16_t command) {
  switch (static_cast<RdtCommand>(command)) {
    case RdtCommand::kStop:
    case RdtCommand::kStartRealTime:
    case RdtCommand::kStartBuffered:
    case RdtCommand::kStartMultiUnit:
    case RdtCommand::kResetThreshold:
    case RdtCommand::kSetBias:
      return true;
  }
  return false;
}

std::string Hex(std::uint32_t value, int digits) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%0*x", digits, value);
  return text;
}

constexpr std::pair<std::uint32_t, const char*> kStatusBits[] = {
    {0x40000000, "CPU or RAM error"},
    {0x20000000, "digital board error"},
    {0x10000000, "analog board error"},
    {0x08000000, "serial link error"},
    {0x04000000, "program memory error"},
    {0x02000000, "halted, configuration error"},
    {0x01000000, "settings error"},
    {0x00800000, "configuration does not fit the calibration"},
    {0x00400000, "network error"},
    {0x00200000, "CAN error"},
    {0x00100000, "RDT error"},
    {0x00080000, "EtherNet/IP error"},
    {0x00040000, "DeviceNet error"},
    {kRdtSaturation, "saturation or A/D error"},
    {kRdtThresholdLatched, "threshold latched"},
    {0x00008000, "unknown bit 0x8000"},
    {0x00004000, "watchdog reset"},
    {0x00002000, "stack error"},
    {0x00001000, "EEPROM error"},
    {0x00000800, "flash error"},
    {0x00000400, "analog watchdog"},
    {0x00000200, "gauge excitation high"},
    {0x00000100, "gauge excitation low"},
    {0x00000080, "ground error"},
    {0x00000040, "supply high"},
    {0x00000020, "supply low"},
    {0x00000010, "serial data error"},
    {0x00000008, "reference voltage error"},
    {0x00000004, "temperature error"},
    {0x00000002, "HTTP error"},
    {0x00000001, "unknown bit 0x1"},
};

std::int32_t CountOf(double value) {
  constexpr double kMax = 2147483647.0;
  if (std::isnan(value)) return 0;
  return static_cast<std::int32_t>(std::clamp(std::round(value), -kMax - 1.0, kMax));
}

}  // namespace

std::string RdtStatusText(std::uint32_t status) {
  if (status == 0) return "";
  std::string text;
  for (const auto& [bit, meaning] : kStatusBits) {
    if ((status & bit) == 0) continue;
    if (!text.empty()) text += ", ";
    text += meaning;
  }
  if (text.empty()) text = "error without a cause";
  return text + " (status " + Hex(status, 8) + ")";
}

std::string EncodeRdtRequest(const RdtRequest& request) {
  std::string bytes;
  PutU16(bytes, kRequestHeader);
  PutU16(bytes, static_cast<std::uint16_t>(request.command));
  PutU32(bytes, request.sample_count);
  return bytes;
}

std::variant<RdtRequest, DecodeError> DecodeRdtRequest(std::string_view bytes) {
  if (bytes.size() != kRdtRequestSize) {
    return DecodeError{"a request of " + std::to_string(bytes.size()) + " bytes; allowed: 8"};
  }
  if (U16At(bytes, 0) != kRequestHeader) {
    return DecodeError{"a request begins with " + Hex(U16At(bytes, 0), 4) + "; allowed: 0x1234"};
  }
  const std::uint16_t command = U16At(bytes, 2);
  if (!IsCommand(command)) {
    return DecodeError{"command " + Hex(command, 4) +
                       "; allowed: 0x0000, 0x0002, 0x0003, 0x0004, 0x0041, 0x0042"};
  }
  return RdtRequest{static_cast<RdtCommand>(command), U32At(bytes, 4)};
}

void EncodeRdtRecord(const RdtRecord& record, std::string& out) {
  PutU32(out, record.rdt_sequence);
  PutU32(out, record.ft_sequence);
  PutU32(out, record.status);
  for (const std::int32_t count : record.counts) PutU32(out, static_cast<std::uint32_t>(count));
}

std::variant<std::vector<RdtRecord>, DecodeError> DecodeRdtRecords(std::string_view bytes) {
  const std::size_t number = bytes.size() / kRdtRecordSize;
  if (number < 1 || number > kMaxRdtRecords || bytes.size() % kRdtRecordSize != 0) {
    return DecodeError{"records of " + std::to_string(bytes.size()) +
                       " bytes; allowed: 1 to 40 times 36"};
  }
  std::vector<RdtRecord> records(number);
  for (std::size_t i = 0; i < number; ++i) {
    const std::string_view at = bytes.substr(i * kRdtRecordSize, kRdtRecordSize);
    RdtRecord& record = records[i];
    record.rdt_sequence = U32At(at, 0);
    record.ft_sequence = U32At(at, 4);
    record.status = U32At(at, 8);
    for (std::size_t k = 0; k < 6; ++k) {
      record.counts[k] = static_cast<std::int32_t>(U32At(at, 12 + 4 * k));
    }
  }
  return records;
}

std::array<std::int32_t, 6> RdtScale::CountsOf(const Wrench& wrench) const {
  std::array<std::int32_t, 6> counts;
  for (int i = 0; i < 3; ++i) {
    counts[i] = CountOf(wrench.force_N[i] * counts_per_N);
    counts[3 + i] = CountOf(wrench.torque_Nm[i] * counts_per_Nm);
  }
  return counts;
}

Wrench RdtScale::WrenchOf(const std::array<std::int32_t, 6>& counts) const {
  Wrench wrench;
  for (int i = 0; i < 3; ++i) {
    wrench.force_N[i] = counts[i] / counts_per_N;
    wrench.torque_Nm[i] = counts[3 + i] / counts_per_Nm;
  }
  return wrench;
}

}  // namespace tubetwin
