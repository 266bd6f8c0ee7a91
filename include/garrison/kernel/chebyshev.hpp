// SPDX-License-Identifier: Apache-2.0
// Chebyshev-filtered consensus: more contraction from the same messages.
#pragma once

#include <cmath>
#include <vector>

namespace garrison {

// L rounds apply p_L(W) = T_L(W / gamma) / T_L(1 / gamma), W = I - alpha Lap, whose eigenvalues on
// disagreements lie in [-gamma, gamma]. p_L(1) = 1 keeps the mean; on disagreements ||p_L|| <= 1 / T_L(1 /
// gamma). With r_l = T_{l-1}(1/gamma) / T_l(1/gamma): r_1 = gamma, r_{l+1} = 1 / (2/gamma - r_l), omega_{l+1}
// = 2 r_{l+1} / gamma,
//   x_{l+1} = omega_{l+1} W x_l - (omega_{l+1} - 1) x_{l-1},  omega_1 = 1.

/// Weight per round for 0 <= gamma < 1; all 1 (plain rounds) when gamma = 0.
inline std::vector<double> chebyshev_weights(double gamma, int rounds) {
  std::vector<double> omega(static_cast<std::size_t>(rounds), 1.0);
  double r = gamma;
  for (std::size_t l = 1; l < omega.size() && gamma > 0.0; ++l) {
    r = 1.0 / (2.0 / gamma - r);
    omega[l] = 2.0 * r / gamma;
  }
  return omega;
}

/// 1 / T_L(1/gamma): what `rounds` filtered rounds leave of a disagreement; 1 for no round.
inline double chebyshev_contraction(double gamma, int rounds) {
  constexpr int kMany = 10'000;
  double product = 1.0;
  double r = gamma;
  for (int l = 0; l < rounds && product > 0.0; ++l) {
    product *= r;
    const double next = gamma > 0.0 ? 1.0 / (2.0 / gamma - r) : r;
    if (next == r && rounds - l > kMany) return product * std::pow(r, rounds - l - 1);  // it stays so
    r = next;
  }
  return product;
}

}  // namespace garrison
