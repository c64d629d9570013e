#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace tubetwin {

/// A thread for work that may block, such as writing files. It runs one task at a time, so that the
/// thread that keeps time only has to ask once per period whether it is done. Runs at the lowest
/// priority (GiveWay).
class BackgroundTask {
 public:
  BackgroundTask();
  /// Waits for the task under way.
  ~BackgroundTask();

  /// The task must not throw. Precondition: idle().
  void Start(std::function<void()> task);
  /// No task is under way; what the last one wrote can be read.
  bool idle() const;

 private:
  void Serve(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::condition_variable_any started_;
  std::function<void()> task_;  ///< Empty: idle.

  std::jthread thread_;  ///< Last: ends before what it uses.
};

}  // namespace tubetwin
