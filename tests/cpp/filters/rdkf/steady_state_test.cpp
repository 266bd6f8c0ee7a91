// SPDX-License-Identifier: Apache-2.0
// The fixed point of (5): existence, uniqueness, the ordinary Kalman covariance as a special case.
#include "garrison/filters/rdkf/steady_state.hpp"

#include <doctest/doctest.h>

#include "../../cases.hpp"
#include "core/solvers.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/rdkf/analysis.hpp"
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

namespace {

/// Prior covariance of one agent by the structure-preserving doubling algorithm (Chu, Fan, Lin 2005), k steps
/// of which are 2^k sweeps; nothing shared with ours.
Matrix doubled(const Setting& s) {
  using Wide = Eigen::Matrix<long double, Dynamic, Dynamic>;
  const Wide I = Wide::Identity(s.states(), s.states());
  Wide A = s.A.transpose().cast<long double>();
  Wide G = (s.M[0].transpose() * s.M[0]).cast<long double>();
  Wide H = s.Sw[0].cast<long double>();
  for (int k = 0; k < 60; ++k) {
    const Wide W = (I + G * H).inverse();
    const Wide next = A * W * A;
    const Wide G_more = A * W * G * A.transpose();
    const Wide H_more = A.transpose() * H * W * A;
    G += G_more;
    H += H_more;
    A = next;
  }
  return H.cast<double>();
}

Setting alone(const Matrix& A, const Matrix& C, double q) {
  Noise noise;
  noise.process_covariance = q * Matrix::Identity(A.rows(), A.rows());
  noise.measurement_covariance = {Matrix::Identity(C.rows(), C.rows())};
  return setting(Model(A, {C}, noise), Network(1, {}));
}

}  // namespace

TEST_CASE("slow modes: integrators at a small period in any units, and very small process noise") {
  for (const double q : {1.0, 1e-6})
    for (const double period : {1e-2, 1e-3, 1e-5})
      for (const double unit : {1.0, 1e6}) {
        CAPTURE(q);
        CAPTURE(period);
        CAPTURE(unit);
        const Setting s = alone(Matrix{{1.0, period}, {0.0, 1.0}}, Matrix{{unit, 0.0}}, q);
        const Matrix right = doubled(s);
        CHECK((steady_state(s).Pbar[0] - right).norm() <= 1e-8 * right.norm());
      }
  for (const double q : {1e-8, 1e-12, 1e-14}) {
    CAPTURE(q);
    const Setting s = alone(Matrix{{1.0, 0.3}, {0.0, 0.2}}, Matrix{{0.7, 0.4}}, q);
    const Matrix right = doubled(s);
    CHECK((steady_state(s).Pbar[0] - right).norm() <= 1e-6 * right.norm());
  }
}

TEST_CASE("chains of integrators that take more samples than there are sweeps") {
  // Variances of x(t) by doubling with 80 digits.
  const Vector right{{1.62782170507856, 3761.65230828906, 17769.9196031768, 28986.9169923024,
                      17710.6932161599, 3736.16868650233}};
  Matrix A = Matrix::Identity(6, 6);
  A.diagonal(1).setConstant(1e-3);
  const Setting s = alone(A, Matrix{{1.0, 0.0, 0.0, 0.0, 0.0, 0.0}}, 1.0);
  CHECK((steady_state(s).Pbar[0].diagonal() - right).cwiseQuotient(right).cwiseAbs().maxCoeff() < 1e-12);
  A.diagonal(1).setConstant(1e-5);
  CHECK_THROWS_WITH_AS(steady_state(alone(A, Matrix{{1.0, 0.0, 0.0, 0.0, 0.0, 0.0}}, 1.0)),
                       doctest::Contains("take a longer period"), InvalidInput);
}

