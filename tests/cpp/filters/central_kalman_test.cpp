// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/central_kalman.hpp"

#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "core/solvers.hpp"

using namespace garrison;

namespace {

struct Plant {
  Matrix A{{0.9, 0.2}, {-0.1, 0.95}};
  Matrix Q{{0.2, 0.05}, {0.05, 0.1}};
  std::vector<Matrix> C{Matrix{{1.0, 0.0}}, Matrix{{0.6, 0.8}, {0.0, 1.0}}};
  std::vector<Matrix> R{Matrix{{0.3}}, Matrix{{0.5, 0.0}, {0.0, 0.7}}};
  Model model() const { return {A, C, {kNaN, {}, Q, R}}; }
};

}  // namespace

TEST_CASE("the central Kalman filter settles to the gain of its Riccati equation") {
  const Plant plant;
  const Model model = plant.model();
  const Matrix C = model.stacked();
  const Matrix R = Vector{{0.3, 0.5, 0.7}}.asDiagonal();
  Matrix P = Matrix::Identity(2, 2);  // prior covariance
  for (int k = 0; k < 500; ++k) {
    const Matrix K = P * C.transpose() * (C * P * C.transpose() + R).inverse();
    P = plant.A * (P - K * C * P) * plant.A.transpose() + plant.Q;
  }
  const Matrix K = P * C.transpose() * (C * P * C.transpose() + R).inverse();
  test::Rng rng(1);
  const Matrix y = test::normal_matrix(rng, 400, 3);
  const Matrix x = central_kalman(model, y, Vector::Zero(2), 3.0);
  for (int t = 200; t < 400; ++t) {
    const Vector prediction = plant.A * x.row(t).transpose();
    const Vector expected = prediction + K * (y.row(t).transpose() - C * prediction);
    CHECK((x.row(t + 1).transpose() - expected).norm() < 1e-11);
  }
}

TEST_CASE("missing measurements are predicted over, what does not fit is refused") {
  const Plant plant;
  const Model model = plant.model();
  Matrix y = Matrix::Constant(3, 3, kNaN);
  y(1, 0) = kInfinity;
  const Matrix x = central_kalman(model, y, Vector{{1.0, 2.0}}, 1.0);
  CHECK((x.row(3).transpose() - plant.A * plant.A * plant.A * Vector{{1.0, 2.0}}).norm() < 1e-14);
  const auto says = [&](const Model& m, const Matrix& records, const Vector& x0, double variance,
                        const char* words) {
    CHECK_THROWS_WITH_AS(central_kalman(m, records, x0, variance), doctest::Contains(words), InvalidInput);
  };
  says(model, Matrix::Zero(3, 2), Vector::Zero(2), 1.0, "measurements: got 2 columns, expected 3");
  says(model, y, Vector::Zero(3), 1.0, "x0: got 3 numbers, expected 2");
  says(model, y, Vector::Zero(2), -1.0, "start_variance: got -1");
  const Model full(plant.A, plant.C, {kNaN, {}, plant.Q, {plant.R[0], Matrix{{1.0, 0.5}, {0.5, 1.0}}}});
  says(full, y, Vector::Zero(2), 1.0, "measurement_covariance[1]: got a full matrix");
}

