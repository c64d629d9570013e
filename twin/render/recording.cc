#include "twin/render/recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include <zstd.h>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/json_text.h"

namespace tubetwin {
namespace {

// Content before compression: the JSON head, a zero byte, then per frame force (float), overlay
// and caption (int32), qpos (nq floats), little-endian.
constexpr std::size_t kFrameHead = 12;
constexpr std::size_t kMaxPacked = std::size_t{512} << 20, kMaxHead = std::size_t{64} << 20;
constexpr int kMaxCoordinates = 20000;                               // 40 hoses have 1,300.
constexpr int kMaxFrames = 24 * 3600 * Recording::kFramesPerSecond;  // A day.
constexpr std::size_t kMaxFrameBytes = std::size_t{512} << 20;       // An hour of 40 hoses.
constexpr int kCompression = 6;

Json VisualToJson(const Recording::Visual& visual) {
  Json vertices = Json::array(), faces = Json::array();
  for (const Vector3& v : visual.mesh.vertices) {
    // Micrometres are enough for the eye.
    for (int k = 0; k < 3; ++k) vertices.push_back(std::round(1e6 * v[k]) / 1e6);
  }
  for (const auto& face : visual.mesh.faces) {
    for (const int i : face) faces.push_back(i);
  }
  return {{"body", visual.body},
          {"replaces", visual.replaces},
          {"vertices_m", vertices},
          {"faces", faces}};
}

Recording::Visual ReadVisual(const JsonView& view) {
  Recording::Visual visual;
  visual.body = view.Field("body").AsString();
  const JsonView replaces = view.Field("replaces"), faces = view.Field("faces");
  for (std::size_t i = 0; i < replaces.Size(); ++i) {
    visual.replaces.push_back(replaces.Item(i).AsString());
  }
  const std::vector<double> numbers = view.Field("vertices_m").AsNumbers();
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    visual.mesh.vertices.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  const double last = static_cast<double>(visual.mesh.vertices.size()) - 1.0;
  for (std::size_t i = 0; i + 2 < faces.Size(); i += 3) {
    std::array<int, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<int>(faces.Item(i + k).AsNumber(0.0, last));
    }
    visual.mesh.faces.push_back(corners);
  }
  if (visual.mesh.faces.empty()) faces.Fail("holds no triangle");
  return visual;
}

constexpr double kCloudStep_m = 1e-4;

Json CloudToJson(const std::vector<Vector3>& cloud_N) {
  Json steps = Json::array();
  for (const Vector3& p : cloud_N) {
    for (int k = 0; k < 3; ++k) steps.push_back(std::lround(p[k] / kCloudStep_m));
  }
  return steps;
}

Json Head(const Recording& recording, std::size_t nq) {
  Json overlays = Json::array();
  for (const Recording::Overlay& overlay : recording.overlays) {
    Json lines = Json::array();
    for (const Polyline& line : overlay.lines_N) lines.push_back(ToJson(line));
    overlays.push_back({{"lines_m", lines},
                        {"classes", overlay.classes},
                        {"target", overlay.target},
                        {"cloud_tenth_mm", CloudToJson(overlay.cloud_N)}});
  }
  Json visuals = Json::array();
  for (const Recording::Visual& visual : recording.visuals) visuals.push_back(VisualToJson(visual));
  return {{"schema", "tubetwin/recording/1"},
          {"frames_per_second", Recording::kFramesPerSecond},
          {"bin", ToJson(recording.bin)},
          {"nq", nq},
          {"frames", recording.frames.size()},
          {"attempt_ends", recording.attempt_ends},
          {"captions", recording.captions},
          {"overlays", overlays},
          {"visuals", visuals},
          {"cell_xml", recording.cell_xml}};
}

/// Unpacks a recording piece by piece: what it holds is judged before it takes memory.
class Unpacker {
 public:
  Unpacker(std::string packed, std::string path)
      : packed_(std::move(packed)),
        path_(std::move(path)),
        stream_(ZSTD_createDStream(), ZSTD_freeDStream),
        block_(ZSTD_DStreamOutSize()) {
    TT_CHECK(stream_ != nullptr);
    in_ = {packed_.data(), packed_.size(), 0};
  }

