#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <mujoco/mujoco.h>

#include "models/base/polyline.h"

namespace tubetwin {

/// Pixels row by row from the top left, blue green red (OpenCV's order).
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bgr;
};

using Colour = std::array<float, 3>;  ///< Red, green, blue, 0..1.

/// A line drawn into the scene as thin capsules that shine by themselves. Frame B.
struct Stroke {
  Polyline line_B;
  double radius_m = 0.003;
  Colour colour = {1, 1, 1};
};

/// Camera at `eye_B` looking at `target_B`, z of B upwards in the picture.
struct View {
  Vector3 eye_B = Vector3::Zero();
  Vector3 target_B = Vector3::Zero();
};

/// Vertical field of view of every picture.
inline constexpr double kFieldOfView_deg = 36.0;

/// Pixel (x right, y down, from the top left corner) of a point; nothing when behind the camera.
std::optional<Eigen::Vector2d> Project(const View& view, int width, int height,
                                       const Vector3& p_BP);

/// Draws a MuJoCo scene off screen. One thread at a time; the model must outlive it.
class SceneRenderer {
 public:
  /// Throws Error(kDevice) when there is no EGL, Error(kInternal) when OpenGL lacks something.
  /// The model's vis.global must allow width x height off screen (stage.h makes such models).
  SceneRenderer(const mjModel& model, int width, int height);
  ~SceneRenderer();

  /// Draws what `data` says (its positions as last computed). Throws Error(kInternal).
  Image Draw(mjData& data, const View& view, const std::vector<Stroke>& strokes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
