#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <memory>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "scenes/engine/engine_error.h"
#include "twin/render/film_panels.h"
#include "twin/render/picture.h"
#include "twin/render/recording.h"
#include "twin/render/scan/smooth_edges.h"
#include "twin/render/stage.h"

namespace tubetwin {
namespace {

// Perceived lines run inside the tubes; moved this much towards the camera they lie on top.
constexpr double kLineLift_m = 0.016;
constexpr double kLineRadius_m = 0.0038, kTargetRadius_m = 0.0065;
constexpr double kLineTolerance_m = 0.0015;  // Half a pixel.

/// Draws frames of one recording; every worker has its own data and OpenGL context.
class FrameDrawer {
 public:
  FrameDrawer(const Recording& recording, int workers, StageQuality quality)
      : recording_(recording),
        quality_(quality),
        model_(CompileStage(recording, recording.source, quality)) {
    const std::size_t nq = static_cast<std::size_t>(model_->nq);
    for (const Recording::Frame& frame : recording.frames) {
      if (frame.qpos.size() == nq) continue;
      throw Error(ErrorKind::kBadData, recording.source + ": its frames have " +
                                           std::to_string(frame.qpos.size()) +
                                           " coordinates, its cell has " + std::to_string(nq));
    }
    workers_.resize(static_cast<std::size_t>(workers));
    for (Worker& worker : workers_) {
      worker.data = MakeData(*model_);
      worker.renderer = std::make_unique<SceneRenderer>(*model_, kPictureWidth, kPictureHeight);
    }
  }

  /// The scene of one frame with its perceived lines, without panels.
  Image Draw(int frame, int worker) {
    mjData& data = *workers_[worker].data;
    const mjModel& model = *model_;
    std::copy(recording_.frames[frame].qpos.begin(), recording_.frames[frame].qpos.end(),
              data.qpos);
    GuardEngine([&] {
      mj_normalizeQuat(&model, data.qpos);  // Single precision in the file.
      mj_kinematics(&model, &data);
      mj_comPos(&model, &data);
      mj_camlight(&model, &data);
    });
    Image image = workers_[worker].renderer->Draw(data, CellView(), Strokes(frame));
    if (quality_ == StageQuality::kFilm) SmoothEdges(image);
    return image;
  }

 private:
  struct Worker {
    MjData data;
    std::unique_ptr<SceneRenderer> renderer;
  };

  std::vector<Stroke> Strokes(int frame) const {
    std::vector<Stroke> strokes;
    const int index = recording_.frames[frame].overlay;
    if (index < 0) return strokes;
    const Recording::Overlay& overlay = recording_.overlays[index];
    for (std::size_t i = 0; i < overlay.lines_N.size(); ++i) {
      const bool target = static_cast<int>(i) == overlay.target;
      Polyline line_B =
          Transformed(recording_.bin.X_BN, Simplified(overlay.lines_N[i], kLineTolerance_m));
      for (Vector3& p : line_B) p += kLineLift_m * (CellView().eye_B - p).normalized();
      strokes.push_back({line_B, target ? kTargetRadius_m : kLineRadius_m,
                         target ? kTargetColour : ClassColour(overlay.classes[i])});
    }
    return strokes;
  }

