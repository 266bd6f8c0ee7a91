// SPDX-License-Identifier: Apache-2.0
// The functions of a nonlinear plant, with their results checked. Internal to the drivers.
#pragma once

#include <string>
#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/drivers/nonlinear.hpp"

namespace garrison::detail {

/// All of it throws InvalidInput where a function returns another size than the model's, or a number that is
/// not finite, and whatever a function throws.
class Functions {
 public:
  /// `of`: whose states the columns are, for messages: "the true state", or "the estimate".
  Functions(const Nonlinear& plant, const Model& model, std::string of);

  /// Of every column its state at t + 1, without noise. `inputs`: of the run, row t is u(t).
  Matrix moved(const Matrix& X, const Matrix& inputs, int t) const;
  /// What the sensors of agent i measure at column i of X (n x N), without noise.
  Vector measured(const Matrix& X, int t) const;
  /// Rows of the model that are linear, zeros in all others; empty where none is.
  const Matrix& linear() const { return C_; }
  /// The derivative of `measured`, total_outputs x n: the rows of agent i at column i of X.
  Matrix rows(const Matrix& X, int t) const;

 private:
  void require_linear(const Vector& found, const Matrix& X, int t) const;
  Matrix derivative(const Matrix& X, int t) const;
  Matrix differences(const Matrix& X, int t) const;
  [[noreturn]] void refuse_number(const char* name, const Matrix& X, Eigen::Index column, int t) const;
  /// Refuses numbers that are not finite, one or a row of them per output.
  void require_finite(const char* name, const Matrix& found, const Matrix& X, int t) const;

  const Nonlinear& plant_;
  const Model& model_;
  Matrix C_;                // of the model, where some rows are linear
  std::vector<int> owner_;  // the agent of each output there
  std::string of_;
};

}  // namespace garrison::detail
