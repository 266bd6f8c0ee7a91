// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/identify.hpp"

#include <Eigen/QR>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/solvers.hpp"
#include "giant_record.hpp"
#include "median.hpp"

namespace garrison {
namespace {

/// Sizes of two columns beyond which nobody may mean that they have one unit.
constexpr double kComparable = 100.0;
/// Deviations whose squares, and sums of these, are doubles.
constexpr double kTiny = 1e-70;
constexpr double kVast = 1e70;
/// Part of the largest record, and of the largest deviation from the middle, that is rounding.
constexpr double kRounding = 64.0 * 0x1p-52;
constexpr double kSeasonRounding = 1e-9;

std::string shape(const MatrixRef& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

void require_options(const MatrixRef& raw, const FitOptions& o) {
  if (o.factors < 1 || o.factors > raw.cols())
    refuse("fit.factors", std::to_string(o.factors), "a number in 1.." + std::to_string(raw.cols()),
           "at most one factor per station");
  if (o.harmonics < 0) refuse("fit.harmonics", std::to_string(o.harmonics), "a number >= 0");
  if (!(o.period > 0.0)) refuse("fit.period", text(o.period), "a number of samples > 0");
  if (o.harmonics > 0 && !(o.period > 2.0 * o.harmonics))
    refuse("fit.period", text(o.period),
           "more than " + amount(2 * o.harmonics, "sample") +
               ", two for each of the fit.harmonics = " + std::to_string(o.harmonics),
           "a cycle that is sampled more rarely looks like a longer one");
  if (!(o.factor > 0.0) || !std::isfinite(o.factor))
    refuse("fit.factor", text(o.factor), "a finite number > 0");
}

/// Records after unit conversion and square root.
Matrix transformed(const MatrixRef& raw, const FitOptions& o) {
  Matrix z = raw * o.factor;
  for (Eigen::Index j = 0; j < z.cols(); ++j)
    for (Eigen::Index i = 0; i < z.rows(); ++i) {
      if (std::isinf(z(i, j)))
        refuse("records[" + std::to_string(i) + ", " + std::to_string(j) + "]", text(z(i, j)),
               "a finite number or nan");
      if (o.root && z(i, j) < 0.0)
        refuse("records[" + std::to_string(i) + ", " + std::to_string(j) + "]", text(raw(i, j)),
               "a number >= 0 with the square root", "drop it, or fit without the root");
    }
  if (o.root) z = z.cwiseSqrt();
  return z;
}

Matrix seasonal_design(Eigen::Index rows, std::int64_t first, const FitOptions& o) {
  Matrix X(rows, 1 + 2 * o.harmonics);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(first + r) / o.period;
    X(r, 0) = 1.0;
    for (int h = 1; h <= o.harmonics; ++h) {
      X(r, 2 * h - 1) = std::cos(h * phase);
      X(r, 2 * h) = std::sin(h * phase);
    }
  }
  return X;
}

/// Refuses what does not vary, or so little or so much that squares are no doubles.
void require_spread(const std::string& which, double spread, double largest, double from_middle) {
  if (!(spread > kSeasonRounding * from_middle + kRounding * largest))
    refuse(which, "records without variation", "records that vary around their season", "leave it out");
  if (!(spread > kTiny && spread < kVast))
    refuse(which, "records that vary by " + text(spread), "between " + text(kTiny) + " and " + text(kVast),
           "bring them to another unit (fit.factor)");
}

/// Seasonal coefficients of one station from the samples that are present. Relative to their middle, so that
/// an offset does not hide what varies.
Vector season_of(const Matrix& X, const Vector& z, Eigen::Index station) {
  const auto present = (z.array() == z.array());
  const Eigen::Index count = present.count();
  const std::string which = "station " + std::to_string(station);
  if (count < 10 * X.cols())
    refuse(which, std::to_string(count) + " records", "at least " + std::to_string(10 * X.cols()),
           count == 0 ? "leave it out" : "use more years, or fewer harmonics");
  Matrix rows(count, X.cols());
  Vector values(count);
  for (Eigen::Index r = 0, k = 0; r < z.size(); ++r)
    if (present(r)) {
      rows.row(k) = X.row(r);
      values(k++) = z(r);
    }
  const double largest = values.cwiseAbs().maxCoeff();
  Vector ordered = values;
  const double middle = detail::median(ordered);
  values.array() -= middle;
  Vector coefficients = rows.colPivHouseholderQr().solve(values);
  const double spread = (values - rows * coefficients).stableNorm() / std::sqrt(static_cast<double>(count));
  require_spread(which, spread, largest, values.cwiseAbs().maxCoeff());
  coefficients(0) += middle;
  return coefficients;
}

/// Standard deviation of every station around its season.
Vector spreads(const Matrix& deviations) {
  Vector found(deviations.cols());
  for (Eigen::Index i = 0; i < deviations.cols(); ++i) {
    const auto present = (deviations.col(i).array() == deviations.col(i).array());
    found(i) = std::sqrt(present.select(deviations.col(i).array().square(), 0.0).sum() /
                         static_cast<double>(present.count()));
  }
  return found;
}

/// Size of a station's deviations that a few wild records do not change: the median, or the standard
/// deviation where half of them are 0.
double typical_size(const Vector& deviations, double spread) {
  std::vector<double> sizes;
  for (const double one : deviations)
    if (!std::isnan(one)) sizes.push_back(std::abs(one));
  const double middle = detail::median(sizes);
  return middle > 0.0 ? middle : spread;
}

/// Refuses stations whose deviations nobody may mean to have one unit.
void require_comparable(const Matrix& deviations, const Vector& spread) {
  Vector size(spread.size());
  for (Eigen::Index i = 0; i < size.size(); ++i) size(i) = typical_size(deviations.col(i), spread(i));
  Eigen::Index least = 0;
  const double largest = size.maxCoeff();
  if (size.minCoeff(&least) * kComparable < largest)
    refuse("station " + std::to_string(least),
           "deviations of about " + text(size(least)) + " beside " + text(largest),
           "columns of comparable sizes",
           "set standardise (true: every column in units of its own spread; false: all have one unit)");
}

/// What every station's deviations are measured in where factors are looked for; equal numbers keep their
/// bits.
Vector column_units(const Matrix& deviations, std::optional<bool> standardise) {
  const Vector spread = spreads(deviations);
  if (standardise.value_or(false)) return spread;
  if (!standardise) require_comparable(deviations, spread);
  return Vector::Constant(spread.size(), std::exp2(std::round(std::log2(spread.maxCoeff()))));
}

/// Covariance over the samples at which both stations are present.
Matrix pairwise_covariance(const Matrix& a) {
  Matrix S(a.cols(), a.cols());
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = 0.0;
      double count = 0.0;
      for (Eigen::Index r = 0; r < a.rows(); ++r) {
        const double product = a(r, i) * a(r, j);
        if (std::isnan(product)) continue;
        sum += product;
        count += 1.0;
      }
      S(i, j) = S(j, i) = count > 0.0 ? sum / count : 0.0;
    }
  return S;
}

bool present(const Matrix& x, Eigen::Index row) { return x.row(row).allFinite(); }

void fit_dynamics(const Matrix& x, Identified& m) {
  const auto n = x.cols();
  Matrix now = Matrix::Zero(n, n);
  Matrix next = Matrix::Zero(n, n);
  Eigen::Index pairs = 0;
  for (Eigen::Index r = 0; r + 1 < x.rows(); ++r) {
    if (!present(x, r) || !present(x, r + 1)) continue;
    now += x.row(r).transpose() * x.row(r);
    next += x.row(r + 1).transpose() * x.row(r);
    ++pairs;
  }
  if (pairs < 10 * n)
    refuse("records", std::to_string(pairs) + " complete successive rows",
           "at least " + std::to_string(10 * n), "use more years or fewer factors");
  m.A = now.ldlt().solve(next.transpose()).transpose();
  m.process_covariance = Matrix::Zero(n, n);
  m.process_bound = 0.0;
  for (Eigen::Index r = 0; r + 1 < x.rows(); ++r) {
    if (!present(x, r) || !present(x, r + 1)) continue;
    const Vector w = x.row(r + 1).transpose() - m.A * x.row(r).transpose();
    m.process_covariance += w * w.transpose() / static_cast<double>(pairs);
    m.process_bound = std::max(m.process_bound, w.norm());
  }
}

void fit_measurement_noise(const Matrix& x, const Matrix& y, Identified& m) {
  m.measurement_variance = Vector::Zero(y.cols());
  m.measurement_bound = Vector::Zero(y.cols());
  for (Eigen::Index i = 0; i < y.cols(); ++i) {
    double count = 0.0;
    for (Eigen::Index r = 0; r < y.rows(); ++r) {
      const double v = y(r, i) - m.C.row(i).dot(x.row(r));
      if (std::isnan(v)) continue;
      m.measurement_variance(i) += v * v;
      m.measurement_bound(i) = std::max(m.measurement_bound(i), std::abs(v));
      count += 1.0;
    }
    m.measurement_variance(i) /= std::max(count, 1.0);
  }
}

}  // namespace

