#include "hw_bridge/codecs/netft_config.h"

#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

/// As a box writes it: many other tags, other spacing.
constexpr const char* kPage = R"(<?xml version="1.0" encoding="ISO-8859-1"?>
<netft><runstat>0x00000000</runstat><runft>  -1, 2, 3, 4, 5, 6</runft>
<prodname>ATI Industrial Automation &amp; Net F/T</prodname>
<setbias>0;0;0;0;0;0;</setbias>
<scfgfu>N</scfgfu><scfgtu>Nm</scfgtu>
<cfgcalsn>FT12345</cfgcalsn><cfgcpf>1000000</cfgcpf><cfgcpt> 1000000 </cfgcpt>
<comrdte>Enabled</comrdte><comrdtrate>7000</comrdtrate></netft>
)";

NetftPage DecodedPage(const std::string& xml) {
  const auto page = DecodeNetftPage(xml);
  if (const auto* error = std::get_if<DecodeError>(&page)) FAIL(error->reason);
  return std::get<NetftPage>(page);
}

std::string PageReason(const std::string& xml) {
  const auto page = DecodeNetftPage(xml);
  REQUIRE(std::holds_alternative<DecodeError>(page));
  return std::get<DecodeError>(page).reason;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE("The configuration page of a Net F/T box is read", "[unit]") {
  const NetftPage page = DecodedPage(kPage);
  CHECK(page.product == "ATI Industrial Automation & Net F/T");
  CHECK(page.counts_per_force == 1e6);
  CHECK(page.counts_per_torque == 1e6);
  CHECK(page.force_unit == "N");
  CHECK(page.torque_unit == "Nm");
  CHECK(page.rate_Hz == 7000);
  CHECK(page.status == 0);
  const auto scale = ScaleOf(page);
  REQUIRE(std::holds_alternative<RdtScale>(scale));
  CHECK(std::get<RdtScale>(scale).counts_per_N == 1e6);
  CHECK(std::get<RdtScale>(scale).counts_per_Nm == 1e6);
}

TEST_CASE("Other units of the box are converted, unknown ones are refused", "[unit]") {
  NetftPage page = DecodedPage(kPage);
  page.force_unit = "lbf";
  page.torque_unit = "lbf-in";
  const auto pounds = std::get<RdtScale>(ScaleOf(page));
  CHECK(pounds.counts_per_N == Approx(1e6 / 4.4482216152605).epsilon(1e-12));
  CHECK(pounds.counts_per_Nm == Approx(1e6 / (4.4482216152605 * 0.0254)).epsilon(1e-12));
  page.force_unit = "kN";
  page.torque_unit = "N-mm";
  const auto metric = std::get<RdtScale>(ScaleOf(page));
  CHECK(metric.counts_per_N == Approx(1e3).epsilon(1e-12));
  CHECK(metric.counts_per_Nm == Approx(1e9).epsilon(1e-12));
  page.force_unit = "stone";
  CHECK_THAT(std::get<DecodeError>(ScaleOf(page)).reason,
             Contains("force unit \"stone\"; allowed: N, kN"));
  page.force_unit = "N";
  page.torque_unit = "";
  CHECK_THAT(std::get<DecodeError>(ScaleOf(page)).reason, Contains("torque unit \"\""));
}

TEST_CASE("Numbers of the pages are whole where they are, and never have an exponent", "[unit]") {
  NetftPage page;
  page.serial = "FT1";
  page.ratings = "65;65;200;5;5;5";
  page.rate_Hz = 7000;
  for (const auto& [count, text] : std::vector<std::pair<double, std::string>>{
           {1e6, "1000000"}, {1e9, "1000000000"}, {20.0, "20"}, {333.33, "333.33"}}) {
    page.counts_per_force = page.counts_per_torque = count;
    const std::string xml = EncodeNetftPage(page), cal = EncodeNetftCalibrationPage(page);
    CHECK_THAT(xml, Contains("<cfgcpf>" + text + "</cfgcpf>") &&
                        Contains("<cfgcpt>" + text + "</cfgcpt>") &&
                        Contains("<comrdtrate>7000</comrdtrate>"));
    CHECK_THAT(cal, Contains("<calcpf>" + text + "</calcpf>") &&
                        Contains("<calcpt>" + text + "</calcpt>"));
  }
  // What clients split the page at: the active configuration, then its calibration.
  CHECK_THAT(EncodeNetftPage(page),
             Contains("<setcfgsel>0</setcfgsel>") && Contains("<cfgcalsel>0</cfgcalsel>") &&
                 Contains("<cfgnam></cfgnam>") && Contains("<setserial>FT1</setserial>") &&
                 Contains("<cfgmr>65;65;200;5;5;5</cfgmr>"));
  CHECK_THAT(EncodeNetftCalibrationPage(page),
             Contains("<netftCalibration>") && Contains("<calsn>FT1</calsn>") &&
                 Contains("<scalfu>N</scalfu>") && Contains("<scaltu>N-m</scaltu>"));
}

TEST_CASE("A page that is none says what is wrong", "[unit]") {
  CHECK_THAT(PageReason(""), Contains("no <cfgcpf>"));
  CHECK_THAT(PageReason(Replaced(kPage, "<cfgcpt>", "<cfgcpx>")), Contains("no <cfgcpt>"));
  CHECK_THAT(PageReason(Replaced(kPage, "</scfgfu>", "")), Contains("no <scfgfu>"));
  CHECK_THAT(PageReason(Replaced(kPage, "1000000", "0")), Contains("<cfgcpf> is \"0\""));
  CHECK_THAT(PageReason(Replaced(kPage, "1000000", "inf")), Contains("a positive number"));
  CHECK_THAT(PageReason(Replaced(kPage, "1000000", "1e6x")), Contains("\"1e6x\""));
  CHECK_THAT(PageReason(Replaced(kPage, "0x00000000", "0x123456789")), Contains("<runstat>"));
  CHECK_THAT(PageReason(std::string(70000, ' ')), Contains("70000 bytes"));
}

TEST_CASE("Every page comes back from its XML", "[unit]") {
  const char* const forces[] = {"N", "kN", "lbf", "klbf", "kgf", "gf"};
  const char* const torques[] = {"N-m", "N-mm", "kN-m", "lbf-in", "lbf-ft", "kgf-cm"};
  for (int round = 0; round < 1000; ++round) {
    RandomStream stream(1, static_cast<std::uint64_t>(round), "netft page");
    NetftPage page;
    for (std::uint32_t i = stream.Index(30); i > 0; --i) {
      page.product += static_cast<char>(0x21 + stream.Index(0x5e));
    }
    page.counts_per_force = stream.Uniform(1, 1e7);
    page.counts_per_torque = stream.Uniform(1e-3, 1);
    page.force_unit = forces[stream.Index(6)];
    page.torque_unit = torques[stream.Index(6)];
    page.rate_Hz = stream.Index(2) == 0 ? 0 : 1 + stream.Index(7000);
    page.status = stream.Index(65536) << 16 | stream.Index(65536);
    REQUIRE(DecodedPage(EncodeNetftPage(page)) == page);
    REQUIRE(std::holds_alternative<RdtScale>(ScaleOf(page)));
  }
}

}  // namespace
}  // namespace tubetwin
