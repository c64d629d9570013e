#include <cstdio>
#include <cstdlib>

#include "hw_bridge/codecs/simple_message.h"
#include "tests/fuzz/byte_target.h"

namespace tubetwin {
namespace {

using namespace simple_message;

[[noreturn]] void Die(const char* problem) {
  std::fprintf(stderr, "simple_message: %s\n", problem);
  std::abort();
}

}  // namespace

void TryBytes(std::string_view bytes) {
  for (const bool use_length : {false, true}) {
    const auto front = DecodeFront(bytes, use_length);
    if (const auto* message = std::get_if<Message>(&front)) {
      const std::string again = Encode(*message);
      if (again.size() > bytes.size() || again.size() > kLargestMessage) Die("longer than it was");
      // The length before it is the only word that may differ.
      if (again.substr(4) != bytes.substr(4, again.size() - 4)) Die("encodes to other bytes");
      if (use_length && again != bytes.substr(0, again.size())) Die("has another length");
    } else if (std::get<NoMessage>(front).reason.empty()) {
      Die("no reason");
    }
  }
  const auto request = DecodeRequestFront(bytes);
  if (const auto* front = std::get_if<FrontRequest>(&request)) {
    if (front->size < kHeadSize || front->size > bytes.size()) Die("a request of another size");
  }
  StreamReader reader;
  std::size_t taken = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 7) {
    reader.Append(bytes.substr(at, 7));
    while (auto next = reader.Next()) {
      if (const auto* message = std::get_if<Message>(&*next)) taken += Encode(*message).size();
    }
  }
  if (taken > bytes.size()) Die("more messages than bytes");
}

std::vector<std::string> ByteCorpus() {
  JointPoint point;
  point.q_rad = {0.1f, -0.2f, 1.5f};
  std::vector<std::string> out;
  for (const Body& body :
       std::vector<Body>{Ping{}, point, MotionControl{}, SelectTool{}, ReadBit{}, WriteBit{},
                         ReadGroup{}, WriteGroup{}, ReadRegister{}, WriteRegister{}}) {
    out.push_back(Encode(Request(body)));
  }
  for (const Body& body :
       std::vector<Body>{Ping{}, MotionReply{}, ReadBitReply{}, WriteBitReply{}, ReadGroupReply{},
                         WriteGroupReply{}, ReadRegisterReply{}, WriteRegisterReply{}}) {
    out.push_back(Encode(Reply(body)));
  }
  out.push_back(Encode(Topic(JointFeedback{})) + Encode(Topic(RobotStatus{})));
  return out;
}

}  // namespace tubetwin
