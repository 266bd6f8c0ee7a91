// SPDX-License-Identifier: Apache-2.0
// What the paper calls the error covariance: local recursions (8), (23)-(26) with an attack term.
#pragma once

#include <vector>

#include "garrison/filters/partial_sharing/errors.hpp"

namespace garrison::partial_sharing {

/// P_i = F_i P_i F_i' + K_i R_i K_i' + Q + C_i [(E (x) I)(W o Sigma)(E (x) I)']_ii C_i', per agent. These
/// drop the correlation of neighbours and are not the true covariance (note 14). W chooses the reading:
/// - p_e 11': (26) as printed, an upper bound only for the worst Sigma (note 5)
/// - Selection::moments_uniform(): (25) exact over random starts;  Selection::moments_cycle(): (25) exact on
/// one cycle. `Sigma` empty: no attack. W: N m x N m, or 1 x 1 for a constant.
GARRISON_EXPORT std::vector<Matrix> local_covariances(const Setting& setting,
                                                      const std::vector<LocalGains>& gains, const Matrix& W,
                                                      const Matrix& Sigma);
/// (1/N) sum of traces (38).
GARRISON_EXPORT double mse(const std::vector<Matrix>& covariances);
/// MSE' after each of `steps` updates (8) with S(k), k = k0, k0+1, .., from the steady P_i on; gains not
/// recomputed.
GARRISON_EXPORT std::vector<double> recursion8(const Setting& setting, const std::vector<LocalGains>& gains,
                                               const Matrix& Sigma, std::int64_t k0, int steps);

}  // namespace garrison::partial_sharing
