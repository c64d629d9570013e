#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hw_bridge/codecs/decode_error.h"
#include "models/base/wrench.h"

namespace tubetwin {

// Raw data transfer of the ATI Net F/T over UDP, big-endian.

enum class RdtCommand : std::uint16_t {
  kStop = 0x0000,
  kStartRealTime = 0x0002,   ///< One record a datagram.
  kStartBuffered = 0x0003,   ///< Several records a datagram.
  kStartMultiUnit = 0x0004,  ///< As real time, synchronised with other units.
  kResetThreshold = 0x0041,
  kSetBias = 0x0042,
};

struct RdtRequest {
  RdtCommand command = RdtCommand::kStop;
  std::uint32_t sample_count = 0;  ///< 0: without end.
  bool operator==(const RdtRequest&) const = default;
};

inline constexpr std::size_t kRdtRequestSize = 8;
inline constexpr std::size_t kRdtRecordSize = 36;
/// Of one datagram: what an Ethernet frame holds.
inline constexpr std::size_t kMaxRdtRecords = 40;

struct RdtRecord {
  std::uint32_t rdt_sequence = 0;        ///< Place in this stream, from 1.
  std::uint32_t ft_sequence = 0;         ///< The sensor's own count of samples.
  std::uint32_t status = 0;              ///< Bits below; 0 is healthy.
  std::array<std::int32_t, 6> counts{};  ///< Fx Fy Fz Tx Ty Tz.
  bool operator==(const RdtRecord&) const = default;
};

// Bits of the status word.
inline constexpr std::uint32_t kRdtErrorSummary = 0x80000000;
inline constexpr std::uint32_t kRdtSaturation = 0x00020000;        ///< Or an A/D error.
inline constexpr std::uint32_t kRdtThresholdLatched = 0x00010000;  ///< A warning, no fault.
/// The bits that speak of a broken sensor or box: all but summary, saturation and threshold.
inline std::uint32_t RdtFaultBits(std::uint32_t status) {
  return status & ~(kRdtErrorSummary | kRdtSaturation | kRdtThresholdLatched);
}
/// "supply low, network error (status 0x80400020)"; empty for 0.
std::string RdtStatusText(std::uint32_t status);

std::string EncodeRdtRequest(const RdtRequest& request);
/// Fails for another length, another first word and unknown commands.
std::variant<RdtRequest, DecodeError> DecodeRdtRequest(std::string_view bytes);

/// Appends the record's 36 bytes.
void EncodeRdtRecord(const RdtRecord& record, std::string& out);
/// The records of one datagram, 1 to 40 of them; fails when its length is another. Any bytes of
/// such a length are records: the protocol has no check sum.
std::variant<std::vector<RdtRecord>, DecodeError> DecodeRdtRecords(std::string_view bytes);

/// Counts of each N and N m, by configuration of the box.
struct RdtScale {
  double counts_per_N = 1e6, counts_per_Nm = 1e6;

  /// Nearest counts, clamped to 32 bits.
  std::array<std::int32_t, 6> CountsOf(const Wrench& wrench) const;
  Wrench WrenchOf(const std::array<std::int32_t, 6>& counts) const;
};

}  // namespace tubetwin
