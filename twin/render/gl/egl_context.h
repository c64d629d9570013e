#pragma once

#include <memory>

namespace tubetwin {

/// A desktop OpenGL context without window or display server (EGL on a device or Mesa's
/// surfaceless platform; software rendering suffices). Belongs to one thread at a time.
class EglContext {
 public:
  /// Throws Error(kDevice) naming the packages that bring EGL.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current in this thread while it lives.
  class Current {
   public:
    explicit Current(const EglContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;
  };

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
