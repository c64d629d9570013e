#include "hw_bridge/codecs/gvcp.h"

#include "hw_bridge/codecs/big_endian.h"

namespace tubetwin {
namespace {

constexpr std::uint8_t kKey = 0x42, kWantsAnswer = 0x01, kLongIdsFlag = 0x10;

DecodeError WrongSize(const char* what, std::size_t size, const char* allowed) {
  return DecodeError{std::string(what) + " of " + std::to_string(size) +
                     " bytes; allowed: " + allowed};
}

}  // namespace

std::variant<GvcpRequest, DecodeError> DecodeGvcpRequest(std::string_view bytes) {
  if (bytes.size() < kGvcpHeader || bytes.size() > kGvcpHeader + kMaxGvcpData) {
    return WrongSize("a request", bytes.size(), "8 to 548");
  }
  if (U8At(bytes, 0) != kKey) {
    return DecodeError{"a request begins with " + std::to_string(U8At(bytes, 0)) + "; allowed: 66"};
  }
  if (U16At(bytes, 4) != bytes.size() - kGvcpHeader) {
    return DecodeError{"a request says that " + std::to_string(U16At(bytes, 4)) +
                       " bytes follow; there are " + std::to_string(bytes.size() - kGvcpHeader)};
  }
  return GvcpRequest{U16At(bytes, 2), (U8At(bytes, 1) & kWantsAnswer) != 0, U16At(bytes, 6),
                     std::string(bytes.substr(kGvcpHeader)), (U8At(bytes, 1) & kLongIdsFlag) != 0};
}

std::string EncodeGvcpRequest(const GvcpRequest& request) {
  std::string out;
  PutU8(out, kKey);
  PutU8(out, (request.wants_answer ? kWantsAnswer : 0u) | (request.long_ids ? kLongIdsFlag : 0u));
  PutU16(out, request.command);
  PutU16(out, static_cast<unsigned>(request.data.size()));
  PutU16(out, request.id);
  return out + request.data;
}

std::string EncodeGvcpAnswer(const GvcpRequest& request, GvcpStatus status, std::string_view data) {
  std::string out;
  PutU16(out, static_cast<unsigned>(status));
  PutU16(out, request.command + 1u);
  PutU16(out, static_cast<unsigned>(data.size()));
  PutU16(out, request.id);
  return out + std::string(data);
}

std::variant<std::vector<std::uint32_t>, DecodeError> GvcpAddresses(std::string_view data) {
  if (data.empty() || data.size() % 4 != 0) {
    return WrongSize("addresses", data.size(), "multiples of 4");
  }
  std::vector<std::uint32_t> addresses;
  for (std::size_t at = 0; at < data.size(); at += 4) addresses.push_back(U32At(data, at));
  return addresses;
}

std::variant<std::vector<std::pair<std::uint32_t, std::uint32_t>>, DecodeError> GvcpWrites(
    std::string_view data) {
  if (data.empty() || data.size() % 8 != 0) {
    return WrongSize("addresses with values", data.size(), "multiples of 8");
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> writes;
  for (std::size_t at = 0; at < data.size(); at += 8) {
    writes.emplace_back(U32At(data, at), U32At(data, at + 4));
  }
  return writes;
}

std::variant<GvcpSpan, DecodeError> GvcpMemory(std::string_view data) {
  if (data.size() != 8) return WrongSize("a span of memory", data.size(), "8");
  return GvcpSpan{U32At(data, 0), U16At(data, 6)};
}

std::variant<GvcpResend, DecodeError> GvcpResendOf(const GvcpRequest& request) {
  const std::string_view data = request.data;
  if (!request.long_ids) {
    if (data.size() < 12) return WrongSize("packets wanted again", data.size(), "12 or more");
    constexpr std::uint32_t kPacket = 0xffffff;
    return GvcpResend{U16At(data, 2), false, U32At(data, 4) & kPacket, U32At(data, 8) & kPacket};
  }
  if (data.size() < 20) return WrongSize("packets wanted again", data.size(), "20 or more");
  const std::uint64_t id = static_cast<std::uint64_t>(U32At(data, 12)) << 32 | U32At(data, 16);
  return GvcpResend{id, true, U32At(data, 4), U32At(data, 8)};
}

}  // namespace tubetwin
