#include "models/base/parallel.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tubetwin {

void GiveWay() {
  // Linux keeps the value per thread; where that fails nothing is lost but a little time.
  const int now = ::getpriority(PRIO_PROCESS, 0);
  ::setpriority(PRIO_PROCESS, 0, std::min(now + 5, 19));
}

void KeepTime() {
  sched_param lowest{};
  lowest.sched_priority = ::sched_get_priority_min(SCHED_RR);
  ::sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &lowest);
}

Parallelism Parallelism::All() {
  return {std::max(1, static_cast<int>(std::thread::hardware_concurrency()))};
}

void ParallelFor(int count, Parallelism parallelism,
                 const std::function<void(int index, int worker)>& body) {
  const int threads = std::clamp(parallelism.threads, 1, std::max(1, count));
  if (threads == 1) {
    for (int i = 0; i < count; ++i) body(i, 0);
    return;
  }
  std::atomic<int> next{0};
  std::mutex mutex;
  int failed_index = count;
  std::exception_ptr failure;
  auto work = [&](int worker) {
    for (int i = next++; i < count; i = next++) {
      try {
        body(i, worker);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i < failed_index) {
          failed_index = i;
          failure = std::current_exception();
        }
      }
    }
  };
  std::vector<std::jthread> pool;
  for (int w = 1; w < threads; ++w) pool.emplace_back(work, w);
  work(0);
  pool.clear();  // Joins.
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tubetwin
