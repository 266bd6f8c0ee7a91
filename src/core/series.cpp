// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/series.hpp"

#include <algorithm>

#include "core/solvers.hpp"
#include "garrison/core/covariance.hpp"

namespace garrison {
namespace {

std::string shape(Eigen::Index rows, Eigen::Index cols) {
  return std::to_string(rows) + " x " + std::to_string(cols);
}

void require_part(const char* name, const std::vector<Matrix>& part, Eigen::Index rows, Eigen::Index cols,
                  int steps) {
  if (part.empty()) return;
  if (part.size() < static_cast<std::size_t>(steps))
    refuse(name, amount(part.size(), "matrix", "matrices") + " over time",
           "at least " + std::to_string(steps) + ", one per step");
  for (std::size_t t = 0; t < part.size(); ++t) {
    const std::string which = std::string(name) + "[" + std::to_string(t) + "]";
    if (part[t].rows() != rows || part[t].cols() != cols)
      refuse(which, shape(part[t].rows(), part[t].cols()), shape(rows, cols), "as at all other times");
    if (!part[t].allFinite()) refuse(which, "a number that is not finite", "finite numbers");
  }
}

void require_blocks(const Model& model, const Matrix& R, const std::string& when) {
  for (int i = 0; i < model.agents(); ++i) {
    const std::string which = "measurement_covariance" + when + " of agent " + std::to_string(i);
    const int m = model.outputs(i);
    const auto own = R.middleRows(model.offset(i), m);
    if (!own.rightCols(R.cols() - m).isZero(0.0))
      refuse(which, "numbers right of its " + amount(m, "column"), "zeros there");
    require_covariance(which, own.leftCols(m));
  }
}

int most_outputs(const Model& model) {
  int most = 0;
  for (int i = 0; i < model.agents(); ++i) most = std::max(most, model.outputs(i));
  return most;
}

}  // namespace

Matrix whitener(const Matrix& R) {
  const Eigen::LLT<Matrix> factor(R);
  if (factor.info() != Eigen::Success || !(factor.matrixLLT().diagonal().array() > 0.0).all()) return {};
  return factor.matrixL().solve(Matrix::Identity(R.rows(), R.cols()));
}

void require_series(const Series& series, const Model& model, int steps) {
  const auto n = model.states();
  require_part("A", series.A, n, n, steps);
  require_part("B", series.B, n, model.inputs(), steps);
  require_part("C", series.C, model.total_outputs(), n, steps);
  require_part("process_covariance", series.process_covariance, n, n, steps);
  require_part("measurement_covariance", series.measurement_covariance, model.total_outputs(),
               most_outputs(model), steps);
  for (std::size_t t = 0; t < series.process_covariance.size(); ++t)
    require_covariance("process_covariance[" + std::to_string(t) + "]", series.process_covariance[t]);
  for (std::size_t t = 0; t < series.measurement_covariance.size(); ++t)
    require_blocks(model, series.measurement_covariance[t], "[" + std::to_string(t) + "]");
}

}  // namespace garrison
