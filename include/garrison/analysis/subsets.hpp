// SPDX-License-Identifier: Apache-2.0
// Worst choice of s sensors to lose: lambda_0 (6), varpi (theorem 3) and tau_0 (theorem 5) of the saturation
// paper.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// Budget of an exact search, within current_budget(). When it runs out, the result is a certified interval.
/// Of a search over directions: as many looks at all rows, of which a look at fewer rows is a part.
struct SubsetLimits {
  std::int64_t max_nodes = 20'000'000;
  double max_seconds = kInfinity;
};

/// Result of a search over the s removed rows. The true value lies in [lower, upper]; theorems need the safe
/// end: `lower` of lambda_0, `upper` of varpi and tau_0. Never the other one, which is only what was found so
/// far.
struct GARRISON_EXPORT SubsetBound {
  double lower = 0.0;
  double upper = 0.0;
  bool exact = false;        ///< the search finished: both ends agree to rounding
  std::vector<int> removed;  ///< the worst set found, sorted; size s
  std::int64_t nodes = 0;    ///< sets, partial sets or cones of directions looked at
  std::string method;
};

/// (6): least lambda_min(sum of C_i'C_i) over all sets of N - s rows. C: N x n, finite, rows of any length,
/// zero rows (relays) allowed; 0 <= s <= N. s = N gives 0. Up to three states (three: more than 20 rows): N
/// log N about, whatever s is; else over sets, which takes exponentially long in s where rows are alike.
/// @throws InvalidInput
GARRISON_EXPORT SubsetBound lambda0(const MatrixRef& C, int s, const SubsetLimits& limits = {});

/// Closed form of (6) when every two rows are parallel or orthogonal unit vectors (|C_i C_j'| within 1e-12 of
/// 0 or 1): 0 with fewer groups of parallel rows than n, else max(0, smallest group - s). Empty otherwise.
GARRISON_EXPORT std::optional<double> lambda0_orthogonal(const MatrixRef& C, int s);

/// The node limit that check and design take: about a second of work, and the same result on every machine.
GARRISON_EXPORT SubsetLimits usual_limits(Eigen::Index rows, Eigen::Index states);

/// Theorem 3: largest ||(I - (1/N) sum of C_i'C_i) A|| over sets of N - s rows. A: n x n. @throws
/// InvalidInput
GARRISON_EXPORT SubsetBound varpi(const MatrixRef& C, const MatrixRef& A, int s,
                                  const SubsetLimits& limits = {});

/// The same by looking at every set, nothing where there are too many: then a (1 - lambda_0/N) is an upper
/// bound for rows of at most unit length. @throws InvalidInput
GARRISON_EXPORT std::optional<SubsetBound> varpi_enumerated(const MatrixRef& C, const MatrixRef& A, int s,
                                                            const SubsetLimits& limits = {});

/// Theorem 5: largest (1/N) ||[C_i'C_i A]|| (blocks side by side) over sets of N - s rows. @throws
/// InvalidInput
GARRISON_EXPORT SubsetBound tau0(const MatrixRef& C, const MatrixRef& A, int s,
                                 const SubsetLimits& limits = {});

}  // namespace garrison
