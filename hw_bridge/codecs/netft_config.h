#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "hw_bridge/codecs/decode_error.h"
#include "hw_bridge/codecs/rdt.h"

namespace tubetwin {

/// What a Net F/T box says of itself in /netftapi2.xml; the fields of that page that matter here,
/// and those that clients are known to need.
struct NetftPage {
  std::string product;              ///< prodname.
  double counts_per_force = 1e6;    ///< cfgcpf, per force_unit.
  double counts_per_torque = 1e6;   ///< cfgcpt, per torque_unit.
  std::string force_unit = "N";     ///< scfgfu: N, kN, lbf, klbf, kgf, gf.
  std::string torque_unit = "N-m";  ///< scfgtu: N-m, N-mm, kN-m, lbf-in, lbf-ft, kgf-cm; also Nm.
  double rate_Hz = 0;               ///< comrdtrate; 0 when the page has none.
  std::uint32_t status = 0;         ///< runstat, as in the records; 0 when the page has none.
  std::string configuration;        ///< cfgnam: the active configuration's name.
  std::string serial;               ///< setserial, cfgcalsn: of transducer and calibration.
  std::string ratings;              ///< cfgmr: "65;65;200;5;5;5", largest readings in its units.

  bool operator==(const NetftPage&) const = default;
};

/// Fails when the page is none: longer than 64 KB, a tag missing (rate and status may), a count or
/// rate that is no positive number, a status that is no 32-bit number. Other tags are skipped.
std::variant<NetftPage, DecodeError> DecodeNetftPage(std::string_view xml);
/// The page of the box's only configuration, number 0. Texts are escaped; characters that XML
/// cannot hold become '?'. Numbers are written without an exponent, whole ones without a point:
/// clients read them as integers.
std::string EncodeNetftPage(const NetftPage& page);
/// Its page /netftcalapi.xml, of its only calibration, number 0.
std::string EncodeNetftCalibrationPage(const NetftPage& page);

/// Counts of each N and N m, converted where the box has other units; fails for a unit that is not
/// in the lists above.
std::variant<RdtScale, DecodeError> ScaleOf(const NetftPage& page);

}  // namespace tubetwin
