// What public clients of the High-Speed Ethernet Server send, byte for byte, and what they take for
// an answer. Each has its own choice of services, attributes and sizes: fs100 (hsinkoyu/fs100),
// moto-hses (masayuki-kono/moto-hses), yaskawa_ethernet (fizyr/yaskawa_ethernet), yrcom (PyPI).

#include "tests/codecs/hex.h"
#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

const std::string kAsked = " 00000000 3939393939393939 ", kAnswered = " 00000080 3939393939393939 ";

struct Exchange {
  const char* what;
  std::string request;  ///< From command on, with the data.
  std::string answer;   ///< From service on, with the data.
};

const Exchange kExchanges[] = {
    {"all: status", "7200 0100 00 01 0000", "81 00 00 00 0000 0000 c4000000 40000000"},
    {"fs100, moto-hses: B005 = 42, one byte by attribute 1", "7A00 0500 01 10 0000 2A",
     "90 00 00 00 0000 0000"},
    {"fs100, moto-hses: B005", "7A00 0500 01 0E 0000", "8E 00 00 00 0000 0000 2A"},
    {"yaskawa_ethernet: B005 whole", "7A00 0500 00 01 0000", "81 00 00 00 0000 0000 2A"},
    {"yaskawa_ethernet: I006 = -5 whole", "7B00 0600 00 02 0000 FBFF", "82 00 00 00 0000 0000"},
    {"moto-hses: I006", "7B00 0600 01 0E 0000", "8E 00 00 00 0000 0000 FBFF"},
    {"yrcom: B007 = 7 in a slot of four bytes", "7A00 0700 01 10 0000 07000000",
     "90 00 00 00 0000 0000"},
    {"yrcom: I007 = -5 in a slot of four bytes", "7B00 0700 01 10 0000 FBFFFFFF",
     "90 00 00 00 0000 0000"},
    {"yrcom: M005 = 3 in a slot of four bytes", "7900 0500 01 10 0000 03000000",
     "90 00 00 00 0000 0000"},
    {"fs100: B004 to B007 at once", "0203 0400 00 33 0000 04000000",
     "B3 00 00 00 0000 0000 04000000 00 2A 00 07"},
    {"yaskawa_ethernet: D001, D002 = 1, -1 at once",
     "0403 0100 00 34 0000 02000000 01000000 FFFFFFFF", "B4 00 00 00 0000 0000"},
    {"moto-hses: D001, D002 at once", "0403 0100 00 33 0000 02000000",
     "B3 00 00 00 0000 0000 02000000 01000000 FFFFFFFF"},
    {"yrcom: what kind of controller: one that has texts of 32", "8C00 0000 01 0E 0000",
     "8E 00 00 00 0000 0000 00*32"},
    {"yrcom: S006, S007 = a, b at once", "0C03 0600 00 34 0000 02000000 61 00*31 62 00*31",
     "B4 00 00 00 0000 0000"},
    {"moto-hses: S007, 16 characters", "7E00 0700 01 0E 0000", "8E 00 00 00 0000 0000 62 00*15"},
    {"yrcom: the newest alarm, with the texts of its sub-code", "0A03 0100 00 01 0000",
     "81 00 00 00 0000 0000 00*268"},
    {"yrcom: network input 2701 by pairs of bytes, 8 at once", "0003 8D0A 00 34 0000 02000000 0100",
     "B4 00 00 00 0000 0000"},
    {"fs100: text on the pendant", "8500 0100 01 10 0000 68656C6C6F", "90 00 00 00 0000 0000"},
    {"fs100: hold, and go on", "8300 0100 01 10 0000 01000000", "90 00 00 00 0000 0000"},
    {"fs100: start while held", "8600 0100 01 10 0000 01000000", "90 1F 01 00 5020 0000"},
    {"fs100: go on", "8300 0100 01 10 0000 02000000", "90 00 00 00 0000 0000"},
    {"yrcom: temperature of encoders, which this controller has not", "1104 0101 00 01 0000",
     "81 08 01 00 00A0 0000"},
};

TEST_CASE("requests of public clients are answered as these read answers", "[unit]") {
  ArmRig rig;
  unsigned id = 0;
  for (const Exchange& each : kExchanges) {
    INFO(each.what);
    ++id;
    const std::string request = FromHex(each.request), answer = FromHex(each.answer);
    constexpr std::size_t kSubHeader = 8;
    const auto head = [&id](const std::string& direction, std::size_t size) {
      std::string out = FromHex("59455243 2000");
      out.push_back(static_cast<char>(size & 0xff));
      out.push_back(static_cast<char>(size >> 8));
      out += FromHex("03 01 " + direction);
      out.push_back(static_cast<char>(id));
      return out;
    };
    const std::string sent = head("00", request.size() - kSubHeader) + FromHex(kAsked) + request;
    const std::string wanted = head("01", answer.size() - kSubHeader) + FromHex(kAnswered) + answer;
    CHECK(ToSpacedHex(rig.AskHses(sent)) == ToSpacedHex(wanted));
  }
}

}  // namespace
}  // namespace tubetwin::test
