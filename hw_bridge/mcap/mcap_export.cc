#include "hw_bridge/mcap/mcap_export.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "hw_bridge/mcap/mcap_file.h"
#include "hw_bridge/mcap/mcap_schemas.h"
#include "hw_bridge/recording/command_difference.h"
#include "models/arm/arm.h"
#include "models/base/files.h"
#include "models/base/json.h"

namespace tubetwin {
namespace {

constexpr TimeNs kStatePeriod = std::chrono::milliseconds(10);
// Levels of foxglove.Log, and FLOAT32 of its packed fields.
constexpr int kInfo = 2, kWarning = 3, kError = 4;
constexpr int kFloat32 = 7;

Json TimeJson(TimeNs t) {
  constexpr std::int64_t kSecond = 1000000000;
  const std::int64_t ns = std::max<std::int64_t>(0, t.count());
  return {{"sec", ns / kSecond}, {"nsec", ns % kSecond}};
}

Json VectorJson(const Vector3& p) { return {{"x", p.x()}, {"y", p.y()}, {"z", p.z()}}; }

Json QuaternionJson(const Matrix3& R) {
  const auto [w, x, y, z] = QuaternionWxyz(R);
  return {{"x", x}, {"y", y}, {"z", z}, {"w", w}};
}

Json TransformJson(TimeNs time, const char* parent, const std::string& child,
                   const RigidTransform& X) {
  return {{"timestamp", TimeJson(time)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", VectorJson(X.translation())},
          {"rotation", QuaternionJson(X.linear())}};
}

std::string Base64(std::string_view bytes) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out.push_back(i + k > bytes.size() ? '=' : kLetters[word >> (18 - 6 * k) & 63]);
    }
  }
  return out;
}

const char* ToString(GripperObject object) {
  switch (object) {
    case GripperObject::kMoving:
      return "moving";
    case GripperObject::kContactOpening:
      return "contact_opening";
    case GripperObject::kContactClosing:
      return "contact_closing";
    case GripperObject::kAtPosition:
      return "at_position";
  }
  return "unknown";
}

/// Valid points of every `step`-th row and column: x y z, then the intensity, float32.
Json CloudJson(const ScanTaken& taken, int step) {
  const OrganizedCloud& cloud = taken.cloud_S;
  const bool shaded = !cloud.intensity.empty();
  std::string data;
  for (int row = 0; row < cloud.height; row += step) {
    for (int column = 0; column < cloud.width; column += step) {
      const std::size_t i = static_cast<std::size_t>(row) * cloud.width + column;
      if (!IsValid(cloud.p_SP[i])) continue;
      data.append(reinterpret_cast<const char*>(cloud.p_SP[i].data()), 12);
      if (shaded) data.append(reinterpret_cast<const char*>(&cloud.intensity[i]), 4);
    }
  }
  Json fields = Json::array();
  for (const char* name : {"x", "y", "z", "intensity"}) {
    if (fields.size() == 3 && !shaded) continue;
    fields.push_back({{"name", name}, {"offset", 4 * fields.size()}, {"type", kFloat32}});
  }
  return {{"timestamp", TimeJson(taken.at)},
          {"frame_id", "bin"},
          {"pose",
           {{"position", VectorJson(cloud.X_NS.translation())},
            {"orientation", QuaternionJson(cloud.X_NS.linear())}}},
          {"point_stride", 4 * fields.size()},
          {"fields", fields},
          {"data", Base64(data)}};
}

/// Turns events into messages.
class Exporter {
 public:
  Exporter(const CellRecordingHeader& header, const McapOptions& options, McapWriter& out)
      : header_(header), options_(options), out_(out), arm_(header.model.arm) {
    joint_states_ = Add("/joint_states", JointStatesSchema());
    tf_ = Add("/tf", FrameTransformsSchema());
    arm_state_ = Add("/arm", ArmSchema());
    gripper_ = Add("/gripper", GripperSchema());
    wrench_ = Add("/wrench", WrenchSchema());
    cloud_ = Add("/cloud", PointCloudSchema());
    log_ = Add("/log", LogSchema());
  }

