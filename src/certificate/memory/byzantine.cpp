// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/byzantine.hpp"

#include <algorithm>
#include <span>

#include "../require.hpp"

namespace garrison::certificate {
namespace {

/// Most disjoint paths among `rest`, none of which goes through `used`.
int most_disjoint(std::span<const Path> rest, std::vector<int>& used, int enough) {
  int most = 0;
  for (std::size_t k = 0; k < rest.size() && most < enough; ++k) {
    if (static_cast<int>(rest.size() - k) <= most) break;
    const auto relays = std::span(rest[k]).subspan(1);
    if (std::any_of(relays.begin(), relays.end(),
                    [&](int agent) { return std::find(used.begin(), used.end(), agent) != used.end(); }))
      continue;
    const std::size_t before = used.size();
    used.insert(used.end(), relays.begin(), relays.end());
    most = std::max(most, 1 + most_disjoint(rest.subspan(k + 1), used, enough - 1));
    used.resize(before);
  }
  return most;
}

}  // namespace

int disjoint_paths(const std::vector<Path>& paths, int enough) {
  for (const Path& path : paths) {
    if (path.empty()) refuse("paths", "a path without agents", "the owner first, then the relays");
    if (path.front() != paths.front().front())
      refuse("paths",
             "owners " + std::to_string(paths.front().front()) + " and " + std::to_string(path.front()),
             "paths of one owner");
  }
  std::vector<int> used;
  return most_disjoint(paths, used, enough);
}

bool accepted(const std::vector<Path>& paths, int liars) {
  detail::require_least("liars", liars, 0);
  const int disjoint = disjoint_paths(paths, liars + 1);
  return disjoint > liars ||
         std::any_of(paths.begin(), paths.end(), [](const Path& p) { return p.size() == 1; });
}

}  // namespace garrison::certificate
