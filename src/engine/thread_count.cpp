// SPDX-License-Identifier: Apache-2.0
#include <sched.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#include "engine/cgroup.hpp"
#include "garrison/engine/workers.hpp"

namespace garrison {
namespace {

/// Cores that this process may run on: std::thread counts those of the whole machine.
int allowed_cores() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
  return static_cast<int>(std::thread::hardware_concurrency());  // more cores than cpu_set_t holds
}

}  // namespace

int thread_count(int requested) {
  if (requested < 0)
    refuse("threads", std::to_string(requested), "a whole number >= 0", "0 uses every core it may");
  if (requested > 0) return requested;
  std::ifstream membership("/proc/self/cgroup");
  return std::clamp(allowed_cores(), 1, detail::cores_of_cgroups(membership, "/sys/fs/cgroup"));
}

}  // namespace garrison
