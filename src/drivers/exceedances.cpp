// SPDX-License-Identifier: Apache-2.0
#include "garrison/drivers/exceedances.hpp"

namespace garrison {

Exceedances exceedances(std::span<const double> statistic, std::span<const double> threshold, int agents) {
  const auto N = static_cast<std::size_t>(agents);
  Exceedances found{std::vector<std::int64_t>(N), std::vector<std::int64_t>(N)};
  std::int64_t* const tests = found.tests.data();
  std::int64_t* const above = found.above.data();
  for (std::size_t first = 0; N > 0 && first + N <= statistic.size(); first += N) {
    for (std::size_t i = 0; i < N; ++i) {
      const double a = statistic[first + i];
      const double b = threshold[first + i];
      above[i] += a > b ? 1 : 0;
      tests[i] += a > b || a <= b ? 1 : 0;
    }
  }
  return found;
}

}  // namespace garrison