  /// What comes before the next zero byte, which is passed.
  std::string UpToZero(std::size_t most) {
    std::string out;
    while (Fill()) {
      const std::string_view here(block_.data() + at_, end_ - at_);
      const std::size_t zero = here.find('\0');
      out += here.substr(0, zero);
      at_ += std::min(zero, here.size() - 1) + 1;
      if (out.size() > most) Fail("the head is longer than " + std::to_string(most) + " bytes");
      if (zero != std::string_view::npos) return out;
    }
    Fail("no recording: nothing ends the head");
  }

  /// Exactly so many bytes.
  void Read(char* to, std::size_t size) {
    while (size > 0) {
      if (!Fill()) Fail("ends before its last frame");
      const std::size_t step = std::min(size, end_ - at_);
      std::memcpy(to, block_.data() + at_, step);
      at_ += step;
      to += step;
      size -= step;
    }
  }

  void RequireEnd() {
    if (Fill()) Fail("goes on after its last frame");
  }

 private:
  [[noreturn]] void Fail(const std::string& problem) const {
    throw Error(ErrorKind::kBadData, path_ + ": " + problem);
  }

  /// Whether bytes lie ready; else all were taken.
  bool Fill() {
    while (at_ == end_) {
      if (left_ == 0) return false;
      ZSTD_outBuffer out = {block_.data(), block_.size(), 0};
      left_ = ZSTD_decompressStream(stream_.get(), &out, &in_);
      if (ZSTD_isError(left_)) {
        Fail("byte " + std::to_string(in_.pos) + ": no recording: " + ZSTD_getErrorName(left_));
      }
      if (left_ != 0 && in_.pos == in_.size && out.pos < out.size) {
        Fail("byte " + std::to_string(in_.size) + ": the recording is cut short");
      }
      at_ = 0;
      end_ = out.pos;
    }
    return true;
  }

  std::string packed_, path_;
  std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream_;
  std::vector<char> block_;
  ZSTD_inBuffer in_{};
  std::size_t at_ = 0, end_ = 0, left_ = 1;
};

Recording::Overlay ReadOverlay(const JsonView& view) {
  Recording::Overlay overlay;
  const JsonView lines = view.Field("lines_m"), classes = view.Field("classes");
  for (std::size_t i = 0; i < lines.Size(); ++i) {
    overlay.lines_N.push_back(lines.Item(i).AsPolyline());
    const double tube_class = classes.Item(i).AsNumber(0, 2);
    overlay.classes.push_back(static_cast<int>(tube_class));
  }
  const JsonView target = view.Field("target");
  const double last = static_cast<double>(lines.Size()) - 1.0;
  overlay.target = static_cast<int>(target.AsNumber(-1.0, last));
  if (const auto cloud = view.Optional("cloud_tenth_mm")) {
    const std::vector<double> steps = cloud->AsNumbers();
    for (std::size_t i = 0; i + 2 < steps.size(); i += 3) {
      overlay.cloud_N.push_back(kCloudStep_m * Vector3(steps[i], steps[i + 1], steps[i + 2]));
    }
  }
  return overlay;
}

Recording::Frame ReadFrame(const char* bytes, std::size_t nq) {
  Recording::Frame frame;
  std::memcpy(&frame.force_N, bytes, 4);
  std::memcpy(&frame.overlay, bytes + 4, 4);
  std::memcpy(&frame.caption, bytes + 8, 4);
  frame.qpos.resize(nq);
  std::memcpy(frame.qpos.data(), bytes + kFrameHead, 4 * nq);
  return frame;
}

void CheckFrame(const Recording& recording, const Recording::Frame& frame, const std::string& at) {
  auto check = [&](int index, std::size_t count, const char* name) {
    if (index < -1 || index >= static_cast<int>(count)) {
      throw Error(ErrorKind::kBadData, at + name + " is " + std::to_string(index) +
                                           ", allowed are -1 to " +
                                           std::to_string(static_cast<int>(count) - 1));
    }
  };
  check(frame.overlay, recording.overlays.size(), "overlay");
  check(frame.caption, recording.captions.size(), "caption");
  if (!std::isfinite(frame.force_N)) throw Error(ErrorKind::kBadData, at + "force is no number");
  for (const float q : frame.qpos) {
    if (!std::isfinite(q)) throw Error(ErrorKind::kBadData, at + "qpos holds what is no number");
  }
}

Recording ReadHead(const JsonView& head) {
  Recording recording;
  recording.cell_xml = head.Field("cell_xml").AsString();
  recording.bin = BinFromJson(head.Field("bin"));
  if (const auto visuals = head.Optional("visuals")) {
    for (std::size_t i = 0; i < visuals->Size(); ++i) {
      recording.visuals.push_back(ReadVisual(visuals->Item(i)));
    }
  }
  const JsonView captions = head.Field("captions"), overlays = head.Field("overlays");
  for (std::size_t i = 0; i < captions.Size(); ++i) {
    recording.captions.push_back(captions.Item(i).AsString());
  }
  for (std::size_t i = 0; i < overlays.Size(); ++i) {
    recording.overlays.push_back(ReadOverlay(overlays.Item(i)));
  }
  return recording;
}

}  // namespace

