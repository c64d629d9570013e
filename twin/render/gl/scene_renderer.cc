#include "twin/render/gl/scene_renderer.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "scenes/engine/engine_error.h"
#include "twin/render/gl/egl_context.h"

namespace tubetwin {
namespace {

constexpr int kMaxGeoms = 20000;

mjvCamera CameraOf(const View& view) {
  const Vector3 forward = (view.target_B - view.eye_B).normalized();
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  for (int k = 0; k < 3; ++k) camera.lookat[k] = view.target_B[k];
  camera.distance = (view.target_B - view.eye_B).norm();
  camera.azimuth = Degrees(std::atan2(forward.y(), forward.x()));
  camera.elevation = Degrees(std::asin(forward.z()));
  return camera;
}

void AddStroke(mjvScene& scene, const Stroke& stroke) {
  const float rgba[4] = {stroke.colour[0], stroke.colour[1], stroke.colour[2], 1.0f};
  for (std::size_t i = 0; i + 1 < stroke.line_B.size() && scene.ngeom < scene.maxgeom; ++i) {
    mjvGeom& geom = scene.geoms[scene.ngeom++];
    mjv_initGeom(&geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, rgba);
    mjv_connector(&geom, mjGEOM_CAPSULE, stroke.radius_m, stroke.line_B[i].data(),
                  stroke.line_B[i + 1].data());
    geom.category = mjCAT_DECOR;
    geom.emission = 0.35f;
    geom.castshadow = 0;
  }
}

}  // namespace

std::optional<Eigen::Vector2d> Project(const View& view, int width, int height,
                                       const Vector3& p_BP) {
  const Vector3 forward = (view.target_B - view.eye_B).normalized();
  const Vector3 right = forward.cross(Vector3::UnitZ()).normalized();
  const Vector3 down = forward.cross(right);
  const Vector3 p = p_BP - view.eye_B;
  const double depth = p.dot(forward);
  if (depth <= 0) return std::nullopt;
  const double focal_px = 0.5 * height / std::tan(0.5 * Radians(kFieldOfView_deg));
  return Eigen::Vector2d(0.5 * width + focal_px * p.dot(right) / depth,
                         0.5 * height + focal_px * p.dot(down) / depth);
}

struct SceneRenderer::Impl {
  explicit Impl(const mjModel& m) : model(m) {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
  }
  ~Impl() {
    // A context that cannot be made current any more takes its GL objects along by itself.
    try {
      const EglContext::Current current(egl);
      mjr_freeContext(&context);
    } catch (const Error&) {
    }
    mjv_freeScene(&scene);
  }

  const mjModel& model;
  int width = 0, height = 0;
  EglContext egl;
  mjvScene scene;
  mjrContext context;
  std::vector<std::uint8_t> rgb;
};

SceneRenderer::SceneRenderer(const mjModel& model, int width, int height) {
  TT_CHECK(model.vis.global.offwidth >= width && model.vis.global.offheight >= height);
  InitEngine();
  impl_ = std::make_unique<Impl>(model);
  impl_->width = width;
  impl_->height = height;
  impl_->rgb.resize(static_cast<std::size_t>(3) * width * height);
  const EglContext::Current current(impl_->egl);
  mjvScene* const scene = &impl_->scene;
  mjrContext* const context = &impl_->context;
  GuardEngine([&] {
    mjv_makeScene(&model, scene, kMaxGeoms);
    mjr_makeContext(&model, context, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, context);
  });
  if (context->currentBuffer != mjFB_OFFSCREEN) {
    throw Error(ErrorKind::kDevice, "no picture can be drawn: OpenGL has no framebuffer objects");
  }
  // Each costs a pass over the whole picture and adds nothing here: the floor fills the background.
  for (const int flag : {mjRND_REFLECTION, mjRND_SKYBOX, mjRND_FOG, mjRND_HAZE}) {
    scene->flags[flag] = 0;
  }
}

SceneRenderer::~SceneRenderer() = default;

Image SceneRenderer::Draw(mjData& data, const View& view, const std::vector<Stroke>& strokes) {
  Impl& impl = *impl_;
  const EglContext::Current current(impl.egl);
  mjvOption option;
  mjv_defaultOption(&option);
  std::fill(std::begin(option.sitegroup), std::end(option.sitegroup), 0);
  mjvCamera camera = CameraOf(view);
  GuardEngine([&] {
    mjv_updateScene(&impl.model, &data, &option, nullptr, &camera, mjCAT_ALL, &impl.scene);
  });
  for (const Stroke& stroke : strokes) AddStroke(impl.scene, stroke);
  const mjrRect viewport = {0, 0, impl.width, impl.height};
  GuardEngine([&] {
    mjr_render(viewport, &impl.scene, &impl.context);
    mjr_readPixels(impl.rgb.data(), nullptr, viewport, &impl.context);
  });
  // OpenGL's rows come bottom up.
  Image image{impl.width, impl.height, {}};
  image.bgr.resize(impl.rgb.size());
  const std::size_t stride = static_cast<std::size_t>(3) * impl.width;
  for (int row = 0; row < impl.height; ++row) {
    const std::uint8_t* from = &impl.rgb[stride * (impl.height - 1 - row)];
    std::uint8_t* to = &image.bgr[stride * row];
    for (std::size_t i = 0; i < stride; i += 3) {
      to[i] = from[i + 2];
      to[i + 1] = from[i + 1];
      to[i + 2] = from[i];
    }
  }
  return image;
}

}  // namespace tubetwin