TEST_CASE("a network of slow modes keeps (5), and more noise never gives less error") {
  Rng rng(9);
  const Model model = covariance_model(rng, 2, 4, 0.9);
  Setting s = setting(model, connected_network(rng, 4));
  s.A = Matrix{{1.0, 1e-3}, {0.0, 1.0}};
  std::vector<Matrix> below;
  for (const double q : {1e-13, 1e-9, 1e-5}) {
    CAPTURE(q);
    for (Matrix& Sw : s.Sw) Sw = q * Matrix::Identity(2, 2);
    const SteadyState steady = steady_state(s);
    for (std::size_t i = 0; i < steady.P.size(); ++i) {
      CHECK(steady.P[i].diagonal().minCoeff() > 0.0);
      if (!below.empty()) CHECK((steady.P[i] - below[i]).diagonal().minCoeff() > 0.0);
    }
    below = steady.P;
    const std::vector<Matrix> again = riccati_sweep(s, steady.P);
    for (std::size_t i = 0; i < again.size(); ++i)
      CHECK((again[i] - steady.P[i]).norm() <= 1e-9 * steady.P[i].norm());
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

TEST_CASE("measurements with hardly any noise leave what they do not show as it is") {
  Rng rng(12);
  for (int instance = 0; instance < 20; ++instance) {
    const int n = whole(rng, 2, 5);
    Matrix A = normal_matrix(rng, n, n);
    A *= uniform(rng, 0.5, 1.2) / Eigen::EigenSolver<Matrix>(A, false).eigenvalues().cwiseAbs().maxCoeff();
    const Matrix C = normal_matrix(rng, 1, n);
    for (const double r : {1e-10, 1e-15, 1e-18, 1e-25, 1e-60, 1e-120}) {
      CAPTURE(instance);
      CAPTURE(r);
      Noise noise;
      noise.process_covariance = 0.3 * Matrix::Identity(n, n);
      noise.measurement_covariance = {Matrix::Constant(1, 1, r)};
      const Setting s = setting(Model(A, {C}, noise), Network(1, {}));
      const SteadyState steady = steady_state(s);
      Matrix P = Matrix::Identity(n, n);
      for (int k = 0; k < 2000; ++k) {  // the form with a gain, which keeps what r is small against
        const Matrix prior = A * P * A.transpose() + s.Sw[0];
        const Matrix gain = prior * C.transpose() / ((C * prior * C.transpose())(0, 0) + r);
        const Matrix rest = Matrix::Identity(n, n) - gain * C;
        P = rest * prior * rest.transpose() + r * gain * gain.transpose();
      }
      CHECK((P - steady.P[0]).norm() <= 1e-9 * P.norm());
      CHECK(constants(s, steady, 0.0, Penalty::norm).rate < 1.0);
    }
  }
}

TEST_CASE("a network whose measurements have hardly any noise follows the plant") {
  Rng rng(13);
  for (int instance = 0; instance < 10; ++instance) {
    CAPTURE(instance);
    const int n = whole(rng, 2, 4);
    const int N = whole(rng, 3, 6);
    const Network network = connected_network(rng, N);
    Model model = scalar_model(rng, n, N, 1.02, 0.1, 0.1);
    PlantOptions plant;
    plant.steps = 400;
    plant.noise = "normal";
    std::vector<double> mean;
    for (const double r : {1e-10, 1e-16, 1e-24}) {
      Noise noise = model.noise();
      for (Matrix& one : noise.measurement_covariance) one.setConstant(r);
      std::vector<Matrix> rows;
      for (int i = 0; i < N; ++i) rows.push_back(model.C(i));
      const Model precise(model.A(), rows, noise);
      const auto run = simulate(precise, network, *make_filter("dkf", {}), plant, {});
      double sum = 0.0;
      for (std::size_t k = run.error.size() / 2; k < run.error.size(); ++k) sum += run.error[k];
      mean.push_back(sum / static_cast<double>(run.error.size() / 2));
    }
    CHECK(mean[0] < 10.0);
    for (const double other : mean) CHECK(other == doctest::Approx(mean[0]).epsilon(1e-3));
  }
}
