// Control requests of GigE Vision to an emulated scanner: refused, or answered from its registers.

#include <cstdio>
#include <cstdlib>

#include "hw_bridge/codecs/gvcp.h"
#include "hw_bridge/emulators/photoneo/gige_registers.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {
namespace {

void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "GigE Vision control: %s\n", what);
  std::abort();
}

}  // namespace

void TryBytes(std::string_view bytes) {
  const auto decoded = DecodeGvcpRequest(bytes);
  if (const auto* error = std::get_if<DecodeError>(&decoded)) {
    Require(!error->reason.empty() && error->reason.size() < 400, "refused without a short reason");
    return;
  }
  const GvcpRequest& request = std::get<GvcpRequest>(decoded);
  const std::string again = EncodeGvcpRequest(request);
  Require(again.size() == bytes.size() && again.substr(2) == bytes.substr(2), "another request");
  GigeRegisters registers({160, 120, 1000.0, 0x7f000001});
  for (const bool controller : {false, true}) {
    const auto [status, data] = registers.Do(request, controller);
    Require(data.size() <= kMaxGvcpData, "an answer that is too long");
    Require(EncodeGvcpAnswer(request, status, data).size() == kGvcpHeader + data.size(), "answer");
  }
  Require(registers.Get(gige::kWidth) == 160, "a register that nobody may write");
  (void)GvcpResendOf(request);
}

std::vector<std::string> ByteCorpus() {
  using namespace std::string_literals;
  const auto request = [](GvcpCommand command, const std::string& data) {
    return EncodeGvcpRequest({static_cast<std::uint16_t>(command), true, 1, data});
  };
  return {request(GvcpCommand::kDiscovery, ""),
          request(GvcpCommand::kReadRegister, "\x00\x00\x0a\x00\x00\x01\x20\x00"s),
          request(GvcpCommand::kWriteRegister, "\x00\x00\x0d\x04\x80\x00\x05\xdc"s),
          request(GvcpCommand::kReadMemory, "\x00\x01\x00\x00\x00\x00\x02\x00"s),
          request(GvcpCommand::kWriteMemory, "\x00\x00\xb2\x00"s + std::string(64, 'x')),
          request(GvcpCommand::kPacketResend, "\x00\x00\x00\x01\x00\x00\x00\x01\x00\x00\x00\x09"s)};
}

}  // namespace tubetwin
