// SPDX-License-Identifier: Apache-2.0
// Random settings over all regimes: a below, at and above 1, few and many rounds, with and without noise.
#pragma once

#include <cmath>
#include <random>

#include "garrison/filters/saturation/setting.hpp"

namespace garrison::saturation {

class RandomSettings {
 public:
  explicit RandomSettings(unsigned seed) : engine_(seed) {}

  /// a g < 1 always holds.
  Setting next() {
    Setting s;
    s.agents = 1 + static_cast<int>(engine_() % 40);
    s.attacked = static_cast<int>(engine_() % static_cast<unsigned>(s.agents + 1)) / (1 + coin(0.7) * 4);
    s.lambda0 = coin(0.05) ? 0.0 : (s.agents - s.attacked) * uniform(0.0, 1.0);
    s.a = coin(0.2) ? 1.0 : uniform(0.6, 1.25);
    s.contraction = coin(0.1) ? 0.0 : std::pow(10.0, uniform(-9.0, -0.1)) / std::max(s.a, 1.0);
    s.beta = std::pow(10.0, uniform(-2.0, 2.0));
    s.eta0 = std::pow(10.0, uniform(-2.0, 2.0));
    s.b_w = coin(0.2) ? 0.0 : std::pow(10.0, uniform(-4.0, 0.0));
    s.b_v = coin(0.2) ? 0.0 : std::pow(10.0, uniform(-4.0, 0.0));
    s.sharp = coin(0.3);
    return s;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool coin(double chance) { return uniform(0.0, 1.0) < chance; }

 private:
  std::mt19937 engine_;
};

}  // namespace garrison::saturation
