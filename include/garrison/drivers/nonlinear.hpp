// SPDX-License-Identifier: Apache-2.0
// A nonlinear plant by functions, of a whole network at once.
#pragma once

#include <functional>
#include <vector>

#include "garrison/core/types.hpp"

namespace garrison {

/// x(t+1) = f(x(t), u(t), t) + w(t), y(t) = h(x(t), t) + v(t). Every column of X is a state; agents may be at
/// different ones. Functors, functions or lambdas; they may throw, and results of another size, or that are
/// not finite, are refused.
/// Threads: trials that run on several threads call them at the same time.
struct Nonlinear {
  /// n x k from n x k, column by column, whatever k is. `u`: u(t), empty where the model has no inputs.
  std::function<Matrix(const Matrix& X, const Vector& u, int t)> f;
  /// What all sensors measure, Model::total_outputs() numbers; those of agent i at column i of X (n x N).
  std::function<Vector(const Matrix& X, int t)> h;
  /// dh/dx, total_outputs x n, the rows of agent i at column i of X; empty = by central differences.
  std::function<Matrix(const Matrix& X, int t)> h_jacobian = {};
  /// Outputs r that are linear, h_r(x) = C_r x with the model's C, at all x and t (refused where h says
  /// something else). Certificates of single samples rest on these rows, and on no others.
  std::vector<int> linear = {};
};

}  // namespace garrison
