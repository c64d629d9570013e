#include "twin/render/gl/egl_context.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "models/base/error.h"

namespace tubetwin {
namespace {

[[noreturn]] void FailEgl(const std::string& step) {
  char code[16];
  std::snprintf(code, sizeof code, "0x%04x", static_cast<unsigned>(eglGetError()));
  throw Error(ErrorKind::kDevice,
              "no picture can be drawn: EGL: " + step + " failed (" + code +
                  ")\npictures need EGL with OpenGL, software rendering suffices; on Debian:\n"
                  "apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri");
}

bool HasExtension(const char* list, const char* name) {
  return list != nullptr && std::strstr(list, name) != nullptr;
}

/// First display that initialises: EGL's own devices in their order, then Mesa's surfaceless
/// platform.
EGLDisplay FindDisplay() {
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (get_display == nullptr || extensions == nullptr) FailEgl("finding a driver");
  auto initialised = [](EGLDisplay display) {
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
  };
  constexpr EGLint kMaxDevices = 16;
  EGLDeviceEXT devices[kMaxDevices];
  EGLint count = 0;
  if (query_devices != nullptr && HasExtension(extensions, "EGL_EXT_platform_device") &&
      query_devices(kMaxDevices, devices, &count) == EGL_TRUE) {
    for (EGLint i = 0; i < count; ++i) {
      const EGLDisplay display = get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
      if (initialised(display)) return display;
    }
  }
  if (HasExtension(extensions, "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display =
        get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (initialised(display)) return display;
  }
  FailEgl("opening a display");
}

/// One display for the process: terminating it would take the contexts of other threads along.
EGLDisplay SharedDisplay() {
  static const EGLDisplay display = [] {
    // Mesa's software renderer would start a thread per core for every context; the callers are
    // the threads here. What the user has set stays.
    setenv("LP_NUM_THREADS", "0", /*overwrite=*/0);
    return FindDisplay();
  }();
  return display;
}

}  // namespace

struct EglContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

EglContext::EglContext() : impl_(std::make_unique<Impl>()) {
  impl_->display = SharedDisplay();
  const EGLint attributes[] = {EGL_SURFACE_TYPE,
                               EGL_PBUFFER_BIT,
                               EGL_RENDERABLE_TYPE,
                               EGL_OPENGL_BIT,
                               EGL_RED_SIZE,
                               8,
                               EGL_GREEN_SIZE,
                               8,
                               EGL_BLUE_SIZE,
                               8,
                               EGL_DEPTH_SIZE,
                               24,
                               EGL_STENCIL_SIZE,
                               8,
                               EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(impl_->display, attributes, &config, 1, &count) != EGL_TRUE || count < 1) {
    FailEgl("choosing a configuration");
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) FailEgl("choosing OpenGL");
  impl_->context = eglCreateContext(impl_->display, config, EGL_NO_CONTEXT, nullptr);
  if (impl_->context == EGL_NO_CONTEXT) FailEgl("making a context");
}

EglContext::~EglContext() { eglDestroyContext(impl_->display, impl_->context); }

EglContext::Current::Current(const EglContext& context) {
  // Without a surface: pictures are drawn into framebuffer objects.
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE ||
      eglMakeCurrent(context.impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                     context.impl_->context) != EGL_TRUE) {
    FailEgl("making a context current");
  }
}

EglContext::Current::~Current() {
  eglMakeCurrent(SharedDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace tubetwin
