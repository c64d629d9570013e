#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/parallel.h"
#include "models/base/polyline.h"
#include "models/bin.h"
#include "models/mesh/mesh.h"

namespace tubetwin {

/// What a round looked like, 30 times per simulated second: enough for pictures and films, not for
/// physics. Frame k is due at exactly k/30 s.
struct Recording {
  static constexpr int kFramesPerSecond = 30;
  /// Perceived tubes (frame N) and the chosen one, drawn over the picture until the next overlay.
  struct Overlay {
    std::vector<Polyline> lines_N;
    std::vector<int> classes;  ///< Of each line: 0 free, 1 weak, 2 strong (TubeClass's order).
    int target = -1;           ///< Index in lines_N.
    /// What the scanner saw, thinned for the eye; rounded to 0.1 mm in the file.
    std::vector<Vector3> cloud_N;
  };
  struct Frame {
    std::vector<float> qpos;  ///< [nq] of the cell's model.
    float force_N = 0;        ///< Tared load along gravity.
    int overlay = -1;         ///< Index in overlays, -1 none.
    int caption = -1;         ///< Index in captions.
  };
  /// A user's mesh that pictures show instead of plain shapes.
  struct Visual {
    std::string body;  ///< Of the cell's model, with which it moves; "world": it stands.
    /// How the names of the body's geoms begin that it takes the place of.
    std::vector<std::string> replaces;
    Mesh mesh;  ///< In the body's frame.
  };
  std::string source = "recording";  ///< In messages: the file that it was read from.
  std::string cell_xml;              ///< The compiled cell, as in the result folder.
  Bin bin;
  std::vector<Visual> visuals;
  std::vector<Overlay> overlays;
  std::vector<std::string> captions;
  std::vector<Frame> frames;
  std::vector<int> attempt_ends;  ///< How many frames there were when each attempt ended.
};

/// One zstd-compressed file: a JSON head, then the frames as raw floats.
void WriteRecording(const Recording& recording, const std::string& path);
/// Throws Error(kMissing | kBadData).
Recording ReadRecording(const std::string& path);

/// Film 1280 x 720, 30 fps of simulated time (H.264 mp4), with perceived centerlines in class
/// colours, caption and force trace. Every `stride`-th frame is drawn, played at stride x speed
/// when > 1. Throws Error(kDevice) when there is no EGL, naming the package that brings it.
void RenderFilm(const Recording& recording, const std::string& path, int stride,
                Parallelism parallelism);

/// One picture of one frame of a recording (PNG).
void RenderPicture(const Recording& recording, int frame, const std::string& path);

/// The same without panels, `width` pixels wide, as JPEG: small enough to stand in a page.
void RenderSmallPicture(const Recording& recording, int frame, int width, const std::string& path);

}  // namespace tubetwin