Matrix anomalies(const MatrixRef& raw, std::int64_t first, const FitOptions& options, Matrix& season) {
  if (raw.rows() < 2 || raw.cols() < 1) refuse("records", shape(raw), "samples x stations");
  require_options(raw, options);
  if (const std::int64_t least = 2 * std::int64_t{options.harmonics} + 2; raw.rows() < least)
    refuse("fit.harmonics",
           std::to_string(options.harmonics) + " with " + std::to_string(raw.rows()) + " records",
           "at least " + std::to_string(least) + " records", "use more records, or fewer harmonics");
  const Matrix z = transformed(raw, options);
  detail::refuse_hiding_record(z, raw);
  const Matrix X = seasonal_design(z.rows(), first, options);
  season.resize(X.cols(), z.cols());
  for (Eigen::Index i = 0; i < z.cols(); ++i) season.col(i) = season_of(X, z.col(i), i);
  return z - X * season;
}

Identified identify(const MatrixRef& raw, std::int64_t first, const FitOptions& options) {
  Identified m;
  m.options = options;
  const Matrix deviations = anomalies(raw, first, options, m.season);
  const bool standardise = options.standardise.value_or(false);
  const Vector unit = column_units(deviations, options.standardise);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(
      pairwise_covariance(deviations * unit.cwiseInverse().asDiagonal()));
  const auto N = raw.cols();
  const auto n = options.factors;
  m.share = eigen.eigenvalues().reverse().head(n) / eigen.eigenvalues().sum();
  Matrix loadings = eigen.eigenvectors().rowwise().reverse().leftCols(n) * std::sqrt(static_cast<double>(N));
  for (int k = 0; k < n; ++k)  // a sign that does not depend on the eigenvalue solver
    if (loadings.col(k).sum() < 0.0) loadings.col(k) *= -1.0;
  const Vector length = loadings.rowwise().norm();
  for (Eigen::Index i = 0; i < N; ++i)
    if (!(length(i) > 1e-9)) {
      detail::refuse_giant_record(deviations, raw);
      refuse("station " + std::to_string(i), "no share in the factors",
             "a station that varies with the others",
             standardise ? "leave it out or use more factors"
                         : "leave it out, use more factors, or set standardise (every column in units of its "
                           "own spread)");
    }
  m.C = length.cwiseInverse().asDiagonal() * loadings;
  m.weight = length.cwiseAbs2();
  m.scale = standardise ? Vector(length.cwiseProduct(unit)) : length;
  const Matrix y = measurements(m, raw, first);
  const Matrix x = reference_states(m, y);
  fit_dynamics(x, m);
  fit_measurement_noise(x, y, m);
  return m;
}

