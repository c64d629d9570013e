#include "hw_bridge/emulators/background_task.h"

#include <utility>

#include "models/base/error.h"
#include "models/base/parallel.h"

namespace tubetwin {

BackgroundTask::BackgroundTask() : thread_([this](const std::stop_token& stop) { Serve(stop); }) {}

BackgroundTask::~BackgroundTask() = default;  // The thread ends after its task.

void BackgroundTask::Start(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    TT_CHECK(!task_);
    task_ = std::move(task);
  }
  started_.notify_one();
}

bool BackgroundTask::idle() const {
  const std::lock_guard lock(mutex_);
  return !task_;
}

void BackgroundTask::Serve(const std::stop_token& stop) {
  GiveWay();
  std::unique_lock lock(mutex_);
  while (started_.wait(lock, stop, [this] { return static_cast<bool>(task_); })) {
    const std::function<void()> task = task_;
    lock.unlock();
    task();
    lock.lock();
    task_ = nullptr;
  }
}

}  // namespace tubetwin
