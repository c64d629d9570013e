#include "hw_bridge/emulators/background_task.h"

#include <utility>

#include "models/base/error.h"
#include "models/base/parallel.h"

namespace tubetwin {

ErrandThread::ErrandThread() : thread_([this](const std::stop_token& stop) { Serve(stop); }) {}

ErrandThread::~ErrandThread() = default;  // The thread ends after its errand.

void ErrandThread::Start(std::function<void()> errand) {
  {
    const std::lock_guard lock(mutex_);
    TT_CHECK(!errand_);
    errand_ = std::move(errand);
  }
  started_.notify_one();
}

bool ErrandThread::idle() const {
  const std::lock_guard lock(mutex_);
  return !errand_;
}

void ErrandThread::Serve(const std::stop_token& stop) {
  GiveWay();
  std::unique_lock lock(mutex_);
  while (started_.wait(lock, stop, [this] { return static_cast<bool>(errand_); })) {
    const std::function<void()> errand = errand_;
    lock.unlock();
    errand();
    lock.lock();
    errand_ = nullptr;
  }
}

}  // namespace tubetwin
