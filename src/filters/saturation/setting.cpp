// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/setting.hpp"

#include <string>

namespace garrison::saturation {
namespace {

void require_range(const char* which, double value, double least, double most, const char* expected,
                   const char* advice) {
  if (!std::isfinite(value) || value < least || value > most) refuse(which, text(value), expected, advice);
}

void require_positive(const char* which, double value, const char* advice) {
  if (!std::isfinite(value) || value <= 0.0) refuse(which, text(value), "a finite number > 0", advice);
}

}  // namespace

void require_sensors(const Setting& s) {
  if (s.agents < 1) refuse("agents (N)", std::to_string(s.agents), "a whole number >= 1");
  if (s.attacked < 0 || s.attacked > s.agents)
    refuse("attacked (s)", std::to_string(s.attacked), "0.." + std::to_string(s.agents),
           "it counts sensors of the network");
  // Eigenvalue solvers return N - s only up to rounding.
  const double most = s.agents - s.attacked + 1e-9 * s.agents;
  require_range("lambda0 (6)", s.lambda0, 0.0, most, "a number in 0..N-s", "give every row of C unit length");
}

void require_network(const Setting& s) {
  require_sensors(s);
  require_range("a (||A||)", s.a, 0.0, kInfinity, "a finite number >= 0", "use the spectral norm of A");
  require_range("contraction (g)", s.contraction, 0.0, 1.0, "a number in 0..1",
                "it is gamma^L, or the factor of the Chebyshev rounds");
}

void require_start_and_noise(const Setting& s) {
  require_positive("initial_error (eta0)", s.eta0,
                   "bound the distance of the common initial estimate from the state");
  require_range("process_bound (b_w)", s.b_w, 0.0, kInfinity, "a finite number >= 0",
                "bound the process noise");
  require_range("measurement_bound (b_v)", s.b_v, 0.0, kInfinity, "a finite number >= 0",
                "bound the measurement noise");
}

void require_threshold(const Setting& s) {
  require_positive("threshold (beta)", s.beta, "the bounds need a finite saturation level");
}

void require(const Setting& s) {
  require_network(s);
  require_start_and_noise(s);
  require_threshold(s);
}

void require_contraction(const Setting& s) {
  if (contracts(s)) return;
  throw InvalidInput("L is too small: ||A|| gamma^L = " + text(s.a * s.contraction) +
                     " >= 1; use more rounds, Chebyshev rounds or a better connected graph");
}

}  // namespace garrison::saturation