Matrix measurements(const Identified& model, const MatrixRef& raw, std::int64_t first) {
  if (raw.cols() != model.C.rows())
    refuse("records", shape(raw), "samples x " + std::to_string(model.C.rows()),
           "the stations the model was fitted to");
  const Matrix anomalies =
      transformed(raw, model.options) - seasonal_design(raw.rows(), first, model.options) * model.season;
  return anomalies * model.scale.cwiseInverse().asDiagonal();
}

Matrix reference_states(const Identified& model, const MatrixRef& measured) {
  const auto n = model.C.cols();
  if (measured.cols() != model.C.rows())
    refuse("measured", shape(measured), "samples x " + std::to_string(model.C.rows()));
  Matrix x = Matrix::Constant(measured.rows(), n, kNaN);
  for (Eigen::Index r = 0; r < measured.rows(); ++r) {
    // Least squares of the anomalies themselves (each in its unit, where they are standardised), the
    // projection that defined the factors.
    Matrix normal = Matrix::Zero(n, n);
    Vector right = Vector::Zero(n);
    for (Eigen::Index i = 0; i < measured.cols(); ++i) {
      if (std::isnan(measured(r, i))) continue;
      normal += model.weight(i) * model.C.row(i).transpose() * model.C.row(i);
      right += model.weight(i) * measured(r, i) * model.C.row(i).transpose();
    }
    const Eigen::LDLT<Matrix> factor(normal);
    if (factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 1e-9) x.row(r) = factor.solve(right);
  }
  return x;
}

}  // namespace garrison