namespace {

/// Best estimate of the last state by least squares over all states' causes, in long double: no recursion.
Vector batch(const Model& model, const Matrix& y, const Vector& x0, double variance) {
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using WideVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const auto n = model.states();
  const auto T = y.rows();
  const Wide A = model.A().cast<long double>();
  const Wide root = Eigen::LLT<Wide>(Wide(model.noise().process_covariance.cast<long double>())).matrixL();
  const Matrix C = model.stacked();
  std::vector<WideVector> rows;
  std::vector<long double> right;
  Wide map = Wide::Zero(n, n * (T + 1));  // the state at t from x0 - x0hat (in deviations) and unit noises
  map.leftCols(n) = Wide::Identity(n, n) * std::sqrt(static_cast<long double>(variance));
  WideVector mean = x0.cast<long double>();
  for (Eigen::Index t = 0; t < T; ++t) {
    map = A * map;
    mean = A * mean;
    map.middleCols(n * (t + 1), n) = root;
    for (int i = 0; i < model.agents(); ++i)
      for (int k = 0; k < model.outputs(i); ++k) {
        const int row = model.offset(i) + k;
        if (!std::isfinite(y(t, row))) continue;
        const long double deviation = std::sqrt(static_cast<long double>(
            model.noise().measurement_covariance[static_cast<std::size_t>(i)](k, k)));
        const WideVector c = C.row(row).cast<long double>().transpose();
        rows.emplace_back(map.transpose() * c / deviation);
        right.push_back((static_cast<long double>(y(t, row)) - c.dot(mean)) / deviation);
      }
  }
  const auto unknown = map.cols();
  Wide J(static_cast<Eigen::Index>(rows.size()) + unknown, unknown);
  WideVector b = WideVector::Zero(J.rows());
  for (std::size_t k = 0; k < rows.size(); ++k) {  // large rows first
    J.row(static_cast<Eigen::Index>(k)) = rows[k].transpose();
    b(static_cast<Eigen::Index>(k)) = right[k];
  }
  J.bottomRows(unknown) = Wide::Identity(unknown, unknown);
  const WideVector z = Eigen::ColPivHouseholderQR<Wide>(J).solve(b);
  return (mean + map * z).cast<double>();
}

}  // namespace

TEST_CASE("large start variances and nearly parallel precise sensors keep nine digits") {
  test::Rng rng(7);
  for (const double angle : {1e-1, 1e-3, 1e-4})
    for (int T = 1; T <= 6; ++T) {
      const Model model(Matrix{{1.0, 0.1}, {0.0, 1.0}},
                        {Matrix{{1.0, 0.0}}, Matrix{{std::cos(angle), std::sin(angle)}}},
                        {kNaN, {}, Matrix{{1e-6, 0.0}, {0.0, 1e-6}}, {Matrix{{1e-4}}, Matrix{{1e-4}}}});
      Matrix y = 100.0 * test::normal_matrix(rng, T, 2);
      if (T > 3) y(2, 1) = kNaN;
      const Vector expected = batch(model, y, Vector::Zero(2), 1e10);
      const Matrix x = central_kalman(model, y, Vector::Zero(2), 1e10);
      CAPTURE(angle);
      CAPTURE(T);
      CHECK((x.row(T).transpose() - expected).norm() <= 1e-9 * expected.norm());
    }
}

TEST_CASE("random plants, gaps included, agree with batch least squares") {
  test::Rng rng(8);
  for (int k = 0; k < 60; ++k) {
    const int n = test::whole(rng, 1, 4);
    const int N = test::whole(rng, 1, 4);
    const int T = test::whole(rng, 1, 5);
    std::vector<Matrix> C;
    std::vector<Matrix> R;
    for (int i = 0; i < N; ++i) {
      C.push_back(test::normal_matrix(rng, test::whole(rng, 0, 2), n));
      R.emplace_back(Vector::NullaryExpr(C.back().rows(), [&] {
                       return std::pow(10.0, test::uniform(rng, -4, 1));
                     }).asDiagonal());
    }
    const Model model(test::normal_matrix(rng, n, n), C, {kNaN, {}, Matrix::Identity(n, n), R});
    Matrix y = test::normal_matrix(rng, T, model.total_outputs());
    for (double& value : y.reshaped())
      if (test::whole(rng, 0, 3) == 0) value = kNaN;
    const Vector x0 = test::normal_matrix(rng, n, 1);
    const double p0 = std::pow(10.0, test::whole(rng, -3, 10));
    const Vector expected = batch(model, y, x0, p0);
    CAPTURE(k);
    CHECK((central_kalman(model, y, x0, p0).row(T).transpose() - expected).norm() <=
          1e-9 * (1.0 + expected.norm()));
  }
}

