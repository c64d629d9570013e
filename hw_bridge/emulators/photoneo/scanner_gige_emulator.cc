#include "hw_bridge/emulators/photoneo/scanner_gige_emulator.h"

#include <chrono>
#include <cstring>
#include <exception>
#include <utility>

#include "models/base/error.h"
#include "models/base/random.h"

namespace tubetwin {
namespace {

constexpr std::size_t kPointBytes = 12;

std::vector<std::byte> Millimetres(const OrganizedCloud& cloud) {
  std::vector<std::byte> bytes(cloud.size() * kPointBytes);
  std::byte* out = bytes.data();
  for (const Eigen::Vector3f& p : cloud.p_SP) {
    Eigen::Vector3f mm = Eigen::Vector3f::Zero();
    if (IsValid(p)) mm = (p.cast<double>() * 1000.0).cast<float>();
    std::memcpy(out, mm.data(), kPointBytes);
    out += kPointBytes;
  }
  return bytes;
}

void FillWithGarbage(std::vector<std::byte>& bytes, std::uint64_t seed) {
  RandomStream stream(seed, 0, "garbage frame");
  for (std::byte& b : bytes) b = static_cast<std::byte>(stream.Index(256));
}

/// As a bad cable would, if the packets' checksums let it pass: all over the frame.
void Corrupt(std::vector<std::byte>& bytes) {
  for (std::size_t i = 3; i < bytes.size(); i += 7) bytes[i] ^= std::byte{0x95};
}

/// 16 bits, 0 is no frame.
std::uint16_t NextFrame(std::uint16_t frame_id) {
  return frame_id == 0xffff ? 1 : static_cast<std::uint16_t>(frame_id + 1);
}

}  // namespace

ScannerGigeEmulator::ScannerGigeEmulator(Scanner& scanner, const ScannerGigeConfig& config)
    : scanner_(scanner),
      config_(config),
      sender_(config.listen),
      camera_(config.listen, config.width, config.height, sender_) {}

ScannerGigeEmulator::~ScannerGigeEmulator() { stop_sending_ = true; }  // The futures wait.

void ScannerGigeEmulator::Tick(TimeNs now) {
  if (link_.freeze) return;
  switch (stage_) {
    case Stage::kIdle:
      return Start();
    case Stage::kScanning:
      return FollowScan();
    case Stage::kComputing:
      return TakeImage(now);
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

void ScannerGigeEmulator::Compute() {
  const auto compute = [take = scanner_.TakeLater(), fault = fault_.fault, number = triggers_,
                        corrupt = link_.corrupt, config = config_]() -> Image {
    try {
      OrganizedCloud cloud = take();
      if (cloud.width != config.width || cloud.height != config.height) {
        return {{},
                "the cloud has " + std::to_string(cloud.width) + " x " +
                    std::to_string(cloud.height) + " points, " + std::to_string(config.width) +
                    " x " + std::to_string(config.height) + " are announced"};
      }
      if (fault == ScanFault::kEmptyCloud) ClearPoints(cloud);
      std::vector<std::byte> bytes = Millimetres(cloud);
      if (fault == ScanFault::kGarbage) FillWithGarbage(bytes, number);
      if (corrupt) Corrupt(bytes);
      return {std::move(bytes), ""};
    } catch (const std::exception& error) {
      return {{}, error.what()};
    }
  };
  computing_ = std::async(std::launch::async, compute);
  stage_ = Stage::kComputing;
}

void ScannerGigeEmulator::TakeImage(TimeNs now) {
  if (computing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Image image = computing_.get();
  if (!image.problem.empty()) return GiveUp(image.problem);
  bytes_ = std::move(image.bytes);
  send_at_ = now + link_.delay + FromSeconds(fault_.delay_s);
  stage_ = Stage::kHolding;
}

void ScannerGigeEmulator::Send(TimeNs now) {
  if (link_.drop) return GiveUp("");
  constexpr double kTruncatedShare = 0.6;
  GvspSender::Frame frame;
  frame.image.timestamp_ns = static_cast<std::uint64_t>(now.count());
  frame.image.pixel_format = kPixelCoord3dAbc32f;
  frame.image.width = static_cast<std::uint32_t>(config_.width);
  frame.image.height = static_cast<std::uint32_t>(config_.height);
  frame.bytes = std::exchange(bytes_, {});
  frame.packet_size = camera_.packet_size();
  if (fault_.fault == ScanFault::kTruncated) frame.sent_share = kTruncatedShare;
  const int copies = link_.duplicate ? 2 : 1;
  const std::uint16_t before = frame_id_;
  for (int i = 0; i < copies; ++i) frame_id_ = NextFrame(frame_id_);
  stop_sending_ = false;
  sending_ = std::async(std::launch::async, [this, copies, before, client = client_,
                                             frame = std::move(frame)]() mutable {
    frame.image.frame_id = before;
    for (int i = 0; i < copies; ++i) {
      frame.image.frame_id = NextFrame(frame.image.frame_id);
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
  bytes_.clear();
  stage_ = Stage::kIdle;
}

}  // namespace tubetwin
