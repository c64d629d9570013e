#include "hw_bridge/drivers/yaskawa/state_link.h"

#include <cmath>

namespace tubetwin {
namespace {

namespace sm = simple_message;

/// No joint turns further than that.
constexpr double kFarthest_rad = 7.0;

bool Usable(const sm::JointFeedback& feedback) {
  if (feedback.group != 0 || (feedback.valid_fields & sm::kPosition) == 0) return false;
  const JointVector q = sm::ToJoints(feedback.q_rad);
  return q.allFinite() && q.cwiseAbs().maxCoeff() < kFarthest_rad &&
         sm::ToJoints(feedback.qd_rad_s).allFinite();
}

}  // namespace

StateLink::StateLink(NetLoop& loop, const std::string& host, int port)
    : client_(loop, "arm (state)", host, port) {}

void StateLink::Connect(std::chrono::steady_clock::time_point deadline) {
  client_.Connect(deadline);
  heard_ = std::chrono::steady_clock::now();
}

StateLink::News StateLink::Take() {
  News news;
  reader_.Append(client_.TakeReceived());
  while (const auto next = reader_.Next()) {
    if (const auto* error = std::get_if<DecodeError>(&*next)) {
      client_.Close("what came is no message: " + error->reason);
      break;
    }
    const sm::Body& body = std::get<sm::Message>(*next).body;
    if (const auto* feedback = std::get_if<sm::JointFeedback>(&body)) {
      if (!Usable(*feedback)) continue;
      news.feedback = *feedback;
      heard_ = std::chrono::steady_clock::now();
    } else if (const auto* status = std::get_if<sm::RobotStatus>(&body)) {
      news.status = *status;
    }
  }
  return news;
}

const std::string& StateLink::problem() const { return client_.problem(); }

}  // namespace tubetwin
