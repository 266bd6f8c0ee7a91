// SPDX-License-Identifier: Apache-2.0
// Random strings of vehicles with admissible settings, and attacks on them.
#pragma once

#include "../../random_system.hpp"
#include "garrison/attacks/measurement.hpp"
#include "garrison/core/network.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/platoon/theorems.hpp"
#include "garrison/filters/platoon/world.hpp"

namespace garrison::test {

struct Platoon {
  platoon::Setting setting;
  ParamMap params;
  Model model;
  Network network;
};

/// N = 3..15, L = 1..4, b = 1..L, T in {.01, .05}, beta anywhere in its admissible interval.
inline Platoon random_platoon(Rng& rng) {
  for (;;) {
    const int L = whole(rng, 1, 4);
    const int N = whole(rng, 2 * L + 1, 15);
    if (N < 3) continue;
    platoon::Setting s;
    s.vehicles = N;
    s.range = L;
    s.attacked = whole(rng, 1, L);
    s.period = uniform(rng, 0, 1) < 0.5 ? 0.01 : 0.05;
    s.eps = std::pow(10.0, uniform(rng, -3, -0.5));
    s.mu = std::pow(10.0, uniform(rng, -3, -0.5));
    s.q = std::pow(10.0, uniform(rng, 1, 2.5));
    s.varpi = uniform(rng, 1.2, 5.0);
    s.adaptive = uniform(rng, 0, 1) < 0.7;
    s.beta = 1.0;
    const auto all = platoon::beta_interval_safe(s);
    if (std::isnan(all.lo)) continue;
    s.beta = all.lo * std::pow(all.hi / all.lo, uniform(rng, 0.02, 0.98));
    const double gs = 0.2 / s.period;
    ParamMap params{{"threshold", s.beta},
                    {"adaptive", s.adaptive},
                    {"process_noise", s.eps},
                    {"measurement_noise", s.mu},
                    {"initial_error", s.q},
                    {"varpi", s.varpi},
                    {"gs", gs},
                    {"gv", 2.0 * gs},
                    {"spacing", 20.0},
                    {"reference", std::vector<double>{200.0, 10.0}},
                    {"attacked", std::int64_t{s.attacked}}};
    return {s, std::move(params), platoon::model(N, s.period), Network::band(N, L)};
  }
}

/// Filters that together take every path of the families of vehicles.
inline std::vector<std::shared_ptr<const AnyFilter>> every_platoon_filter(const ParamMap& params) {
  ParamMap strong = params;
  for (const char* name : {"pairs", "neighbours", "median"}) strong[name] = true;
  strong["count"] = std::string("cover");
  strong["bound"] = std::string("tight");
  ParamMap base;
  for (const char* name :
       {"reference", "gs", "gv", "spacing", "process_noise", "measurement_noise", "attacked"})
    base[name] = params.at(name);
  std::vector<std::shared_ptr<const AnyFilter>> all{make_filter("platoon", params),
                                                    make_filter("platoon", strong)};
  for (const char* kind : {"pwm", "pbe", "ptd"}) {
    base["kind"] = std::string(kind);
    all.push_back(make_filter("platoon_baseline", base));
  }
  return all;
}

/// 0..b different sensors.
inline std::vector<int> random_victims(Rng& rng, const platoon::Setting& s) {
  std::vector<int> victims;
  const int count = whole(rng, 0, s.attacked);
  while (static_cast<int>(victims.size()) < count) {
    const int i = whole(rng, 0, s.vehicles - 1);
    if (std::find(victims.begin(), victims.end(), i) == victims.end()) victims.push_back(i);
  }
  std::sort(victims.begin(), victims.end());
  return victims;
}

/// All shapes, from below the noise to 1e4, and what is not finite.
inline std::vector<Attack> random_attack(Rng& rng, const platoon::Setting& s,
                                         const std::vector<int>& victims) {
  if (victims.empty()) return {};
  const double size = std::pow(10.0, uniform(rng, -2, 4));
  const Schedule when(whole(rng, 0, 12), victims);
  switch (whole(rng, 0, 9)) {
    case 0:
      return {bias(when, size)};
    case 1:
      return {scale(when, uniform(rng, -3, 3))};
    case 2:
      return {random_noise(when, "normal", size, false)};
    case 3:
      return {replayed(when, whole(rng, 1, 10))};
    case 4:
      return {ramp(when, 0.1 * size)};
    case 5:
      return {stealthy(when, uniform(rng, -1.1, 1.1))};
    case 6:
      return {constant(when, uniform(rng, 0, 1) < 0.5 ? kInfinity : 1e300)};
    case 7:
      return {denial(when)};
    case 8:
      return {false_trajectory(when, Vector::Constant(2, 0.1 * s.q), {})};
    default:
      return {sinusoid(when, size, 7.0, 0.0)};
  }
}

/// Every vehicle starts on a random spot near its place, with an estimate within q of it.
struct Start {
  Vector x0;
  Matrix estimate;  // 2 x N
};
inline Start random_start(Rng& rng, const platoon::Setting& s) {
  Start start{Vector(2 * s.vehicles), Matrix(2, s.vehicles)};
  for (int i = 0; i < s.vehicles; ++i) {
    start.x0(2 * i) = 200.0 - 20.0 * i + uniform(rng, -5, 5);
    start.x0(2 * i + 1) = uniform(rng, 5, 15);
    const double angle = uniform(rng, 0, 6.283185307179586);
    const double off = s.q * (1.0 - 1e-9) * (uniform(rng, 0, 1) < 0.3 ? 1.0 : uniform(rng, 0, 1));
    start.estimate(0, i) = start.x0(2 * i) + off * std::cos(angle);
    start.estimate(1, i) = start.x0(2 * i + 1) + off * std::sin(angle);
  }
  return start;
}

}  // namespace garrison::test
