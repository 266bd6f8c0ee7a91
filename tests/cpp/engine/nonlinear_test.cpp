// SPDX-License-Identifier: Apache-2.0
// Plants by functions: functors of a whole network, and what a linear one has to give.
#include <doctest/doctest.h>

#include <cstring>

#include "../random_system.hpp"
#include "garrison/garrison.hpp"

using namespace garrison;

namespace {

/// A linear plant as functions, summed in the order in which filters sum.
Nonlinear as_functions(const Model& model) {
  const auto product = [](const Matrix& A, const Vector& x) {
    Vector sum = A.col(0) * x(0);
    for (Eigen::Index k = 1; k < x.size(); ++k)
      for (Eigen::Index i = 0; i < sum.size(); ++i) sum(i) += A(i, k) * x(k);
    return sum;
  };
  Nonlinear plant;
  plant.f = [model, product](const Matrix& X, const Vector& u, int) {
    Matrix next(X.rows(), X.cols());
    for (Eigen::Index k = 0; k < X.cols(); ++k) {
      next.col(k) = product(model.A(), X.col(k));
      if (u.size() > 0) next.col(k) += model.B() * u;
    }
    return next;
  };
  plant.h = [model, product](const Matrix& X, int) {
    Vector y(model.total_outputs());
    for (int i = 0; i < model.agents(); ++i)
      if (model.outputs(i) > 0) y.segment(model.offset(i), model.outputs(i)) = product(model.C(i), X.col(i));
    return y;
  };
  plant.h_jacobian = [model](const Matrix&, int) { return model.stacked(); };
  return plant;
}

bool same(const Bulk<double>& a, const Bulk<double>& b) {
  return a.size() == b.size() && !a.empty() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// A pendulum of length 1 in steps of 0.05, seen by agents that know its height, its distance to the side, or
/// nothing.
struct Swing {
  Matrix operator()(const Matrix& X, const Vector& u, int) const {
    Matrix next = X;
    next.row(0) += 0.05 * X.row(1);
    next.row(1) -= 0.05 * 9.81 * X.row(0).array().sin().matrix();
    if (u.size() > 0) next.row(1).array() += u(0);
    return next;
  }
};
struct Bob {
  Vector operator()(const Matrix& X, int) const {
    Vector y(4);
    y << std::sin(X(0, 0)), std::sin(X(0, 1)), 0.5 * X(1, 1), 1.0 - std::cos(X(0, 3));
    return y;
  }
};
struct BobRows {
  Matrix operator()(const Matrix& X, int) const {
    return Matrix{{std::cos(X(0, 0)), 0.0}, {std::cos(X(0, 1)), 0.0}, {0.0, 0.5}, {std::sin(X(0, 3)), 0.0}};
  }
};

/// Four agents with 1, 2, 0 and 1 outputs; what C is nobody asks.
Model pendulum_model() {
  return {Matrix::Identity(2, 2),
          {Matrix::Zero(1, 2), Matrix::Zero(2, 2), Matrix(0, 2), Matrix::Zero(1, 2)},
          {0.001, Vector::Constant(4, 0.01)}};
}

RunOptions swinging(std::function<Matrix(const Matrix&, int)> rows) {
  RunOptions o;
  o.nonlinear = std::make_shared<const Nonlinear>(Nonlinear{Swing{}, Bob{}, std::move(rows)});
  o.start = Vector{{0.5, 0.0}};
  o.seed = 5;
  return o;
}

}  // namespace

TEST_CASE("a linear plant by functions gives the bits of the linear run") {
  for (const int n : {2, 3, 9})
    for (const char* name : {"scalar_gain", "saturation"}) {
      CAPTURE(n);
      CAPTURE(name);
      test::Rng rng(static_cast<std::uint64_t>(n));
      const Model model = test::scalar_model(rng, n, 7, 0.98, 0.02, 0.01);
      const Network network = test::connected_network(rng, 7);
      Matrix y = test::normal_matrix(rng, 40, 7);
      y(3, 1) = kNaN;
      y(6, 2) = kInfinity;
      const auto filter = make_filter(name, name[1] == 'a' ? ParamMap{{"threshold", 0.5}} : ParamMap{});
      RunOptions o;
      o.seed = 4;
      o.start = Vector::Ones(n);
      o.attacks = {bias(Schedule(9, {2}), 3.0), stealthy(Schedule(12, {4}), 0.9)};
      for (const double drop : {0.0, 0.2}) {
        o.link.drop = drop;
        o.nonlinear = nullptr;
        const Record linear = replay(model, network, *filter, y, Matrix(), o);
        o.nonlinear = std::make_shared<const Nonlinear>(as_functions(model));
        const Record functions = replay(model, network, *filter, y, Matrix(), o);
        CHECK(same(linear.estimate, functions.estimate));
        CHECK(same(linear.measurements, functions.measurements));
        CHECK(linear.verdict == functions.verdict);
        for (const double bound : functions.bound) CHECK(std::isnan(bound));
      }
    }
}

TEST_CASE("a simulated linear plant by functions, with inputs and trials, is the linear one up to rounding") {
  test::Rng rng(8);
  const Model base = test::scalar_model(rng, 3, 5, 0.95, 0.02, 0.01);
  std::vector<Matrix> C;
  for (int i = 0; i < 5; ++i) C.push_back(base.C(i));
  const Model model(base.A(), C, base.noise(), {}, {}, test::normal_matrix(rng, 3, 1));
  const Network network = test::connected_network(rng, 5);
  const auto filter = make_filter("saturation", {{"threshold", 0.5}});
  const PlantOptions plant{30, Vector::Ones(3), 0.2, "uniform"};
  RunOptions o;
  o.trials = 9;
  o.inputs = test::normal_matrix(rng, 30, 1);
  const Record linear = simulate(model, network, *filter, plant, o);
  o.nonlinear = std::make_shared<const Nonlinear>(as_functions(model));
  o.threads = 1;
  const Record one = simulate(model, network, *filter, plant, o);
  o.threads = 3;
  CHECK(same(one.estimate, simulate(model, network, *filter, plant, o).estimate));
  for (std::size_t k = 0; k < linear.truth.size(); ++k)
    CHECK(std::abs(linear.truth[k] - one.truth[k]) < 1e-12);
  for (std::size_t k = 0; k < linear.estimate.size(); ++k)
    CHECK(std::abs(linear.estimate[k] - one.estimate[k]) < 1e-11);
}

TEST_CASE("a pendulum by functors is followed, and differences are as good as derivatives") {
  const auto filter = make_filter("saturation", {{"threshold", 0.2}, {"rounds", std::int64_t{4}}});
  const PlantOptions plant{200, Vector{{0.8, 0.0}}, 0.0, "uniform"};
  const Network network = Network::ring(4);
  const Record exact = simulate(pendulum_model(), network, *filter, plant, swinging(BobRows{}));
  const Record differences = simulate(pendulum_model(), network, *filter, plant, swinging({}));
  CHECK(exact.truth == differences.truth);
  const std::size_t late = exact.error.size() / 2;
  for (std::size_t k = 0; k < exact.error.size(); ++k) {
    CHECK(std::abs(exact.error[k] - differences.error[k]) < 1e-6);
    if (k > late) CHECK(exact.error[k] < 0.1);
  }
}

TEST_CASE("functions that do not fit are refused, and what they throw passes") {
  const auto filter = make_filter("scalar_gain", {});
  const Network network = Network::ring(4);
  const PlantOptions plant{5, Vector{{0.8, 0.0}}, 0.0, "none"};
  const auto run = [&](Nonlinear functions) {
    RunOptions o;
    o.nonlinear = std::make_shared<const Nonlinear>(std::move(functions));
    simulate(pendulum_model(), network, *filter, plant, o);
  };
  const auto small = [](const Matrix& X, const Vector&, int) { return Matrix(X.topRows(1)); };
  CHECK_THROWS_WITH_AS(run({small, Bob{}}), "f: got 1 x 1 numbers, expected 2 x 1, a column per column of X",
                       InvalidInput);
  const auto few = [](const Matrix&, int) { return Vector(Vector::Zero(3)); };
  CHECK_THROWS_WITH_AS(run({Swing{}, few}), "h: got 3 x 1 numbers, expected 4 x 1, the outputs of all agents",
                       InvalidInput);
  const auto wrong = [](const Matrix&, int) { return Matrix(Matrix::Zero(4, 3)); };
  CHECK_THROWS_WITH_AS(run({Swing{}, Bob{}, wrong}),
                       "h_jacobian: got 4 x 3 numbers, expected 4 x 2, a row per output", InvalidInput);
  const auto late = [](const Matrix& X, int t) {
    return Vector(Bob{}(X, t) * (t == 3 && X(0, 0) != X(0, 1) ? kNaN : 1.0));
  };
  CHECK_THROWS_WITH_AS(run({Swing{}, late, BobRows{}}),
                       doctest::Contains("at time 3, for the estimate of agent 0"), InvalidInput);
  struct Mine {};
  const auto angry = [](const Matrix&, int) -> Vector { throw Mine{}; };
  CHECK_THROWS_AS(run({Swing{}, angry}), Mine);
  CHECK_THROWS_WITH_AS(run({Swing{}, {}}), "nonlinear: got no h, expected both", InvalidInput);
  test::Rng rng(1);
  const Model linear = test::scalar_model(rng, 2, 4, 0.98, 0.02, 0.01);
  RunOptions o;
  o.nonlinear = std::make_shared<const Nonlinear>(as_functions(linear));
  const auto designed = make_filter("partial_sharing", {{"gain", 0.1}});
  CHECK_THROWS_WITH_AS(
      simulate(linear, network, *designed, plant, o),
      doctest::Contains("got a plant by functions, expected a constant plant for partial_sharing"),
      InvalidInput);
}
