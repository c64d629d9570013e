#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace tubetwin {

/// A thread for what may block, above all disks: one task at a time, beside a thread that keeps
/// time and asks once per period whether it is done. Gives way to other threads (GiveWay).
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
