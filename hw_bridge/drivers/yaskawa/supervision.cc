#include "hw_bridge/drivers/yaskawa/supervision.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "hw_bridge/codecs/simple_message.h"
#include "hw_bridge/drivers/yaskawa/tcp_client.h"
#include "models/base/error.h"
#include "models/base/frames.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr const char* kJob = "INIT_ROS";
constexpr double kTurned_deg = 5.0;
constexpr double kSameScale = 0.02;  ///< Angles are told to 0.001 degrees or so.
constexpr auto kIoPatience = std::chrono::seconds(1);
/// OUT#889 to OUT#896.
constexpr std::int32_t kOutputGroup = 1112;
constexpr int kFirstOutput = 889;
constexpr const char* kOutputs[] = {"waits for motion", "motion done",   "initialised",
                                    "server runs",      "motion client", "state client",
                                    "I/O client",       "failure"};
constexpr int kInitialised = 2, kServer = 3, kFailure = 7;

/// The fix when `bad`, nothing otherwise.
std::string If(bool bad, const std::string& fix) { return bad ? fix : ""; }

bool Has(std::uint32_t bits, std::uint32_t bit) { return (bits & bit) != 0; }

DeviceFinding AlarmFinding(HsesClient& client) {
  const auto read = client.ReadAlarm();
  if (const auto* problem = std::get_if<HsesProblem>(&read)) {
    return {"arm alarm", problem->reason, ""};
  }
  const auto& alarm = std::get<hses::Alarm>(read);
  if (alarm.code == 0) return {"arm alarm", "none", ""};
  return {"arm alarm", std::to_string(alarm.code) + " " + Printable(alarm.name),
          "remove its cause and reset it at the pendant"};
}

DeviceFinding JobFinding(HsesClient& client, bool running) {
  const auto read = client.ReadJob();
  if (const auto* problem = std::get_if<HsesProblem>(&read)) {
    return {"arm job", problem->reason, ""};
  }
  const auto& job = std::get<hses::Job>(read);
  const std::string state = running ? ", runs, line " + std::to_string(job.line) : ", does not run";
  if (job.name == kJob) return {"arm job", job.name + state, ""};
  const std::string name = job.name.empty() ? "none is selected" : Printable(job.name) + state;
  return {"arm job", name + "; INIT_ROS is not seen",
          running ? "end that job: the controller runs one at a time"
                  : "load INIT_ROS.JBI and call it up once at the pendant"};
}

DeviceFinding PulseFinding(HsesClient& client, const YaskawaConfig& config, const JointVector& q) {
  const std::string what = "arm encoders";
  const auto read = client.ReadPosition(hses::kPulses);
  if (const auto* problem = std::get_if<HsesProblem>(&read)) return {what, problem->reason, ""};
  const PulseScale scale = PulsesPerDegree(std::get<hses::Position>(read).axes, q);
  if (scale.wrong_joint != 0) {
    return {what,
            "pulses and angle of joint " + std::to_string(scale.wrong_joint) + " have other signs",
            "check that cell.arm.host and both ports are of one controller"};
  }
  if (!scale.pulses_per_degree) {
    return {what, "no joint is turned by 5 degrees, so that pulses cannot be compared", ""};
  }
  const double told = std::round(10.0 * *scale.pulses_per_degree) / 10.0;
  const bool other = std::abs(told / config.pulses_per_degree - 1.0) > kSameScale;
  return {
      what,
      Number(told) + " pulses per degree, the cell file says " + Number(config.pulses_per_degree),
      If(other, "set cell.arm.pulses_per_degree = " + Number(told))};
}