  const Recording& recording_;
  const StageQuality quality_;
  const MjModel model_;
  std::vector<Worker> workers_;
};

/// Whether two frames' scenes look the same: nothing moved by what a picture could show.
bool LooksSame(const Recording::Frame& a, const Recording::Frame& b) {
  constexpr float kInvisible = 1e-4f;  // Metres, or radians at a metre: 0.04 pixels.
  if (a.overlay != b.overlay) return false;
  for (std::size_t i = 0; i < a.qpos.size(); ++i) {
    if (std::abs(a.qpos[i] - b.qpos[i]) > kInvisible) return false;
  }
  return true;
}

/// For every picture of the film the frame whose scene it shows: its own, or the last drawn one
/// while the cell stands still (scans, weighing).
std::vector<int> SceneFrames(const Recording& recording, int stride) {
  std::vector<int> scenes;
  for (int frame = 0; frame < static_cast<int>(recording.frames.size()); frame += stride) {
    const bool same =
        !scenes.empty() && LooksSame(recording.frames[scenes.back()], recording.frames[frame]);
    scenes.push_back(same ? scenes.back() : frame);
  }
  return scenes;
}

void Encode(cv::VideoWriter& writer, std::vector<Image>& images) {
  for (Image& image : images) {
    writer.write(cv::Mat(image.height, image.width, CV_8UC3, image.bgr.data()));
  }
}

/// Draws batch after batch, in parallel, while the batch before is encoded.
void DrawAndEncode(const Recording& recording, int stride, Parallelism parallelism,
                   cv::VideoWriter& writer) {
  const int count = (static_cast<int>(recording.frames.size()) + stride - 1) / stride;
  const int workers = std::clamp(parallelism.threads, 1, count);
  FrameDrawer drawer(recording, workers, StageQuality::kFilm);  // Checks the frames' sizes.
  const std::vector<int> scenes = SceneFrames(recording, stride);
  constexpr int kBatchPerWorker = 8;
  const int batch = kBatchPerWorker * workers;
  std::vector<Image> encoding;
  std::map<int, Image> drawn;  // By scene; those that the batch needs.
  for (int first = 0; first < count; first += batch) {
    const auto policy = workers > 1 ? std::launch::async : std::launch::deferred;
    std::future<void> encoded = std::async(policy, [&] { Encode(writer, encoding); });
    const int pictures = std::min(batch, count - first);
    drawn.erase(drawn.begin(), drawn.lower_bound(scenes[first]));
    std::vector<std::pair<const int, Image>*> wanted;
    for (int i = first; i < first + pictures; ++i) {
      const auto [entry, added] = drawn.try_emplace(scenes[i]);
      if (added) wanted.push_back(&*entry);
    }
    ParallelFor(static_cast<int>(wanted.size()), {workers}, [&](int i, int worker) {
      wanted[i]->second = drawer.Draw(wanted[i]->first, worker);
    });
    std::vector<Image> finished(static_cast<std::size_t>(pictures));
    ParallelFor(pictures, {workers}, [&](int i, int) {
      finished[i] = drawn.at(scenes[first + i]);
      DrawPanels(recording, (first + i) * stride, finished[i]);
    });
    encoded.get();
    encoding = std::move(finished);
  }
  Encode(writer, encoding);
}

}  // namespace

void RenderFilm(const Recording& recording, const std::string& path, int stride,
                Parallelism parallelism) {
  TT_CHECK(stride >= 1);
  if (recording.frames.empty()) {
    throw Error(ErrorKind::kBadData, "recording: it has no frames to make a film of");
  }
  WriteThroughTemporary(path, [&](const std::string& temporary) {
    // OpenCV's FFmpeg back end encodes H.264 by libx264 at constant quality (crf 23).
    cv::VideoWriter writer(temporary, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'),
                           Recording::kFramesPerSecond, {kPictureWidth, kPictureHeight}, true);
    if (!writer.isOpened()) {
      throw Error(ErrorKind::kCannotCreate,
                  path +
                      ": the film cannot be started: no space, or FFmpeg lacks H.264 (on "
                      "Debian: apt-get install libavcodec59 libopencv-videoio406)");
    }
    DrawAndEncode(recording, stride, parallelism, writer);
    writer.release();
    // The writer reports nothing when the disk is full; a film that lost its end does not open.
    cv::VideoCapture written(temporary, cv::CAP_FFMPEG);
    const int count = (static_cast<int>(recording.frames.size()) + stride - 1) / stride;
    if (!written.isOpened() || static_cast<int>(written.get(cv::CAP_PROP_FRAME_COUNT)) != count) {
      throw Error(ErrorKind::kIo, path + ": writing the film failed");
    }
  });
}

namespace {

/// The scene of one frame, as good as it gets.
Image DrawStill(const Recording& recording, int frame) {
  const int count = static_cast<int>(recording.frames.size());
  if (frame < 0 || frame >= count) {
    throw Error(ErrorKind::kUsage, "recording: there is no frame " + std::to_string(frame) +
                                       ", allowed are 0 to " + std::to_string(count - 1));
  }
  return FrameDrawer(recording, 1, StageQuality::kStill).Draw(frame, 0);
}

}  // namespace

void RenderPicture(const Recording& recording, int frame, const std::string& path) {
  Image image = DrawStill(recording, frame);
  DrawPanels(recording, frame, image);
  WritePng(image, path);
}

void RenderSmallPicture(const Recording& recording, int frame, int width, const std::string& path) {
  Image image = DrawStill(recording, frame);
  const cv::Mat large(image.height, image.width, CV_8UC3, image.bgr.data());
  cv::Mat small;
  cv::resize(large, small, {width, width * image.height / image.width}, 0.0, 0.0, cv::INTER_AREA);
  std::vector<std::uint8_t> bytes;
  constexpr int kQuality = 82;
  if (!cv::imencode(".jpg", small, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality})) {
    throw Error(ErrorKind::kInternal, path + ": the picture cannot be encoded");
  }
  WriteFileAtomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace tubetwin
