#include "hw_bridge/codecs/gvcp.h"

#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using test::FromHex;
using test::ToSpacedHex;

GvcpRequest Decoded(const std::string& hex) {
  const auto request = DecodeGvcpRequest(FromHex(hex));
  if (const auto* error = std::get_if<DecodeError>(&request)) FAIL(error->reason);
  return std::get<GvcpRequest>(request);
}

std::string Reason(const std::string& bytes) {
  const auto request = DecodeGvcpRequest(bytes);
  REQUIRE(std::holds_alternative<DecodeError>(request));
  return std::get<DecodeError>(request).reason;
}

TEST_CASE("A register is asked for and told by the bytes of GVCP", "[unit]") {
  const GvcpRequest request = Decoded("42 01 0080 0004 0102 00000934");
  CHECK(request.command == static_cast<std::uint16_t>(GvcpCommand::kReadRegister));
  CHECK(request.wants_answer);
  CHECK(request.id == 0x0102);
  CHECK(std::get<std::vector<std::uint32_t>>(GvcpAddresses(request.data)) ==
        std::vector<std::uint32_t>{0x934});
  CHECK(ToSpacedHex(EncodeGvcpRequest(request)) ==
        ToSpacedHex(FromHex("42 01 0080 0004 0102 00000934")));
  CHECK(ToSpacedHex(EncodeGvcpAnswer(request, GvcpStatus::kSuccess, FromHex("00000007"))) ==
        ToSpacedHex(FromHex("0000 0081 0004 0102 00000007")));
  CHECK(ToSpacedHex(EncodeGvcpAnswer(request, GvcpStatus::kInvalidAddress, "")) ==
        ToSpacedHex(FromHex("8003 0081 0000 0102")));
}

TEST_CASE("What the other requests say is read", "[unit]") {
  const auto writes = GvcpWrites(Decoded("42 01 0082 0008 0001 00000A00 00000002").data);
  CHECK(std::get<0>(writes) == std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0xa00, 2}});
  const auto span =
      std::get<GvcpSpan>(GvcpMemory(Decoded("42 01 0084 0008 0001 00010000 00000200").data));
  CHECK(span.address == 0x10000);
  CHECK(span.size == 0x200);
  const auto again = std::get<GvcpResend>(
      GvcpResendOf(Decoded("42 00 0040 000C 0001 00000007 00000003 00000005")));
  CHECK(again.frame_id == 7);
  CHECK_FALSE(again.long_ids);
  CHECK(again.first == 3);
  CHECK(again.last == 5);
  const GvcpRequest of_parts =
      Decoded("42 10 0040 0014 0001 00000000 01000003 01000005 0102030405060708");
  CHECK_FALSE(of_parts.wants_answer);
  const auto parts = std::get<GvcpResend>(GvcpResendOf(of_parts));
  CHECK(parts.frame_id == 0x0102030405060708);
  CHECK(parts.long_ids);
  CHECK(parts.first == 0x01000003);
  CHECK(parts.last == 0x01000005);
  CHECK(ToSpacedHex(EncodeGvcpRequest(of_parts)) ==
        ToSpacedHex(FromHex("42 10 0040 0014 0001 00000000 01000003 01000005 0102030405060708")));
}

TEST_CASE("What is no request says why, and so do data of another length", "[unit]") {
  CHECK_THAT(Reason(""), Contains("a request of 0 bytes"));
  CHECK_THAT(Reason(std::string(600, 'B')), Contains("a request of 600 bytes"));
  CHECK_THAT(Reason(FromHex("43 01 0080 0000 0001")), Contains("begins with 67; allowed: 66"));
  CHECK_THAT(Reason(FromHex("42 01 0080 0008 0001 00000000")),
             Contains("says that 8 bytes follow; there are 4"));
  CHECK(std::holds_alternative<DecodeError>(GvcpAddresses("")));
  CHECK(std::holds_alternative<DecodeError>(GvcpAddresses("12345")));
  CHECK(std::holds_alternative<DecodeError>(GvcpWrites("1234")));
  CHECK(std::holds_alternative<DecodeError>(GvcpMemory("1234")));
  CHECK(std::holds_alternative<DecodeError>(GvcpResendOf({0x40, false, 1, "12345678"})));
  CHECK(std::holds_alternative<DecodeError>(
      GvcpResendOf({0x40, false, 1, std::string(16, '\0'), true})));
}

}  // namespace
}  // namespace tubetwin
