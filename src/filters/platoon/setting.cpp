// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/setting.hpp"

#include <string>

#include "garrison/filters/platoon/partition.hpp"

namespace garrison::platoon {
namespace {

void require_number(const char* which, double value, bool positive) {
  if (!std::isfinite(value) || (positive ? !(value > 0.0) : !(value >= 0.0)))
    refuse(which, text(value), positive ? "a finite number > 0" : "a finite number >= 0");
}

}  // namespace

void require(const Setting& s) {
  if (s.vehicles < 3) refuse("vehicles (N)", std::to_string(s.vehicles), "at least 3");
  if (s.range < 1 || s.range > kMostRange)
    refuse("range (L)", std::to_string(s.range), "1.." + std::to_string(kMostRange));
  if (s.vehicles < 2 * s.range + 1)
    refuse("vehicles (N)", std::to_string(s.vehicles),
           "at least 2 L + 1 = " + std::to_string(2 * s.range + 1) + ", else V_1 is empty",
           "shorten the range L or add vehicles");
  if (s.attacked < 1)
    refuse("attacked (b)", std::to_string(s.attacked), "at least 1", "Assumption 1 has b >= 1");
  if (s.attacked > s.range)
    refuse("attacked (b)", "b = " + std::to_string(s.attacked),
           "at most the range L = " + std::to_string(s.range),
           "no admissible threshold exists for b > L: widen the range");
  require_number("period (T)", s.period, true);
  require_number("process_noise (eps)", s.eps, false);
  require_number("measurement_noise (mu)", s.mu, false);
  require_number("initial_error (q)", s.q, true);
  require_number("threshold (beta)", s.beta, true);
  const double most = norm_A(s) / (norm_A(s) - 1.0);
  if (!(s.varpi > 1.0) || !(s.varpi < most))
    refuse("varpi", text(s.varpi), "a number in (1, ||A||/(||A|| - 1)) = (1, " + text(most) + ")");
}

std::vector<int> nearest(int id, int vehicles) {
  if (vehicles < 1 || id < -1 || id >= vehicles)
    refuse("vehicle", std::to_string(id), "-1 (the reference) .. " + std::to_string(vehicles - 1));
  std::vector<int> all;
  if (id >= 0) all.push_back(id - 1);
  if (id + 1 < vehicles) all.push_back(id + 1);
  return all;
}

int range_of(const Network& network) {
  const int N = network.agents();
  if (N < 3) refuse("network", amount(N, "vehicle") + " (N)", "at least 3");
  const int L = network.degree(0);
  if (network.directed()) refuse("network", "a directed one", "an undirected one", "use Network.band");
  for (int i = 0; i < N; ++i) {
    const auto heard = network.neighbours(i);
    const int first = std::max(0, i - L);
    const int last = std::min(N - 1, i + L);
    if (L < 1 || static_cast<int>(heard.size()) != last - first ||
        heard.front() != (i == first ? i + 1 : first) || heard.back() != (i == last ? i - 1 : last))
      refuse("network",
             "vehicle " + std::to_string(i) + " hearing " + std::to_string(heard.size()) + " others",
             "everybody hears exactly those at most L = " + std::to_string(L) + " places away",
             "use Network.band(vehicles, range)");
  }
  if (N < 2 * L + 1)
    refuse("network", amount(N, "vehicle") + " (N) with range L = " + std::to_string(L),
           "at least 2 L + 1 = " + amount(2 * L + 1, "vehicle") + ", else V_1 is empty",
           "shorten the range L or add vehicles");
  return L;
}

}  // namespace garrison::platoon
