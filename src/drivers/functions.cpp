// SPDX-License-Identifier: Apache-2.0
#include "functions.hpp"

#include <cmath>

#include "garrison/kernel/differences.hpp"

namespace garrison::detail {
namespace {

void require_size(const char* name, const Matrix& found, Eigen::Index rows, Eigen::Index cols,
                  const char* of_what) {
  if (found.rows() == rows && found.cols() == cols) return;
  refuse(name, std::to_string(found.rows()) + " x " + std::to_string(found.cols()) + " numbers",
         std::to_string(rows) + " x " + std::to_string(cols) + ", " + of_what);
}

}  // namespace

Functions::Functions(const Nonlinear& plant, const Model& model, std::string of)
    : plant_(plant), model_(model), of_(std::move(of)) {
  if (plant.linear.empty()) return;
  const Matrix all = model.stacked();
  C_ = Matrix::Zero(all.rows(), all.cols());
  for (const int r : plant.linear) C_.row(r) = all.row(r);
  for (int i = 0; i < model.agents(); ++i)
    owner_.insert(owner_.end(), static_cast<std::size_t>(model.outputs(i)), i);
}

void Functions::refuse_number(const char* name, const Matrix& X, Eigen::Index column, int t) const {
  const std::string who = X.cols() > 1 ? " of agent " + std::to_string(column) : "";
  refuse(name, "a number that is not finite at time " + std::to_string(t) + ", for " + of_ + who,
         "finite numbers",
         "the largest number of that state is " + text(X.col(column).cwiseAbs().maxCoeff()) +
             "; it may have left the range of the function");
}

void Functions::require_finite(const char* name, const Matrix& found, const Matrix& X, int t) const {
  if (found.allFinite()) return;
  for (int i = 0; i < model_.agents(); ++i)
    if (!found.middleRows(model_.offset(i), model_.outputs(i)).allFinite()) refuse_number(name, X, i, t);
}

Matrix Functions::moved(const Matrix& X, const Matrix& inputs, int t) const {
  const Vector u = model_.inputs() == 0 ? Vector(0) : Vector(inputs.row(t).transpose());
  Matrix found = plant_.f(X, u, t);
  require_size("f", found, X.rows(), X.cols(), "a column per column of X");
  for (Eigen::Index k = 0; k < found.cols(); ++k)
    if (!found.col(k).allFinite()) refuse_number("f", X, k, t);
  return found;
}

Vector Functions::measured(const Matrix& X, int t) const {
  Vector found = plant_.h(X, t);
  require_size("h", found, model_.total_outputs(), 1, "the outputs of all agents");
  require_finite("h", found, X, t);
  require_linear(found, X, t);
  return found;
}

void Functions::require_linear(const Vector& found, const Matrix& X, int t) const {
  constexpr double kRounding = 1e-9;  // of the largest term of a sum
  for (const int r : plant_.linear) {
    const Vector terms = C_.row(r).transpose().cwiseProduct(X.col(owner_[static_cast<std::size_t>(r)]));
    if (std::abs(found(r) - terms.sum()) <= kRounding * (terms.cwiseAbs().sum() + 1e-9)) continue;
    refuse("linear",
           "output " + std::to_string(r) + ", of which h says " + text(found(r)) + " at time " +
               std::to_string(t) + ", for " + of_ + ", and its row " + text(terms.sum()),
           "outputs that are their row times the state",
           "take it out of the linear ones; subtract constants in h");
  }
}

Matrix Functions::rows(const Matrix& X, int t) const {
  Matrix found = derivative(X, t);
  for (const int r : plant_.linear) found.row(r) = C_.row(r);
  return found;
}

Matrix Functions::derivative(const Matrix& X, int t) const {
  if (!plant_.h_jacobian) return differences(X, t);
  Matrix found = plant_.h_jacobian(X, t);
  require_size("h_jacobian", found, model_.total_outputs(), model_.states(), "a row per output");
  require_finite("h_jacobian", found, X, t);
  return found;
}

Matrix Functions::differences(const Matrix& X, int t) const {
  Matrix C(model_.total_outputs(), model_.states());
  Matrix beside = X;
  for (Eigen::Index k = 0; k < X.rows(); ++k) {
    const Eigen::RowVectorXd step = X.row(k).unaryExpr([](double x) { return difference_step(x); });
    beside.row(k) += step;
    const Vector above = measured(beside, t);
    Eigen::RowVectorXd width = beside.row(k);
    beside.row(k) = X.row(k) - step;
    width -= beside.row(k);
    C.col(k) = above - measured(beside, t);
    beside.row(k) = X.row(k);
    for (int i = 0; i < model_.agents(); ++i)
      C.col(k).segment(model_.offset(i), model_.outputs(i)) /= width(i);
  }
  return C;
}

}  // namespace garrison::detail
