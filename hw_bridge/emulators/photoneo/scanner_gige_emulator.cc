#include "hw_bridge/emulators/photoneo/scanner_gige_emulator.h"

#include <chrono>
#include <exception>
#include <utility>

#include "hw_bridge/codecs/big_endian.h"
#include "models/base/error.h"
#include "models/base/random.h"

namespace tubetwin {
namespace {

/// Behind each chunk's data: its id and length, big-endian.
void EndChunk(std::vector<std::byte>& bytes, std::uint32_t id, std::size_t size) {
  std::string trailer;
  PutU32(trailer, id);
  PutU32(trailer, static_cast<std::uint32_t>(size));
  for (const char each : trailer) bytes.push_back(static_cast<std::byte>(each));
}

/// All parts as one image with chunks.
void ChainAsChunks(GvspSender::Frame& frame) {
  std::vector<std::byte> chain;
  for (std::size_t i = 0; i < frame.parts.size(); ++i) {
    chain.insert(chain.end(), frame.bytes[i].begin(), frame.bytes[i].end());
    EndChunk(chain, frame.parts[i].purpose_id, frame.bytes[i].size());
  }
  frame.chunks = true;
  frame.parts.resize(1);
  frame.bytes = {std::move(chain)};
}

void FillWithGarbage(std::vector<std::byte>& bytes, std::uint64_t seed) {
  RandomStream stream(seed, 0, "garbage frame");
  for (std::byte& b : bytes) b = static_cast<std::byte>(stream.Index(256));
}

/// As a bad cable would, if the packets' checksums let it pass: all over the frame.
void Corrupt(std::vector<std::byte>& bytes) {
  for (std::size_t i = 3; i < bytes.size(); i += 7) bytes[i] ^= std::byte{0x95};
}

}  // namespace

ScannerGigeEmulator::ScannerGigeEmulator(Scanner& scanner, const ScannerGigeConfig& config)
    : scanner_(scanner),
      config_(config),
      sender_(config.listen),
      camera_(config.listen, config.width, config.height, config.optics.focal_px, sender_) {}

ScannerGigeEmulator::~ScannerGigeEmulator() { stop_sending_ = true; }  // The futures wait.

void ScannerGigeEmulator::Tick(TimeNs now) {
  if (link_.freeze) return;
  switch (stage_) {
    case Stage::kIdle:
      return Start();
    case Stage::kScanning:
      return FollowScan();
    case Stage::kComputing:
      return TakeFrame(now);
    case Stage::kHolding:
      if (Outdated()) return GiveUp("");
      if (now >= send_at_) Send(now);
      return;
    case Stage::kSending:
      return FollowSending();
  }
}

bool ScannerGigeEmulator::Outdated() const {
  return camera_.triggered() || camera_.client() != client_;
}

void ScannerGigeEmulator::Start() {
  const std::optional<GvspClient> client = camera_.TakeTrigger();
  if (!client || link_.drop) return;
  ++triggers_;
  client_ = *client;
  fault_ = faults_.Next();
  if (fault_.fault == ScanFault::kNoAnswer) return;
  if (fault_.fault == ScanFault::kRefused) return GiveUp(fault_.reason);
  const CommandResult triggered = scanner_.Trigger();
  if (!triggered.accepted()) return GiveUp(triggered.reason);
  stage_ = Stage::kScanning;
}

void ScannerGigeEmulator::FollowScan() {
  switch (scanner_.Status()) {
    case ScanStatus::kBusy:
      return;
    case ScanStatus::kReady:
      return Compute();
    case ScanStatus::kFailed:
      return GiveUp(scanner_.FailureReason());
    case ScanStatus::kIdle:
      return GiveUp("the scan got lost");
  }
}

ScannerGigeEmulator::Taken ScannerGigeEmulator::FrameOf(const OrganizedCloud& cloud,
                                                        const ScannerGigeConfig& config,
                                                        const GigeFrameSettings& settings) {
  Taken taken;
  if (cloud.width != config.width || cloud.height != config.height) {
    taken.problem = "the cloud has " + std::to_string(cloud.width) + " x " +
                    std::to_string(cloud.height) + " points, " + std::to_string(config.width) +
                    " x " + std::to_string(config.height) + " are announced";
    return taken;
  }
  taken.frame.multipart = settings.multipart;
  for (const auto& [component, pixel_format] : settings.components) {
    std::vector<std::byte> bytes =
        ComponentBytes(cloud, component, pixel_format, config.optics, settings.normals_radius);
    const ScanComponentInfo& info = InfoOf(component);
    taken.frame.parts.push_back({info.id, info.data, pixel_format,
                                 static_cast<std::uint32_t>(cloud.width),
                                 static_cast<std::uint32_t>(cloud.height), bytes.size()});
    taken.frame.bytes.push_back(std::move(bytes));
  }
  if (taken.frame.parts.empty()) taken.problem = "no component is enabled";
  return taken;
}

void ScannerGigeEmulator::Compute() {
  const auto compute = [take = scanner_.TakeLater(), fault = fault_.fault, number = triggers_,
                        corrupt = link_.corrupt, config = config_,
                        settings = camera_.frame_settings()]() -> Taken {
    try {
      OrganizedCloud cloud = take();
      if (fault == ScanFault::kEmptyCloud) ClearPoints(cloud);
      Taken taken = FrameOf(cloud, config, settings);
      for (std::vector<std::byte>& bytes : taken.frame.bytes) {
        if (fault == ScanFault::kGarbage) FillWithGarbage(bytes, number);
        if (corrupt) Corrupt(bytes);
      }
      if (!settings.multipart && taken.frame.parts.size() > 1) ChainAsChunks(taken.frame);
      return taken;
    } catch (const std::exception& error) {
      return {{}, error.what()};
    }
  };
  computing_ = std::async(std::launch::async, compute);
  stage_ = Stage::kComputing;
}

void ScannerGigeEmulator::TakeFrame(TimeNs now) {
  if (computing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Taken taken = computing_.get();
  if (!taken.problem.empty()) return GiveUp(taken.problem);
  frame_ = std::move(taken.frame);
  send_at_ = now + link_.delay + FromSeconds(fault_.delay_s);
  stage_ = Stage::kHolding;
}

void ScannerGigeEmulator::Send(TimeNs now) {
  if (link_.drop) return GiveUp("");
  constexpr double kTruncatedShare = 0.6;
  GvspSender::Frame frame = std::exchange(frame_, {});
  frame.id.timestamp_ns = static_cast<std::uint64_t>(now.count());
  frame.packet_size = camera_.packet_size();
  if (fault_.fault == ScanFault::kTruncated) frame.sent_share = kTruncatedShare;
  const int copies = link_.duplicate ? 2 : 1;
  const std::uint64_t before = frame_id_;
  frame_id_ += static_cast<std::uint64_t>(copies);
  stop_sending_ = false;
  sending_ = std::async(std::launch::async, [this, copies, before, client = client_,
                                             frame = std::move(frame)]() mutable {
    for (int i = 1; i <= copies; ++i) {
      frame.id.id = before + static_cast<std::uint64_t>(i);
      sender_.Send(frame, client, stop_sending_);
    }
  });
  stage_ = Stage::kSending;
}

void ScannerGigeEmulator::FollowSending() {
  if (Outdated()) stop_sending_ = true;
  if (sending_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  sending_.get();
  ++answers_;
  stage_ = Stage::kIdle;
}

void ScannerGigeEmulator::GiveUp(const std::string& problem) {
  if (!problem.empty()) last_problem_ = problem;
  frame_ = {};
  stage_ = Stage::kIdle;
}

}  // namespace tubetwin