  /// Frames that stand still to each other.
  void AddFixedFrames(TimeNs time) {
    const CellLayout& layout = header_.model.layout;
    const Json transforms = {TransformJson(time, "base", "bin", header_.bin.X_BN),
                             TransformJson(time, "base", "tray", layout.X_BT),
                             TransformJson(time, "flange", "wrist", layout.X_FK),
                             TransformJson(time, "flange", "tool", layout.X_FE),
                             TransformJson(time, "flange", "scanner", layout.X_FS)};
    Send(tf_, time, {{"transforms", transforms}});
  }

  void operator()(const TimeRead& e) { now_ = e.now; }
  void operator()(const TimeAdvanced& e) { now_ = e.now; }
  void operator()(const ArmRead& e) {
    AddArmState(e.state);
    if (states_at_ && e.state.time < *states_at_ + kStatePeriod) return;
    states_at_ = e.state.time;
    AddJoints(e.state);
    AddFrames(e.state);
  }
  void operator()(const ArmStarted& e) {
    Command(e.at, e);
    if (!e.answer.accepted()) Log(e.at, kWarning, "arm", "refused: " + e.answer.reason);
  }
  void operator()(const GripperRead& e) {
    opening_m_ = e.state.opening_m;
    const GripperState& s = e.state;
    Json message = {{"opening_m", s.opening_m},
                    {"requested_m", s.requested_m},
                    {"object", ToString(s.object)},
                    {"activated", s.activated},
                    {"fault", s.fault}};
    SendChanged(gripper_, s.time, std::move(message), last_gripper_);
  }
  void operator()(const WristRead& e) {
    const WrenchSample& s = e.sample;
    if (wrench_at_ && s.time <= *wrench_at_) return;  // Read again.
    wrench_at_ = s.time;
    Send(wrench_, s.time,
         {{"timestamp", TimeJson(s.time)},
          {"frame_id", "wrist"},
          {"force", VectorJson(s.wrench_K.force_N)},
          {"torque", VectorJson(s.wrench_K.torque_Nm)},
          {"saturated", s.saturated}});
  }
  void operator()(const ScanTriggered& e) {
    Command(e.at, e);
    if (!e.answer.accepted()) Log(e.at, kWarning, "scanner", "refused: " + e.answer.reason);
  }
  void operator()(const ScanTaken& e) { Send(cloud_, e.at, CloudJson(e, options_.cloud_step)); }
  void operator()(const ScanStatusRead& e) {
    if (e.status == ScanStatus::kFailed) Log(now_, kError, "scanner", "the scan failed");
  }
  void operator()(const ScanFailureRead& e) {
    if (!e.reason.empty()) Log(now_, kError, "scanner", e.reason);
  }
  void operator()(const PipelineNote& e) {
    const bool caption = e.kind == PipelineNote::Kind::kCaption;
    Log(e.at, kInfo, caption ? "pipeline" : "result", e.text);
  }
  template <typename Other>
  void operator()(const Other& e) {
    Command(e.at, e);
  }

  /// Messages of each topic so far.
  std::map<std::string, std::uint64_t> Counts() const {
    std::map<std::string, std::uint64_t> counts;
    for (const auto& [topic, channel] : topics_) counts[topic] = out_.messages(channel);
    return counts;
  }

 private:
  std::uint16_t Add(const char* topic, const McapSchema& schema) {
    const std::uint16_t channel = out_.AddChannel(topic, schema.name, schema.json);
    topics_.emplace_back(topic, channel);
    return channel;
  }

