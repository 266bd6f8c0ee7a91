// SPDX-License-Identifier: Apache-2.0
// What changes of a plant in time.
#pragma once

#include <vector>

#include "garrison/core/model.hpp"

namespace garrison {

/// Matrices of a plant over time. Every part is empty (as the model says, always) or has one matrix per step:
/// entry t-1 of A, B and process_covariance leads from time t-1 to t, entry t-1 of C and
/// measurement_covariance is that of sample t.
struct GARRISON_EXPORT Series {
  std::vector<Matrix> A = {};                   ///< n x n
  std::vector<Matrix> B = {};                   ///< n x p
  std::vector<Matrix> C = {};                   ///< all C_i on top of each other, total_outputs x n
  std::vector<Matrix> process_covariance = {};  ///< n x n, symmetric positive semidefinite
  /// All R_i below each other, total_outputs x the most outputs of an agent; right of a smaller one zeros.
  std::vector<Matrix> measurement_covariance = {};

  bool empty() const {
    return A.empty() && B.empty() && C.empty() && process_covariance.empty() &&
           measurement_covariance.empty();
  }
  /// Of the step from t-1 to t, or of sample t >= 1.
  const Matrix& A_at(const Model& model, int t) const { return at(A, t, model.A()); }
  const Matrix& B_at(const Model& model, int t) const { return at(B, t, model.B()); }

 private:
  static const Matrix& at(const std::vector<Matrix>& all, int t, const Matrix& constant) {
    return all.empty() ? constant : all[static_cast<std::size_t>(t - 1)];
  }
};

/// R_i of sample t >= 1; the model or the series has it.
inline Matrix measurement_covariance_at(const Series& series, const Model& model, int agent, int t) {
  if (series.measurement_covariance.empty())
    return model.noise().measurement_covariance[static_cast<std::size_t>(agent)];
  const int m = model.outputs(agent);
  return series.measurement_covariance[static_cast<std::size_t>(t - 1)].block(model.offset(agent), 0, m, m);
}

/// W with W R W' = I, lower triangular; empty where R is not positive definite.
GARRISON_EXPORT Matrix whitener(const Matrix& R);

/// Refuses matrices of other shapes than the model's, fewer than `steps`, or not finite. @throws InvalidInput
GARRISON_EXPORT void require_series(const Series& series, const Model& model, int steps);

}  // namespace garrison
