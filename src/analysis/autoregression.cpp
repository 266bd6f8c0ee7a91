// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/autoregression.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/solvers.hpp"
#include "giant_record.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;

struct Regression {
  Matrix coefficients;  // (N p + inputs) x N
  Matrix covariance;
};

/// Rows whose last `lags` rows, inputs and self are complete.
std::vector<Index> complete(const MatrixRef& z, const MatrixRef& u, int lags) {
  std::vector<Index> rows;
  int known = 0;  // rows in a row, up to the one before
  for (Index t = 0; t < z.rows(); ++t) {
    const bool here = z.row(t).allFinite();
    if (here && known >= lags && u.row(t).allFinite()) rows.push_back(t);
    known = here ? known + 1 : 0;
  }
  return rows;
}

Matrix regressors(const MatrixRef& z, const MatrixRef& u, int order, const std::vector<Index>& rows) {
  const Index N = z.cols();
  Matrix X(static_cast<Index>(rows.size()), N * order + u.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto r = static_cast<Index>(k);
    for (int lag = 1; lag <= order; ++lag) X.row(r).segment(N * (lag - 1), N) = z.row(rows[k] - lag);
    X.row(r).tail(u.cols()) = u.row(rows[k]);
  }
  return X;
}

Matrix targets(const MatrixRef& z, const std::vector<Index>& rows) {
  Matrix Y(static_cast<Index>(rows.size()), z.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) Y.row(static_cast<Index>(k)) = z.row(rows[k]);
  return Y;
}

/// Lengths of the columns, rounded to powers of 2 (bits stay): regressors have units of their own, which must
/// not decide what follows from what.
Vector column_lengths(const Matrix& X) {
  return X.colwise().norm().unaryExpr(
      [](double l) { return l > 0.0 ? std::exp2(std::round(std::log2(l))) : 1.0; });
}

Regression regressed(const MatrixRef& z, const MatrixRef& u, int order, const std::vector<Index>& rows) {
  const Matrix X = regressors(z, u, order, rows);
  const Matrix Y = targets(z, rows);
  if (X.rows() < 10 * X.cols())
    refuse("records", amount(X.rows(), "sample") + " with a complete past",
           "at least " + std::to_string(10 * X.cols()) + " for order " + std::to_string(order),
           "use more records, a smaller order or fewer stations");
  const Vector unit = column_lengths(X);
  const Eigen::ColPivHouseholderQR<Matrix> qr(X * unit.cwiseInverse().asDiagonal());
  if (qr.rank() < X.cols()) {
    detail::refuse_giant_record(z, z);
    refuse("records", "stations or inputs that depend on each other", "independent ones",
           "leave out what follows from the others");
  }
  Regression found;
  found.coefficients = unit.cwiseInverse().asDiagonal() * qr.solve(Y);
  const Matrix E = Y - X * found.coefficients;
  found.covariance = E.transpose() * E / static_cast<double>(X.rows());
  return found;
}

/// Mean over samples of the Gaussian log-density of what the regression leaves over.
double likelihood(const Regression& r, const Matrix& X, const Matrix& Y) {
  const Eigen::LLT<Matrix> root(r.covariance);
  if (root.info() != Eigen::Success) return -kInfinity;
  const Matrix E = (Y - X * r.coefficients).transpose();
  const double squares = root.matrixL().solve(E).squaredNorm() / static_cast<double>(Y.rows());
  const double logs = 2.0 * root.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (squares + logs + static_cast<double>(Y.cols()) * std::log(2.0 * std::numbers::pi));
}

