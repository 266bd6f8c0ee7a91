// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/workers.hpp"

#include <chrono>
#include <csignal>
#include <exception>

namespace garrison {
namespace {

/// Threads inherit the mask of the one that starts them: the application's signals are then handled by its
/// own threads, never in the middle of a step. What a thread's own fault raises stays with that thread.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT})
      sigdelset(&all, fault);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

/// What std::condition_variable::wait does. That one, compiled by gcc 12, asks for a libstdc++ of 2022
/// (GLIBCXX_3.4.30), and a wheel would not run on systems of 2021.
template <class Condition>
void wait(std::condition_variable& told, std::unique_lock<std::mutex>& lock, const Condition& condition) {
  while (!condition()) told.wait_until(lock, std::chrono::system_clock::now() + std::chrono::hours(1));
}

}  // namespace

Workers::Workers(int threads) {
  const SignalsBlocked blocked;
  try {
    for (int k = 1; k < threads; ++k) pool_.emplace_back([this, k] { loop(k); });
  } catch (const std::exception&) {
    // No more threads or memory to be had: those that run do all the work, with the same result.
  }
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
      wait(start_, lock, [&] { return stop_ || generation_ != seen; });
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
  wait(done_, lock, [&] { return pending_ == 0; });
}

}  // namespace garrison
