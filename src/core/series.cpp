// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/series.hpp"

#include "core/solvers.hpp"

namespace garrison {
namespace {

std::string shape(Eigen::Index rows, Eigen::Index cols) {
  return std::to_string(rows) + " x " + std::to_string(cols);
}

void require_part(const char* name, const std::vector<Matrix>& part, Eigen::Index rows, Eigen::Index cols,
                  int steps) {
  if (part.empty()) return;
  if (part.size() < static_cast<std::size_t>(steps))
    refuse(name, std::to_string(part.size()) + " matrices over time",
           "at least " + std::to_string(steps) + ", one per step");
  for (std::size_t t = 0; t < part.size(); ++t) {
    const std::string which = std::string(name) + "[" + std::to_string(t) + "]";
    if (part[t].rows() != rows || part[t].cols() != cols)
      refuse(which, shape(part[t].rows(), part[t].cols()), shape(rows, cols), "as at all other times");
    if (!part[t].allFinite()) refuse(which, "a number that is not finite", "finite numbers");
  }
}

void require_covariance(const Matrix& S, std::size_t t) {
  const std::string which = "process_covariance[" + std::to_string(t) + "]";
  if (!S.isApprox(S.transpose(), 1e-12)) refuse(which, "a matrix that is not symmetric", "a symmetric one");
  const double least = Eigen::SelfAdjointEigenSolver<Matrix>(S, Eigen::EigenvaluesOnly).eigenvalues()(0);
  if (least < -1e-12 * S.cwiseAbs().maxCoeff())
    refuse(which, "least eigenvalue " + std::to_string(least), "a positive semidefinite covariance");
}

}  // namespace

void require_series(const Series& series, const Model& model, int steps) {
  const auto n = model.states();
  require_part("A", series.A, n, n, steps);
  require_part("B", series.B, n, model.inputs(), steps);
  require_part("C", series.C, model.total_outputs(), n, steps);
  require_part("process_covariance", series.process_covariance, n, n, steps);
  for (std::size_t t = 0; t < series.process_covariance.size(); ++t)
    require_covariance(series.process_covariance[t], t);
}

}  // namespace garrison
