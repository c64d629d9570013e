#include "twin/render/recording.h"

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include <zstd.h>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"

namespace tubetwin {
namespace {

// Content before compression: the JSON head, a zero byte, then per frame force (float), overlay
// and caption (int32), qpos (nq floats), little-endian.
constexpr std::size_t kFrameHead = 12;
constexpr std::size_t kMaxContent = std::size_t{4} << 30;  // 24 hours of a large cell.
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

std::string Decompress(const std::string& packed, const std::string& path) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          ZSTD_freeDStream);
  TT_CHECK(stream != nullptr);
  std::string content;
  std::vector<char> block(ZSTD_DStreamOutSize());
  ZSTD_inBuffer in = {packed.data(), packed.size(), 0};
  std::size_t left = 1;
  while (left != 0) {
    ZSTD_outBuffer out = {block.data(), block.size(), 0};
    left = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(left)) {
      throw Error(ErrorKind::kBadData, path + ": byte " + std::to_string(in.pos) +
                                           ": no recording: " + ZSTD_getErrorName(left));
    }
    content.append(block.data(), out.pos);
    if (content.size() > kMaxContent) {
      throw Error(ErrorKind::kBadData, path + ": holds more than the 4 GiB that are allowed");
    }
    if (left != 0 && in.pos == in.size && out.pos < out.size) {
      throw Error(ErrorKind::kBadData,
                  path + ": byte " + std::to_string(in.size) + ": the recording is cut short");
    }
  }
  return content;
}

std::size_t AsCount(const JsonView& view) {
  const std::int64_t value = view.AsInteger();
  if (value < 0) view.Fail("is " + std::to_string(value) + ", allowed are 0 and more");
  return static_cast<std::size_t>(value);
}

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
  const std::string content = Decompress(ReadFile(path), path);
  const std::size_t head_size = content.find('\0');
  Json json;
  if (head_size != std::string::npos) {
    json = Json::parse(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(head_size),
                       nullptr, /*allow_exceptions=*/false);
  }
  if (!json.is_object()) throw Error(ErrorKind::kBadData, path + ": the head is no JSON object");
  const JsonView head(json, path);
  RequireSchema(head, "recording");
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
  const std::size_t nq = AsCount(head.Field("nq")), frames = AsCount(head.Field("frames"));
  const std::size_t left = content.size() - head_size - 1;
  // Both are compared with what is there before they are multiplied.
  if (nq > left || frames > left || left != frames * (kFrameHead + 4 * nq)) {
    throw Error(ErrorKind::kBadData, path + ": " + std::to_string(frames) + " frames of " +
                                         std::to_string(nq) + " coordinates do not fill the " +
                                         std::to_string(left) + " bytes that follow the head");
  }
  if (const auto ends = head.Optional("attempt_ends")) {
    double before = 0.0;
    for (std::size_t i = 0; i < ends->Size(); ++i) {
      before = ends->Item(i).AsNumber(before, static_cast<double>(frames));
      recording.attempt_ends.push_back(static_cast<int>(before));
    }
  }
  const char* bytes = content.data() + head_size + 1;
  for (std::size_t i = 0; i < frames; ++i, bytes += kFrameHead + 4 * nq) {
    recording.frames.push_back(ReadFrame(bytes, nq));
    CheckFrame(recording, recording.frames.back(), path + ": frame " + std::to_string(i) + ": ");
  }
  return recording;
}

}  // namespace tubetwin