void WriteRecording(const Recording& recording, const std::string& path) {
  const std::size_t nq = recording.frames.empty() ? 0 : recording.frames.front().qpos.size();
  std::string content = Head(recording, nq).dump();
  content.push_back('\0');
  for (const Recording::Frame& frame : recording.frames) {
    TT_CHECK(frame.qpos.size() == nq);
    content.append(reinterpret_cast<const char*>(&frame.force_N), 4);
    content.append(reinterpret_cast<const char*>(&frame.overlay), 4);
    content.append(reinterpret_cast<const char*>(&frame.caption), 4);
    content.append(reinterpret_cast<const char*>(frame.qpos.data()), 4 * nq);
  }
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx);
  TT_CHECK(context != nullptr);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kCompression);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), packed.data(), packed.size(), content.data(), content.size());
  TT_CHECK(!ZSTD_isError(size));
  packed.resize(size);
  WriteFileAtomically(path, packed);
}

Recording ReadRecording(const std::string& path) {
  Unpacker content(ReadFile(path, kMaxPacked), path);
  const Json json = ParseJson(content.UpToZero(kMaxHead), path + ": head");
  if (!json.is_object()) throw Error(ErrorKind::kBadData, path + ": the head is no JSON object");
  const JsonView head(json, path);
  RequireSchema(head, "recording");
  Recording recording = ReadHead(head);
  recording.source = path;
  const int nq = IntegerIn(head.Field("nq"), 0, kMaxCoordinates);
  const int frames = IntegerIn(head.Field("frames"), 0, nq > 0 ? kMaxFrames : 0);
  const std::size_t frame_bytes = kFrameHead + 4 * static_cast<std::size_t>(nq);
  if (static_cast<std::size_t>(frames) * frame_bytes > kMaxFrameBytes) {
    throw Error(ErrorKind::kBadData, path + ": " + std::to_string(frames) + " frames of " +
                                         std::to_string(nq) + " coordinates take more than the " +
                                         std::to_string(kMaxFrameBytes) +
                                         " bytes that are allowed");
  }
  if (const auto ends = head.Optional("attempt_ends")) {
    int before = 0;
    for (std::size_t i = 0; i < ends->Size(); ++i) {
      before = IntegerIn(ends->Item(i), before, frames);
      recording.attempt_ends.push_back(before);
    }
  }
  std::vector<char> bytes(frame_bytes);
  for (int i = 0; i < frames; ++i) {
    content.Read(bytes.data(), bytes.size());
    recording.frames.push_back(ReadFrame(bytes.data(), static_cast<std::size_t>(nq)));
    CheckFrame(recording, recording.frames.back(), path + ": frame " + std::to_string(i) + ": ");
  }
  content.RequireEnd();
  return recording;
}

}  // namespace tubetwin
