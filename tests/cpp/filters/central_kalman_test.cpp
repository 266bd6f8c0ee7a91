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
