// SPDX-License-Identifier: Apache-2.0
// A small pool of threads that split a range.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "garrison/core/error.hpp"

namespace garrison {

/// Keeps `threads - 1` threads waiting, or as many as can be started; `split` cuts [0, count) into one
/// contiguous part per thread and returns when all are done. With one thread everything runs in the caller.
/// The threads take no signals of the application.
/// Threads: one caller at a time; `part` runs in all of its own.
class GARRISON_EXPORT Workers {
 public:
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return static_cast<int>(pool_.size()) + 1; }
  /// Where the part of `thread` begins in [0, count).
  std::int64_t begin(std::int64_t count, int thread) const { return count * thread / threads(); }
  /// `part(begin, end, thread)` is called once per non-empty part; it must not throw.
  template <class Part>
  void split(std::int64_t count, const Part& part) {
    split(count, Task{&part, [](const void* p, std::int64_t begin, std::int64_t end, int thread) {
                        (*static_cast<const Part*>(p))(begin, end, thread);
                      }});
  }

 private:
  struct Task {  // a std::function would allocate in every step
    const void* object = nullptr;
    void (*call)(const void*, std::int64_t, std::int64_t, int) = nullptr;
  };
  void split(std::int64_t count, Task task);
  void loop(int thread);
  void run(int thread);

  std::vector<std::thread> pool_;
  std::mutex mutex_;
  std::condition_variable start_;
  std::condition_variable done_;
  std::uint64_t generation_ = 0;
  int pending_ = 0;
  bool stop_ = false;
  std::int64_t count_ = 0;
  Task task_;
};

/// `requested` threads, or when 0 as many as this process may use: the cores of its affinity, and no more
/// than its control groups give it time for. @throws InvalidInput when negative.
GARRISON_EXPORT int thread_count(int requested);

}  // namespace garrison
