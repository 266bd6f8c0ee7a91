// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "core/solvers.hpp"
#include "garrison/filters/rdkf/box_step.hpp"

namespace garrison::rdkf {

BoxFactors box_factors(const MatrixRef& whitener, const MatrixRef& C, const MatrixRef& Q) {
  if (C.rows() > kMostBoxOutputs)
    refuse("C", amount(C.rows(), "row"),
           "at most " + amount(kMostBoxOutputs, "sensor") + " per agent with the l1 penalty");
  const Eigen::LLT<Matrix> factor(Q);
  if (factor.info() != Eigen::Success)
    refuse("Q", "a matrix that is not positive definite", "a symmetric positive definite matrix");
  BoxFactors f;
  f.R = whitener;
  f.M = whitener * C;
  f.W = factor.solve(f.M.transpose()) / 2.0;
  f.H = f.M * f.W;
  f.H = (0.5 * (f.H + f.H.transpose())).eval();
  f.proximal = proximal_weight(f.H.size() == 0 ? 0.0 : f.H.diagonal().maxCoeff());
  return f;
}

}  // namespace garrison::rdkf
