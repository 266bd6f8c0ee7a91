// SPDX-License-Identifier: Apache-2.0
#include "engine/cgroup.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace garrison::detail {
namespace {

namespace fs = std::filesystem;

/// Cores of `quota` microseconds per `period`; INT_MAX for "max", -1 and whatever is no limit.
int cores(const std::string& quota, const std::string& period) {
  std::istringstream words(quota + " " + period);
  double time = 0.0;
  double of = 0.0;
  if (!(words >> time >> of) || !(time > 0.0) || !(of > 0.0)) return INT_MAX;
  return static_cast<int>(std::clamp(std::ceil(time / of), 1.0, double{INT_MAX}));
}

std::string word_of(std::istream& file) {
  std::string word;
  file >> word;
  return word;
}

int limit_in(const fs::path& group) {
  std::ifstream second(group / "cpu.max");
  std::ifstream quota(group / "cpu.cfs_quota_us");
  std::ifstream period(group / "cpu.cfs_period_us");
  const std::string most = word_of(second);
  const int by_second = cores(most, word_of(second));
  const std::string time = word_of(quota);
  return std::min(by_second, cores(time, word_of(period)));
}

/// The group and all above it, up to where the hierarchy is mounted.
int limit_up_from(const fs::path& mounted, const std::string& group) {
  int least = limit_in(mounted);
  fs::path at = mounted;
  for (const fs::path& part : fs::path(group).relative_path()) {
    at /= part;
    least = std::min(least, limit_in(at));
  }
  return least;
}

bool names_cpu(const std::string& controllers) {
  std::istringstream list(controllers);
  for (std::string one; std::getline(list, one, ',');)
    if (one == "cpu") return true;
  return false;
}

}  // namespace

int cores_of_cgroups(std::istream& membership, const fs::path& mounted) {
  int least = INT_MAX;
  for (std::string line; std::getline(membership, line);) {  // "number:controllers:/group"
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      least = std::min(least, limit_up_from(mounted, group));
    } else if (names_cpu(controllers)) {
      least = std::min(
          {least, limit_up_from(mounted / controllers, group), limit_up_from(mounted / "cpu", group)});
    }
  }
  return least;
}

}  // namespace garrison::detail