std::vector<double> held_out(const MatrixRef& z, const MatrixRef& u, const AutoregressionOptions& o) {
  const std::vector<Index> all = complete(z, u, o.most);
  const auto kept = static_cast<std::size_t>(static_cast<double>(all.size()) * (1.0 - o.held_out));
  const std::vector<Index> before(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept));
  const std::vector<Index> after(all.begin() + static_cast<std::ptrdiff_t>(kept), all.end());
  if (after.empty())
    refuse("records", amount(all.size(), "sample") + " with a complete past of " + std::to_string(o.most),
           "enough to hold some out", "use more records or a smaller largest order");
  std::vector<double> found;
  for (int order = 1; order <= o.most; ++order)
    found.push_back(
        likelihood(regressed(z, u, order, before), regressors(z, u, order, after), targets(z, after)));
  return found;
}

void require(const MatrixRef& z, const MatrixRef& u, const AutoregressionOptions& o) {
  if (z.rows() < 2 || z.cols() < 1)
    refuse("records", std::to_string(z.rows()) + " x " + std::to_string(z.cols()), "samples x stations");
  if (o.most < 1 || o.most > 1000) refuse("fit.most", std::to_string(o.most), "a number in 1..1000");
  if (o.order < 0 || o.order > o.most)
    refuse("fit.order", std::to_string(o.order),
           "a number in 1.." + std::to_string(o.most) + ", or 0 to choose", "see `most`");
  if (!(o.held_out > 0.0 && o.held_out <= 0.9))
    refuse("fit.held_out", text(o.held_out), "a share in (0, 0.9]");
  if (u.rows() != z.rows())
    refuse("fit.inputs", amount(u.rows(), "row"), std::to_string(z.rows()) + ", one per record");
}

}  // namespace

Autoregression autoregress(const MatrixRef& z, const MatrixRef& u, const AutoregressionOptions& options) {
  require(z, u, options);
  Autoregression found;
  found.order = options.order;
  if (options.order == 0) {
    found.held_out = held_out(z, u, options);
    const auto best = std::max_element(found.held_out.begin(), found.held_out.end());
    found.order = 1 + static_cast<int>(best - found.held_out.begin());
  }
  const Index N = z.cols();
  const Index n = N * found.order;
  const std::vector<Index> rows = complete(z, u, found.order);
  const Regression r = regressed(z, u, found.order, rows);
  found.samples = static_cast<int>(rows.size());
  found.A = Matrix::Zero(n, n);
  found.A.topRows(N) = r.coefficients.topRows(n).transpose();
  found.A.bottomLeftCorner(n - N, n - N).setIdentity();
  found.B = Matrix::Zero(n, u.cols());
  found.B.topRows(N) = r.coefficients.bottomRows(u.cols()).transpose();
  found.residual_covariance = r.covariance;
  const Matrix E = targets(z, rows) - regressors(z, u, found.order, rows) * r.coefficients;
  found.residual_bound = E.rowwise().norm().maxCoeff();
  found.residuals = Matrix::Constant(z.rows(), N, kNaN);
  for (std::size_t k = 0; k < rows.size(); ++k) found.residuals.row(rows[k]) = E.row(static_cast<Index>(k));
  return found;
}

Identified identified(const Autoregression& found, const Matrix& season, const FitOptions& options,
                      double noise) {
  if (!(noise > 0.0 && noise < 1.0)) refuse("fit.noise", text(noise), "a share in (0, 1)");
  const Index n = found.A.rows();
  const Index N = found.residual_covariance.rows();
  if (season.cols() != N || found.residual_covariance.cols() != N || found.A.cols() != n || N < 1 || n < N)
    refuse("season", std::to_string(season.rows()) + " x " + std::to_string(season.cols()),
           "a column per station of the autoregression (" + std::to_string(N) + ")");
  Identified m;
  m.options = options;
  m.season = season;
  m.scale = Vector::Ones(N);
  m.weight = Vector::Ones(N);
  m.A = found.A;
  m.C = Matrix::Identity(N, n);
  m.process_covariance = Matrix::Zero(n, n);
  m.process_covariance.topLeftCorner(N, N) = found.residual_covariance;
  m.measurement_variance = noise * found.residual_covariance.diagonal();
  m.process_bound = found.residual_bound;
  return m;
}

}  // namespace garrison
