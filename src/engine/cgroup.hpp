// SPDX-License-Identifier: Apache-2.0
// How much processor time Linux gives a process (containers, systemd's CPUQuota).
#pragma once

#include <filesystem>
#include <istream>

#include "garrison/core/error.hpp"

namespace garrison::detail {

/// Cores' worth of time that the tightest of the process' control groups allows, rounded up, at least 1;
/// INT_MAX where there is no limit or nothing can be read. `membership`: the text of /proc/self/cgroup;
/// `mounted`: /sys/fs/cgroup. Reads version 2 (cpu.max) and version 1 (cpu.cfs_quota_us).
int cores_of_cgroups(std::istream& membership, const std::filesystem::path& mounted);

}  // namespace garrison::detail