void AskHses(const YaskawaConfig& config, const JointVector& q, std::vector<DeviceFinding>& out) {
  using hses::Status;
  constexpr int kTries = 3;
  if (config.hses_port == 0) {
    out.push_back({"arm supervision", "none: cell.arm.hses_port = 0", ""});
    return;
  }
  HsesClient client(SupervisionOf(config, kTries));
  const auto read = client.ReadStatus();
  if (const auto* problem = std::get_if<HsesProblem>(&read)) {
    out.push_back({"arm supervision", problem->reason,
                   "enable the controller's High-Speed Ethernet Server and check "
                   "cell.arm.hses_port, or set it to 0"});
    return;
  }
  const auto& status = std::get<Status>(read);
  out.push_back(AlarmFinding(client));
  const bool play = Has(status.data1, Status::kPlay);
  const bool remote = Has(status.data1, Status::kCommandRemote);
  out.push_back({"arm mode",
                 std::string(play ? "PLAY" : "TEACH") + (remote ? ", REMOTE" : ", not REMOTE"),
                 If(!play || !remote, "turn the pendant's key to REMOTE")});
  std::vector<std::string> holds;
  if (Has(status.data2, Status::kPendantHold)) holds.emplace_back("by the pendant");
  if (Has(status.data2, Status::kExternalHold)) holds.emplace_back("by an external input");
  if (Has(status.data2, Status::kCommandHold)) holds.emplace_back("by a command");
  out.push_back({"arm hold", holds.empty() ? "none" : Join(holds),
                 If(!holds.empty(), "release it where it was set")});
  out.push_back({"arm drives", Has(status.data2, Status::kServoOn) ? "on" : "off", ""});
  if (Has(status.data1, Status::kSpeedLimited)) {
    out.push_back({"arm speed", "limited by the safety unit: motions take longer", ""});
  }
  out.push_back(JobFinding(client, Has(status.data1, Status::kRunning)));
  out.push_back(PulseFinding(client, config, q));
}

/// The eight outputs; throws Error(kDevice).
std::uint8_t ReadOutputs(const YaskawaConfig& config) {
  NetLoop loop;
  TcpClient client(loop, "arm (I/O)", config.host, config.io_port);
  const auto until = std::chrono::steady_clock::now() + kIoPatience;
  client.Connect(until);
  client.Send(sm::Encode(sm::Request(sm::ReadGroup{kOutputGroup})));
  sm::StreamReader reader;
  while (client.open() && std::chrono::steady_clock::now() < until) {
    loop.Wait(std::chrono::milliseconds(20));
    reader.Append(client.TakeReceived());
    const auto next = reader.Next();
    if (!next) continue;
    if (const auto* message = std::get_if<sm::Message>(&*next)) {
      const auto* reply = std::get_if<sm::ReadGroupReply>(&message->body);
      if (reply != nullptr && reply->result == 0) return static_cast<std::uint8_t>(reply->value);
    }
    throw Error(ErrorKind::kDevice, client.name() + ": no answer to what OUT#889 to 896 are");
  }
  const std::string& why = client.problem();
  throw Error(ErrorKind::kDevice, client.name() + ": " + (why.empty() ? "no answer in 1 s" : why));
}

void AskOutputs(const YaskawaConfig& config, std::vector<DeviceFinding>& out) {
  const std::string what = "arm outputs 889 to 896";
  if (config.io_port == 0) {
    out.push_back({what, "not read: cell.arm.io_port = 0", ""});
    return;
  }
  try {
    const std::uint8_t group = ReadOutputs(config);
    const auto on = [group](int bit) { return (group >> bit & 1) != 0; };
    std::vector<std::string> told;
    for (int i = 0; i < 8; ++i) {
      if (on(i)) told.push_back(std::to_string(kFirstOutput + i) + " " + kOutputs[i]);
    }
    const bool runs = on(kInitialised) && on(kServer);
    out.push_back({what, told.empty() ? "all off" : Join(told),
                   on(kFailure) ? "MotoROS has failed: see its message at the pendant, restart the "
                                  "controller"
                                : If(!runs, "install MotoROS, or restart the controller")});
  } catch (const Error& error) {
    out.push_back({what, error.what(), "check cell.arm.io_port, or set it to 0"});
  }
}

}  // namespace

HsesConfig SupervisionOf(const YaskawaConfig& config, int tries) {
  HsesConfig hses;
  hses.host = config.host;
  hses.port = config.hses_port;
  hses.pulses_per_degree = config.pulses_per_degree;
  hses.tries = tries;
  return hses;
}

PulseScale PulsesPerDegree(const std::array<std::int32_t, 8>& pulses, const JointVector& q) {
  PulseScale out;
  for (int i = 0; i < kNumJoints; ++i) {
    const double angle_deg = Degrees(q[i]);
    if (std::abs(angle_deg) < kTurned_deg) continue;
    const double scale = pulses[i] / angle_deg;
    if (scale <= 0.0) return {std::nullopt, i + 1};
    out.pulses_per_degree = std::min(scale, out.pulses_per_degree.value_or(scale));
  }
  return out;
}

std::vector<DeviceFinding> Supervise(const YaskawaConfig& config, const JointVector& q) {
  std::vector<DeviceFinding> out;
  try {
    AskHses(config, q, out);
  } catch (const Error& error) {
    out.push_back({"arm supervision", error.what(), "check cell.arm.host"});
  }
  AskOutputs(config, out);
  return out;
}

}  // namespace tubetwin
