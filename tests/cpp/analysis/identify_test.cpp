// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/identify.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "core/solvers.hpp"
#include "garrison/filters/central_kalman.hpp"

using namespace garrison;

namespace {

/// Six stations that see two factors with coefficients 0.8 and 0.3, a season and small noise.
Matrix synthetic(test::Rng& rng, int samples) {
  Matrix loadings(6, 2);
  loadings << 1, 0.5, 1, -0.5, 1, 1, 1, -1, 1, 0.2, 1, -0.2;
  Matrix raw(samples, 6);
  Vector x = Vector::Zero(2);
  for (int t = 0; t < samples; ++t) {
    const Vector w = test::normal_matrix(rng, 2, 1);
    x = Vector(x.cwiseProduct(Vector{{0.8, 0.3}}) + w);
    const double season = 5.0 + 2.0 * std::cos(2.0 * 3.14159265358979 * t / 365.25);
    raw.row(t) = (loadings * x + 0.05 * test::normal_matrix(rng, 6, 1)).transpose().array() + season;
  }
  return raw;
}

}  // namespace

TEST_CASE("a known model is found again, also with gaps") {
  test::Rng rng(3);
  Matrix raw = synthetic(rng, 6000);
  for (const bool gaps : {false, true}) {
    if (gaps)
      for (int k = 0; k < 1500; ++k) raw(test::whole(rng, 0, 5999), test::whole(rng, 0, 5)) = kNaN;
    const Identified m = identify(raw, 0, {2, 1, 365.25, false, 1.0});
    CAPTURE(gaps);
    const Eigen::VectorXcd poles = m.A.eigenvalues();
    CHECK(std::max(poles(0).real(), poles(1).real()) == doctest::Approx(0.8).epsilon(0.05));
    CHECK(std::min(poles(0).real(), poles(1).real()) == doctest::Approx(0.3).epsilon(0.15));
    CHECK((m.season.row(0).array() - 5.0).abs().maxCoeff() < 0.3);
    CHECK((m.C.rowwise().norm().array() - 1.0).abs().maxCoeff() < 1e-12);
    CHECK(m.share.sum() > 0.99);
    const Matrix y = measurements(m, raw, 0);
    const Matrix x = reference_states(m, y);
    for (Eigen::Index t = 0; t + 1 < x.rows(); ++t) {  // the bounds hold on the records that they come from
      const double w = (x.row(t + 1).transpose() - m.A * x.row(t).transpose()).norm();
      if (!std::isnan(w)) CHECK(w <= m.process_bound * (1 + 1e-12));
    }
  }
}

TEST_CASE("identify refuses records that do not suffice") {
  test::Rng rng(4);
  const Matrix raw = synthetic(rng, 400);
  CHECK_THROWS_WITH_AS(identify(raw, 0, {7, 1}),
                       doctest::Contains("fit.factors: got 7, expected a number in 1..6"), InvalidInput);
  CHECK_THROWS_WITH_AS(identify(raw.topRows(20), 0, {2, 1}), doctest::Contains("use more years"),
                       InvalidInput);
  Matrix constant = raw;
  constant.col(2).setConstant(3.0);
  CHECK_THROWS_WITH_AS(identify(constant, 0, {2, 0}), doctest::Contains("station 2"), InvalidInput);
  Matrix empty = raw;
  empty.col(1).setConstant(kNaN);
  CHECK_THROWS_WITH_AS(identify(empty, 0, {2, 0}), doctest::Contains("station 1: got 0 records"),
                       InvalidInput);
  Matrix negative = raw;
  negative(5, 0) = -1.0;
  CHECK_THROWS_WITH_AS(identify(negative, 0, {2, 0, 365.25, true, 1.0}),
                       doctest::Contains("records[5, 0]: got -1"), InvalidInput);
}

TEST_CASE("the central Kalman filter is least squares with a memory") {
  // A constant seen by two sensors: after t samples the estimate is the mean of all measurements.
  const Model model(Matrix::Ones(1, 1), std::vector<Matrix>(2, Matrix::Ones(1, 1)),
                    {kNaN, {}, Matrix::Zero(1, 1), std::vector<Matrix>(2, Matrix::Ones(1, 1))});
  Matrix y(3, 2);
  y << 1, 2, 3, kNaN, 5, 7;
  const Matrix x = central_kalman(model, y, Vector::Zero(1), 1e12);
  CHECK(x(1, 0) == doctest::Approx(1.5));
  CHECK(x(2, 0) == doctest::Approx(2.0));
  CHECK(x(3, 0) == doctest::Approx(3.6));
  CHECK_THROWS_WITH_AS(central_kalman(Model(model.A(), {model.C(0), model.C(1)}), y, Vector::Zero(1), 1.0),
                       doctest::Contains("no covariances"), InvalidInput);
}