  void Send(std::uint16_t channel, TimeNs time, const Json& message) {
    // What a device says may be no UTF-8.
    out_.AddMessage(channel, time, message.dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  /// Sends only what is not what was sent last; the time does not count.
  void SendChanged(std::uint16_t channel, TimeNs time, Json message, Json& last) {
    if (message == last) return;
    last = message;
    message["timestamp"] = TimeJson(time);
    Send(channel, time, message);
  }

  void Log(TimeNs time, int level, const char* name, const std::string& text) {
    Send(log_, time,
         {{"timestamp", TimeJson(time)},
          {"level", level},
          {"message", text},
          {"name", name},
          {"file", ""},
          {"line", 0}});
  }

  template <typename E>
  void Command(TimeNs at, const E& e) {
    Log(at, kInfo, "command", Describe(CellEvent(e)));
  }

  void AddArmState(const ArmState& s) {
    const bool new_fault = s.fault != fault_;
    fault_ = s.fault;
    if (new_fault && !s.fault.empty()) Log(s.time, kError, "arm", s.fault);
    Json message = {{"mode", tubetwin::ToString(s.mode)},
                    {"progress_s", s.progress_s},
                    {"planned_s", s.planned_s},
                    {"done", s.done},
                    {"fault", s.fault}};
    // Progress alone is told as often as the joints are.
    const bool due = !arm_at_ || s.time >= *arm_at_ + kStatePeriod;
    if (!due && last_arm_["mode"] == message["mode"] && last_arm_["done"] == message["done"] &&
        last_arm_["fault"] == message["fault"]) {
      return;
    }
    arm_at_ = s.time;
    SendChanged(arm_state_, s.time, std::move(message), last_arm_);
  }

  void AddJoints(const ArmState& s) {
    Json joints = Json::array();
    for (int i = 0; i < kNumJoints; ++i) {
      joints.push_back(
          {{"name", arm_.joints[i].name}, {"position", s.q[i]}, {"velocity", s.qd[i]}});
    }
    if (opening_m_) {
      joints.push_back({{"name", "gripper_opening"}, {"position", *opening_m_}, {"velocity", 0.0}});
    }
    Send(joint_states_, s.time, {{"timestamp", TimeJson(s.time)}, {"joints", joints}});
  }

  void AddFrames(const ArmState& s) {
    const auto links_B = LinkPoses(arm_, s.q);
    Json transforms = Json::array();
    for (int i = 1; i <= kNumJoints; ++i) {
      transforms.push_back(TransformJson(s.time, "base", "link_" + std::to_string(i), links_B[i]));
    }
    transforms.push_back(TransformJson(s.time, "base", "flange", FlangePose(arm_, s.q)));
    Send(tf_, s.time, {{"transforms", transforms}});
  }

  const CellRecordingHeader& header_;
  const McapOptions& options_;
  McapWriter& out_;
  const ArmModel& arm_;
  std::vector<std::pair<std::string, std::uint16_t>> topics_;
  std::uint16_t joint_states_, tf_, arm_state_, gripper_, wrench_, cloud_, log_;
  TimeNs now_{0};
  std::optional<TimeNs> states_at_, wrench_at_, arm_at_;
  std::optional<double> opening_m_;
  std::string fault_;
  Json last_arm_, last_gripper_;
};

/// Cell time of an event; reads have their device's.
struct EventTime {
  TimeNs operator()(const TimeRead& e) const { return e.now; }
  TimeNs operator()(const TimeAdvanced& e) const { return e.now; }
  template <typename Other>
  TimeNs operator()(const Other& e) const {
    if constexpr (requires { e.at; }) {
      return e.at;
    } else {
      return now;
    }
  }
  TimeNs now;
};

}  // namespace

std::map<std::string, std::uint64_t> ExportMcap(CellRecording& recording, const std::string& path,
                                                const McapOptions& options) {
  TT_CHECK(options.cloud_step >= 1);
  const CellRecordingHeader& header = recording.header();
  std::map<std::string, std::uint64_t> counts;
  WriteFileInPieces(path, [&](OutputFile& file) {
    McapWriter out(file, "tubetwin");
    Exporter exporter(header, options, out);
    std::map<std::string, std::string> about = header.versions;
    about["seed"] = std::to_string(header.seed);
    about["fingerprint"] = header.fingerprint;
    about["complete"] = recording.complete() ? "true" : "false";
    out.AddMetadata("tubetwin", about);
    out.AddAttachment("config.resolved.toml", "application/toml", header.config_toml);
    exporter.AddFixedFrames(std::max(options.from, TimeNs(0)));
    recording.Seek(options.from);
    TimeNs now{0};
    while (const std::optional<CellEvent> event = recording.Next()) {
      now = std::visit(EventTime{now}, *event);
      if (now > options.to) break;
      if (now >= options.from) std::visit(exporter, *event);
    }
    out.Finish();
    counts = exporter.Counts();
  });
  return counts;
}

}  // namespace tubetwin
