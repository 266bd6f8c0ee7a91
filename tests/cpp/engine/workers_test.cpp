// SPDX-License-Identifier: Apache-2.0
// Threads that cannot be had are done without; no more are asked for than the process may use.
#include "garrison/engine/workers.hpp"

#include <doctest/doctest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/cgroup.hpp"

using namespace garrison;

namespace {

/// What `action` returns in a process of its own, 0..255; -1 when that hung or died.
template <class Action>
int in_child(const Action& action) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(30);
    _exit(action());
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Splits 1000 numbers among as many of `wanted` threads as there are: how many, or 0 when the sum is wrong.
int threads_that_work(int wanted) {
  Workers workers(wanted);
  std::atomic<std::int64_t> sum{0};
  for (int again = 0; again < 3; ++again)
    workers.split(1000, [&](std::int64_t begin, std::int64_t end, int) { sum += end - begin; });
  return sum == 3000 ? workers.threads() : 0;
}

std::uint64_t address_space() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

TEST_CASE("a process that may have 8 threads runs with fewer than it asked for") {
  const int had = in_child([] {
    const rlimit most{8, 8};
    if (setrlimit(RLIMIT_NPROC, &most) != 0 || (geteuid() == 0 && setuid(65534) != 0)) return 0;
    return threads_that_work(16);
  });
  CAPTURE(had);
  CHECK(had >= 1);
  CHECK(had <= 8);
}

TEST_CASE("an address space with room for a few stacks only") {
  const int had = in_child([] {
    rlimit stack{};
    getrlimit(RLIMIT_STACK, &stack);
    const std::uint64_t one = stack.rlim_cur == RLIM_INFINITY ? 2U << 20U : stack.rlim_cur;
    const std::uint64_t room = address_space() + 4 * one;
    const rlimit most{room, room};
    if (setrlimit(RLIMIT_AS, &most) != 0) return 0;
    return threads_that_work(64);
  });
  CAPTURE(had);
  CHECK(had >= 1);
  CHECK(had < 64);
}

TEST_CASE("signals are the application's: workers block them, the caller does not") {
  Workers workers(3);
  std::atomic<int> blocked{0};
  workers.split(3, [&](std::int64_t, std::int64_t, int thread) {
    sigset_t mask;
    pthread_sigmask(SIG_BLOCK, nullptr, &mask);
    bool all = true;
    for (const int one : {SIGINT, SIGTERM, SIGHUP, SIGALRM, SIGUSR1})
      all = all && sigismember(&mask, one) == 1;
    if (all && thread > 0) ++blocked;
    if (all && thread == 0) blocked = -100;
  });
  CHECK(blocked == workers.threads() - 1);
}

TEST_CASE("0 threads means the cores that the process may run on") {
  CHECK(thread_count(5) == 5);
  CHECK_THROWS_AS(thread_count(-1), InvalidInput);
  CHECK(in_child([] {
          cpu_set_t first;
          CPU_ZERO(&first);
          cpu_set_t allowed;
          sched_getaffinity(0, sizeof allowed, &allowed);
          for (int k = 0; k < CPU_SETSIZE && CPU_COUNT(&first) == 0; ++k)
            if (CPU_ISSET(k, &allowed)) CPU_SET(k, &first);
          sched_setaffinity(0, sizeof first, &first);
          return thread_count(0);
        }) == 1);
}

TEST_CASE("control groups limit the cores, the tightest of them first") {
  namespace fs = std::filesystem;
  const fs::path mounted = fs::temp_directory_path() / ("garrison_cgroup_" + std::to_string(getpid()));
  const auto write = [&](const fs::path& file, const char* content) {
    fs::create_directories((mounted / file).parent_path());
    std::ofstream(mounted / file) << content;
  };
  const auto limit = [&](const char* membership) {
    std::istringstream text(membership);
    return detail::cores_of_cgroups(text, mounted);
  };
  CHECK(limit("0::/\n") == INT_MAX);
  write("user/cpu.max", "250000 100000\n");
  write("user/job/cpu.max", "max 100000\n");
  CHECK(limit("0::/user/job\n") == 3);  // 2.5, from the group above
  write("user/job/cpu.max", "50000 100000\n");
  CHECK(limit("0::/user/job\n") == 1);
  CHECK(limit("0::/other\n") == INT_MAX);
  write("cpu,cpuacct/docker/cpu.cfs_quota_us", "400000\n");
  write("cpu,cpuacct/docker/cpu.cfs_period_us", "100000\n");
  CHECK(limit("4:memory:/docker\n3:cpu,cpuacct:/docker\n") == 4);
  write("cpu,cpuacct/docker/cpu.cfs_quota_us", "-1\n");
  CHECK(limit("3:cpu,cpuacct:/docker\n") == INT_MAX);
  CHECK(limit("no such line\n::\n0:\n") == INT_MAX);
  write("cpu.max", "nonsense");
  CHECK(limit("0::/user\n") == 3);
  fs::remove_all(mounted);
}
