// SPDX-License-Identifier: Apache-2.0
// The fixed point of (5): existence, uniqueness, the ordinary Kalman covariance as a special case.
#include "garrison/filters/rdkf/steady_state.hpp"

#include <doctest/doctest.h>

#include "../../cases.hpp"
#include "core/solvers.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::cases;
using namespace garrison::rdkf;
using namespace garrison::test;

TEST_CASE("one agent has the covariance of the ordinary Kalman filter") {
  Rng rng(1);
  for (int instance = 0; instance < 20; ++instance) {
    const int n = whole(rng, 1, 6);
    const Model model = covariance_model(rng, n, 1, uniform(rng, 0.3, 1.3));
    const Setting s = setting(model, Network(1, {}));
    const SteadyState steady = steady_state(s);
    Matrix P = Matrix::Identity(n, n);
    for (int k = 0; k < 3000; ++k) {  // the usual form with a gain, nothing shared with ours
      const Matrix prior = s.A * P * s.A.transpose() + s.Sw[0];
      const Matrix S = s.C[0] * prior * s.C[0].transpose() + s.Sv[0];
      const Matrix gain = prior * s.C[0].transpose() * S.inverse();
      P = (Matrix::Identity(n, n) - gain * s.C[0]) * prior;
    }
    CHECK((P - steady.P[0]).norm() <= 1e-10 * P.norm());
  }
}

TEST_CASE("the limit does not depend on the start, and a warm start takes fewer sweeps") {
  Rng rng(2);
  for (int instance = 0; instance < 20; ++instance) {
    const int n = whole(rng, 1, 5);
    const int N = whole(rng, 2, 6);
    const Setting s = setting(covariance_model(rng, n, N, uniform(rng, 0.3, 1.2)), connected_network(rng, N));
    const SteadyState zero = steady_state(s);
    const SteadyState far =
        steady_state(s, {std::vector<Matrix>(static_cast<std::size_t>(N), 1e4 * Matrix::Identity(n, n))});
    for (std::size_t i = 0; i < zero.P.size(); ++i)
      CHECK((zero.P[i] - far.P[i]).norm() <= 1e-10 * zero.P[i].norm());
    const SteadyState warm = steady_state(s, {zero.P});
    CHECK(warm.sweeps <= zero.sweeps);
    CHECK(warm.change <= 1e-10);
    const std::vector<Matrix> again = riccati_sweep(s, zero.P);
    for (std::size_t i = 0; i < zero.P.size(); ++i)
      CHECK((again[i] - zero.P[i]).norm() <= 1e-11 * zero.P[i].norm());
  }
}

TEST_CASE("iterates and limits of the reference case") {
  const Json file = load_case("rdkf/dutta_rdkf_covariance.json");
  const Json& in = file["inputs"];
  const auto all = [&](const char* key, Eigen::Index columns) {
    std::vector<Matrix> m;
    for (const Json& one : in[key]) m.push_back(matrix(one, columns));
    return m;
  };
  const Matrix A = matrix(in["A"]);
  Noise noise;
  noise.measurement_covariance = all("Sv", 0);
  noise.agent_process_covariance = all("Sw", A.rows());
  std::vector<Edge> edges;
  for (const Json& e : in["edges"]) edges.emplace_back(e[0], e[1]);
  const Model model(A, all("C", A.rows()), noise);
  const Setting s = setting(model, Network(model.agents(), edges));
  const SteadyState steady = steady_state(s);
  std::vector<Matrix> P(s.C.size(), Matrix::Zero(A.rows(), A.rows()));
  for (std::size_t k = 0; k < file["expected"]["iterates_from_zero"].size(); ++k) {
    for (std::size_t i = 0; i < P.size(); ++i)
      CHECK((P[i] - matrix(file["expected"]["iterates_from_zero"][k][i])).norm() <= 1e-9);
    P = riccati_sweep(s, P);
  }
  for (std::size_t i = 0; i < P.size(); ++i)
    CHECK((steady.P[i] - matrix(file["expected"]["P"][i])).norm() <= 1e-9 * steady.P[i].norm());
}

TEST_CASE("detectability: only modes that do not decay must be seen") {
  const Matrix A = Vector{{1.2, 0.5, 0.0}}.asDiagonal();
  CHECK(detectable(A, Matrix{{1.0, 0.0, 0.0}}));
  CHECK_FALSE(detectable(A, Matrix{{0.0, 1.0, 1.0}}));
  CHECK_FALSE(detectable(A, Matrix(0, 3)));
  CHECK(detectable(0.5 * A, Matrix(0, 3)));
  const double c = std::cos(1.0);
  const double d = std::sin(1.0);
  CHECK(detectable(Matrix{{c, d}, {-d, c}}, Matrix{{1.0, 0.0}}));  // complex modes on the circle
  CHECK_FALSE(detectable(Matrix::Identity(2, 2), Matrix{{1.0, 0.0}}));
}
