// SPDX-License-Identifier: Apache-2.0
// Three stability tests: the paper's gamma* (advisory), a certified interval, and the exact radius
// (errors.hpp).
#pragma once

#include <vector>

#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {

/// Lambda_I,i = H_i'(R_i + H_i P_i H_i')^-1 H_i, equal to the printed form where that exists (note 8); steady
/// P_i.
GARRISON_EXPORT Matrix lambda_I(const Setting& setting, const LocalGains& gains, int agent);
/// (22) with p_e = `fraction`. 0: vacuous (some Lambda_I,i is singular); inf: nobody hears anybody. Not a
/// guarantee: Theorem 1 is false as printed for static selections (note 7).
GARRISON_EXPORT double gamma_star(const Setting& setting, const std::vector<LocalGains>& gains,
                                  double fraction);
/// M_f(g) = Lambda_I + g (Lambda_III Lc + Lc' Lambda_III') - g^2 Lc' Lambda_II Lc at phase f: V decreases
/// from f to f+1 in every direction where it is positive semidefinite.
GARRISON_EXPORT Matrix decrease_matrix(const Setting& setting, const std::vector<LocalGains>& gains,
                                       double gamma, std::int64_t phase);
/// Largest gamma in [0, 1e6] with lmin(M_f(gamma)) >= -1e-12 at every phase: up to here the error cannot
/// grow. M_f is concave in gamma, so the admissible ones form an interval.
GARRISON_EXPORT double gamma_lyapunov(const Setting& setting, const std::vector<LocalGains>& gains);

}  // namespace garrison::partial_sharing
