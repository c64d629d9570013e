// The configuration page of a Net F/T box: refused with a reason, or the same after a round trip.

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "hw_bridge/codecs/netft_config.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {
namespace {

void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "Net F/T page: %s\n", what);
  std::abort();
}

bool IsPlain(const std::string& text) {
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (code < 0x20 || code == 0x7f) return false;
  }
  return text.empty() || (text.front() != ' ' && text.back() != ' ');
}

}  // namespace

void TryBytes(std::string_view bytes) {
  const auto decoded = DecodeNetftPage(bytes);
  if (const auto* error = std::get_if<DecodeError>(&decoded)) {
    Require(!error->reason.empty() && error->reason.size() < 400, "refused without a short reason");
    return;
  }
  const NetftPage page = std::get<NetftPage>(decoded);
  Require(page.counts_per_force > 0 && std::isfinite(page.counts_per_force), "counts per force");
  Require(page.counts_per_torque > 0 && std::isfinite(page.counts_per_torque), "counts per torque");
  const auto scale = ScaleOf(page);
  if (const auto* error = std::get_if<DecodeError>(&scale)) {
    Require(!error->reason.empty() && error->reason.size() < 400, "a unit without a short reason");
  } else {
    Require(std::get<RdtScale>(scale).counts_per_N > 0, "a scale that is none");
  }
  for (const std::string* text : {&page.product, &page.force_unit, &page.torque_unit,
                                  &page.configuration, &page.serial, &page.ratings}) {
    if (!IsPlain(*text)) return;
  }
  const auto again = DecodeNetftPage(EncodeNetftPage(page));
  Require(std::holds_alternative<NetftPage>(again) && std::get<NetftPage>(again) == page,
          "another page");
}

std::vector<std::string> ByteCorpus() {
  NetftPage page;
  page.product = "ATI <Net> & F/T";
  page.rate_Hz = 7000;
  page.status = 0x80020000;
  page.configuration = "of the cell";
  page.serial = "FT1";
  page.ratings = "65;65;200;5;5;5";
  NetftPage other = page;
  other.force_unit = "lbf";
  other.torque_unit = "lbf-in";
  return {
      EncodeNetftPage(page), EncodeNetftPage(other),
      "<cfgcpf> 1e6 </cfgcpf><cfgcpt>1000000.5</cfgcpt><scfgfu>&quot;</scfgfu><scfgtu>Nm</scfgtu>"};
}

}  // namespace tubetwin
