// SPDX-License-Identifier: Apache-2.0
// A pair (A, C) in units of its own: what it shows must not depend on the units of states and outputs.
#pragma once

#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::detail {

/// D^-1 A D and S C D, D and S diagonal, powers of 2.
struct Pair {
  Matrix A;  ///< n x n
  Matrix C;  ///< m x n
};

/// The scaling that minimises the sum of squares of off-diagonal A and C minus beta * sum of log d^2 and the
/// like for s: a convex problem with one solution, whatever units the pair came in. Every state is then
/// driven, or shown, with strength `rate` by what follows it on its way to the outputs. Every state needs
/// such a way (reach_outputs), except with C without rows, where A alone is balanced.
/// pull: how much the outputs count, 0..1; less leaves
/// more to the balance of A.
Pair balanced(const Matrix& A, const Matrix& C, double rate, double pull = 1.0);

/// S C only, every row of length `rate`: states stay as they are. In networks where every state is far from
/// the outputs, balancing grows exponentially with that distance, and what is seen well looks hardly seen.
Pair rows_scaled(const Matrix& A, const Matrix& C, double rate);

/// A rate of the pair that no scaling changes: the largest sqrt(|a_ij a_ji|), 1 where all are 0.
double natural_rate(const Matrix& A);

/// The pair in units in which no square of an entry overflows or vanishes, as far as doubles allow; as it is
/// where that holds already. Powers of 2 only, so nothing is rounded.
Pair in_moderate_units(const Matrix& A, const Matrix& C);

/// States in the order of their distance from the outputs; those that move none are missing.
std::vector<Eigen::Index> from_outputs(const Matrix& A, const Matrix& C);

/// For every state: it moves some output, at once or through other states (by the zeros of A and C alone).
std::vector<char> reach_outputs(const Matrix& A, const Matrix& C);

}  // namespace garrison::detail
