// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/workers.hpp"

#include <algorithm>
#include <string>

namespace garrison {

Workers::Workers(int threads) {
  for (int k = 1; k < threads; ++k) pool_.emplace_back([this, k] { loop(k); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (auto& thread : pool_) thread.join();
}

void Workers::run(int thread) {
  const std::int64_t from = begin(count_, thread);
  const std::int64_t to = begin(count_, thread + 1);
  if (from < to) task_.call(task_.object, from, to, thread);
}

void Workers::loop(int thread) {
  std::uint64_t seen = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      start_.wait(lock, [&] { return stop_ || generation_ != seen; });
      if (stop_) return;
      seen = generation_;
    }
    run(thread);
    {
      const std::lock_guard lock(mutex_);
      --pending_;
    }
    done_.notify_one();
  }
}

void Workers::split(std::int64_t count, Task task) {
  if (pool_.empty()) {
    if (count > 0) task.call(task.object, 0, count, 0);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    count_ = count;
    task_ = task;
    pending_ = static_cast<int>(pool_.size());
    ++generation_;
  }
  start_.notify_all();
  run(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return pending_ == 0; });
}

int thread_count(int requested) {
  if (requested < 0)
    refuse("threads", std::to_string(requested), "a whole number >= 0", "0 uses every core of the machine");
  return requested > 0 ? requested : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace garrison
