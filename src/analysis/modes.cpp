// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/modes.hpp"

#include <Eigen/QR>

#include "core/solvers.hpp"

namespace garrison {

std::vector<std::complex<double>> unseen_modes(const MatrixRef& A, const MatrixRef& C, double least,
                                               double tolerance) {
  const Eigen::Index n = A.rows();
  if (n < 1 || A.cols() != n)
    refuse("A", std::to_string(n) + " x " + std::to_string(A.cols()),
           "a square matrix with at least one row");
  if (C.rows() > 0 && C.cols() != n)
    refuse("C", std::to_string(C.cols()) + " columns", std::to_string(n) + ", as many as A");
  if (!A.allFinite() || !C.allFinite()) refuse("A or C", "a number that is not finite", "finite numbers");
  std::vector<std::complex<double>> unseen;
  const Eigen::VectorXcd values = Eigen::EigenSolver<Matrix>(A, false).eigenvalues();
  for (Eigen::Index k = 0; k < n; ++k) {
    // A mode that rounding puts just inside counts as on the circle.
    if (std::abs(values(k)) < least * (1.0 - 1e-9)) continue;
    Eigen::MatrixXcd test(n + C.rows(), n);
    test.topRows(n) = values(k) * Eigen::MatrixXcd::Identity(n, n) - A.cast<std::complex<double>>();
    test.bottomRows(C.rows()) = C.cast<std::complex<double>>();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> qr(test);
    qr.setThreshold(tolerance);
    if (qr.rank() < n) unseen.push_back(values(k));
  }
  return unseen;
}

std::vector<int> undetectable_agents(const Model& model, double tolerance) {
  std::vector<int> all;
  for (int i = 0; i < model.agents(); ++i) {
    if (model.outputs(i) == 0) continue;
    Matrix others(model.total_outputs() - model.outputs(i), model.states());
    Eigen::Index row = 0;
    for (int j = 0; j < model.agents(); ++j) {
      if (j == i) continue;
      others.middleRows(row, model.outputs(j)) = model.C(j);
      row += model.outputs(j);
    }
    const auto without = unseen_modes(model.A(), others, 1.0, tolerance);
    if (without.empty()) continue;
    // A mode that this agent does not see either cannot be hidden behind it.
    const auto with = unseen_modes(model.A(), model.stacked(), 1.0, tolerance);
    if (without.size() > with.size()) all.push_back(i);
  }
  return all;
}

}  // namespace garrison