TEST_CASE("outputs without noise and states without variance are followed exactly") {
  const Model model(Matrix{{1.0, 0.0}, {0.0, 1.0}}, {Matrix{{1.0, 0.0}}, Matrix{{1.0, 0.0}}},
                    {kNaN, {}, Matrix::Zero(2, 2), {Matrix{{0.0}}, Matrix{{1.0}}}});
  const Matrix y{{3.0, 5.0}, {3.0, 7.0}};
  const Matrix x = central_kalman(model, y, Vector{{1.0, 2.0}}, 4.0);
  CHECK((x.row(2).transpose() - Vector{{3.0, 2.0}}).norm() < 1e-12);
  const Matrix still = central_kalman(model, y, Vector{{1.0, 2.0}}, 0.0);  // known for sure: nothing moves it
  CHECK((still.row(2).transpose() - Vector{{1.0, 2.0}}).norm() == 0.0);
  CHECK_THROWS_AS(central_kalman(model, y, Vector{{1.0, 2.0}}, kInfinity), InvalidInput);
}

TEST_CASE("a Huber filter: a wild sensor pulls by k deviations, no more") {
  // One state, prior N(0, p): x minimises x^2 / 2p + rho((y - x) / sigma), so x = p k / sigma beyond the
  // corner.
  const Model model(Matrix{{1.0}}, {Matrix{{1.0}}}, {kNaN, {}, Matrix{{0.5}}, {Matrix{{0.25}}}});
  const double p = 2.0 + 0.5;
  const double k = 1.345;
  const Screen screen{0.0, k};
  for (const double y : {5.0, 100.0, -1e6, 1e100})
    CHECK(
        central_kalman(model, Matrix{{y}}, Vector::Zero(1), 2.0, screen)(1, 0) ==
        doctest::Approx(std::copysign(std::min(p * k / 0.5, p / (p + 0.25) * std::abs(y)), y)).epsilon(1e-9));
  test::Rng rng(3);
  const Matrix quiet = 0.1 * test::normal_matrix(rng, 50, 1);  // residuals stay small
  CHECK(central_kalman(model, quiet, Vector::Zero(1), 2.0, screen) ==
        central_kalman(model, quiet, Vector::Zero(1), 2.0));
}

TEST_CASE("a gated filter leaves out what is beyond its level, and only that") {
  const Model model(Matrix{{1.0}}, {Matrix{{1.0}}, Matrix{{1.0}}},
                    {kNaN, {}, Matrix{{0.5}}, {Matrix{{0.25}}, Matrix{{0.25}}}});
  const double limit = 2.5758293035489004 * std::sqrt(2.0 + 0.5 + 0.25);  // 1 % of a Gaussian is beyond
  const Screen screen{0.01, kInfinity};
  const auto at = [&](double a, double b, const Screen& with) {
    return central_kalman(model, Matrix{{a, b}}, Vector::Zero(1), 2.0, with)(1, 0);
  };
  CHECK(at(limit * 0.999, 0.3, screen) == at(limit * 0.999, 0.3, {}));
  CHECK(at(limit * 1.001, 0.3, screen) == at(kNaN, 0.3, {}));
  CHECK(at(-1e200, 1e200, screen) == 0.0);
}

TEST_CASE("screens that mean nothing are refused") {
  const Model model = Plant().model();
  const auto says = [&](const Screen& screen, const char* words) {
    CHECK_THROWS_WITH_AS(central_kalman(model, Matrix::Zero(1, 3), Vector::Zero(2), 1.0, screen),
                         doctest::Contains(words), InvalidInput);
  };
  says({1.0, kInfinity}, "gate: got 1");
  says({-0.1, kInfinity}, "gate: got -0.1");
  says({kNaN, kInfinity}, "gate: got nan");
  says({0.0, 0.0}, "huber: got 0");
  says({0.0, kNaN}, "huber: got nan");
  says({0.1, 1.0}, "expected one of them");
}
