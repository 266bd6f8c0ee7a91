// SPDX-License-Identifier: Apache-2.0
// The exact step against reference solutions, and its optimality conditions on random problems.
#include "garrison/filters/rdkf/step.hpp"

#include <doctest/doctest.h>

#include <iostream>

#include "../../cases.hpp"
#include "../../random_system.hpp"
#include "garrison/filters/rdkf/box_step.hpp"
#include "garrison/filters/rdkf/fresh_step.hpp"
#include "garrison/filters/rdkf/ipopt_step.hpp"

using namespace garrison;
using namespace garrison::cases;
using namespace garrison::rdkf;
using namespace garrison::test;

namespace {

struct Solution {
  Vector x;
  Vector u;  // V'u
  Step step;
};

Solution solved(const StepFactors& f, double lambda, const Vector& y, const Vector& x0,
                double smoothing = 0.0) {
  Vector room = Vector::Zero(static_cast<Eigen::Index>(f.room()));
  Solution s{x0, {}, {}};
  s.step = solve(f, {lambda, smoothing}, y.data(), s.x.data(), room.data());
  s.u = room.head(f.outputs());
  return s;
}

}  // namespace

TEST_CASE("single problems of every kind have the reference solution") {
  const Json file = load_case("rdkf/dutta_rdkf_single_steps.json");
  REQUIRE(file["inputs"].size() > 20);
  for (std::size_t k = 0; k < file["inputs"].size(); ++k) {
    const Json& in = file["inputs"][k];
    const Json& out = file["expected"][k];
    CAPTURE(in["tag"].get<std::string>());
    const Matrix Q = matrix(in["Q"]);
    const Vector x0 = vector(in["x0"]);
    const Vector b = vector(in["b"]);
    const Matrix M = matrix(in["M"], x0.size());
    const double lambda = number(in["lam"]);
    const Matrix root = Matrix::Identity(b.size(), b.size());
    const Solution norm = solved(step_factors(root, M, Q, Penalty::norm), lambda, b, x0);
    const Solution huber = solved(step_factors(root, M, Q, Penalty::huber), lambda, b, x0);
    CHECK(agree_entries(norm.x, vector(out["x"])));
    CHECK(agree_entries(huber.x, vector(out["x_huber"])));
    for (const Penalty penalty : {Penalty::norm, Penalty::huber}) {
      Vector x = x0;
      solve_fresh(Q, M, penalty, {lambda, 0.0}, b.data(), x.data());
      CHECK(agree_entries(x, vector(out[penalty == Penalty::norm ? "x" : "x_huber"])));
    }
    const StepFactors f = step_factors(root, M, Q, Penalty::norm);
    CHECK(agree_entries(solved(f, lambda, b, x0, number(in["eps"])).x, vector(out["x_smoothed"])));
    const BoxFactors box = box_factors(root, M, Q);
    Vector x = x0;
    Vector room = Vector::Zero(static_cast<Eigen::Index>(box.room()));
    solve_box(box, lambda, b.data(), x.data(), room.data());
    CHECK(agree_entries(x, vector(out["x_l1"]), 1e-8));
    const double mu = number(out["mu"]);
    const double size = b.norm() + (M * x0).norm();
    if (std::isinf(mu)) {
      CHECK(std::isinf(norm.step.mu));
    } else {
      CHECK(std::abs(norm.step.mu - mu) <= 1e-9 * mu + 1e-12 * size / lambda);
    }
    const double residual = (b - M * norm.x).norm();
    const double expected = number(out["residual_norm"]);
    CHECK(std::abs(residual - expected) <= 1e-9 * expected + 1e-12 * size);
  }
}

TEST_CASE("3000 random problems over 12 decades fulfil the optimality conditions") {
  Rng rng(20261124);
  double worst_residual = 0.0;
  double worst_gradient = 0.0;
  double worst_fresh = 0.0;
  int most = 0;
  long total = 0;
  int saturated = 0;
  for (int instance = 0; instance < 3000; ++instance) {
    const int n = whole(rng, 1, 12);
    const int q = whole(rng, 1, 15);  // also q > n
    Matrix M = normal_matrix(rng, q, n);
    const int kind = instance % 6;
    if (kind == 1 && q > 1) M.row(q - 1) = M.row(0);  // dependent rows
    if (kind == 2) M.row(0).setZero();
    const Matrix root = normal_matrix(rng, n, n);
    const Matrix Q = root * root.transpose() + 0.1 * Matrix::Identity(n, n);
    const Vector x0 = normal_matrix(rng, n, 1);
    const double size = std::pow(10.0, uniform(rng, -6, 6));
    Vector b = M * x0 + size * normal_matrix(rng, q, 1);
    if (kind == 3) b = M * (x0 + size * normal_matrix(rng, n, 1));  // residual 0 is within reach
    if (kind == 4) b = M * x0;                                      // zero residual at once
    double lambda = std::pow(10.0, uniform(rng, -6, 6));
    const Penalty penalty = instance % 2 == 0 ? Penalty::norm : Penalty::huber;
    const StepFactors f = step_factors(Matrix::Identity(q, q), M, Q, penalty);
    if (kind == 5) {  // at the edge between saturated and not
      const Vector rho = f.R.dense() * (b - M * x0);
      const Eigen::Map<const Vector> d(f.d.data(), q);
      const double edge = (rho.array() / (d.array() + 1e-300)).matrix().norm();
      if (std::isfinite(edge) && edge < 1e200) lambda = edge * (1.0 + uniform(rng, -1e-9, 1e-9));
    }
    const Solution s = solved(f, lambda, b, x0);
    CAPTURE(instance);
    const Matrix K = f.K.dense();
    CHECK((K.transpose() * K - M.transpose() * M).norm() <= 1e-12 * M.squaredNorm());
    // Residual plus the penalty's own part: V'(b - M x) = mu u (+ u/2 for huber).
    const Vector residual = f.R.dense() * b - K * s.x;
    const double own = penalty == Penalty::huber ? 0.5 : 0.0;
    const double scale = b.norm() + (M * x0).norm() + 1e-300;
    worst_residual = std::max(worst_residual, (residual - (s.step.mu + own) * s.u).norm() / scale);
    const Vector push = K.transpose() * s.u;
    const Vector gradient = 2.0 * (Q * (s.x - x0)) - push;
    const double weight = push.norm() + 2.0 * Q.norm() * (s.x.norm() + x0.norm());
    worst_gradient = std::max(worst_gradient, gradient.norm() / weight);
    CHECK(s.u.norm() <= lambda * (1.0 + 1e-12));
    if (s.step.mu > 1e-9) CHECK(s.u.norm() >= lambda * (1.0 - 1e-12));
    Vector x = x0;
    const Step fresh = solve_fresh(Q, M, penalty, {lambda, 0.0}, b.data(), x.data());
    // One minimiser: 2 Q (x - s.x) = M'(u - s.u), and mu times either u is the same residual within rounding.
    worst_fresh = std::max(worst_fresh, (2.0 * (Q * (x - s.x))).norm() / (weight + 1e-300));
    CHECK(std::abs(fresh.mu - s.step.mu) * s.u.norm() <= 1e-12 * scale + 1e-9 * s.step.mu * s.u.norm());
    most = std::max(most, s.step.iterations);
    total += s.step.iterations;
    saturated += s.step.mu > 0.0 ? 1 : 0;
  }
  std::cout << "rdkf step: 3000 problems from seed 20261124, " << saturated
            << " saturated, optimality residual " << worst_residual << " and " << worst_gradient
            << ", iterations at most " << most << ", mean "
            << static_cast<double>(total) / std::max(saturated, 1)
            << "; without factors made before: distance " << worst_fresh << "\n";
  CHECK(worst_fresh <= 1e-12);
  CHECK(worst_residual <= 1e-12);
  CHECK(worst_gradient <= 1e-12);
}

TEST_CASE("huge and degenerate data stay finite") {
  const Matrix M = Matrix::Identity(2, 2);
  const StepFactors f = step_factors(Matrix::Identity(2, 2), M, Matrix::Identity(2, 2), Penalty::norm);
  const Vector x0 = Vector::Zero(2);
  for (const double v : {0.0, 1e-300, 1e-160, 1e154, 1e200, 1e300}) {
    const Solution s = solved(f, 1.0, Vector{{v, -v}}, x0);
    CAPTURE(v);
    CHECK(s.x.allFinite());
    CHECK(s.x.norm() <= 0.5 * (1.0 + 1e-12));  // lambda / 2 |Q^-1 M'|
  }
  CHECK(solved(f, 0.0, Vector{{3.0, 4.0}}, x0).x == x0);
  const StepFactors nothing = step_factors(Matrix(0, 0), Matrix(0, 2), Matrix::Identity(2, 2), Penalty::norm);
  CHECK(solved(nothing, 1.0, Vector(0), x0).x == x0);
  CHECK_THROWS_WITH_AS(step_factors(M, M, -M, Penalty::norm), doctest::Contains("not positive definite"),
                       InvalidInput);
  for (const double v : {0.0, 1e-300, 1e-160, 1e154, 1e200, 1e300}) {
    Vector x = x0;
    solve_fresh(Matrix::Identity(2, 2), M, Penalty::norm, {1.0, 0.0}, Vector{{v, -v}}.data(), x.data());
    CAPTURE(v);
    CHECK(x.norm() <= 0.5 * (1.0 + 1e-12));
  }
  Vector x = x0;
  CHECK_THROWS_WITH_AS(solve_fresh(-M, M, Penalty::norm, {1.0, 0.0}, x0.data(), x.data()),
                       doctest::Contains("not positive definite"), InvalidInput);
  CHECK(std::isinf(solve_fresh(M, M, Penalty::norm, {0.0, 0.0}, x0.data(), x.data()).mu));
  CHECK(x == x0);
  solve_fresh(M, Matrix(0, 2), Penalty::norm, {1.0, 0.0}, x0.data(), x.data());
  CHECK(x == x0);
}

TEST_CASE("elementwise penalty: optimality of 500 random problems, with dependent rows and q > n") {
  Rng rng(20261125);
  double worst = 0.0;
  int most = 0;
  for (int instance = 0; instance < 500; ++instance) {
    const int n = whole(rng, 1, 8);
    const int q = whole(rng, 1, 12);
    Matrix M = normal_matrix(rng, q, n);
    if (instance % 4 == 1 && q > 1) M.row(q - 1) = M.row(0);
    if (instance % 4 == 2) M.row(0).setZero();
    const Matrix root = normal_matrix(rng, n, n);
    const Matrix Q = root * root.transpose() + 0.1 * Matrix::Identity(n, n);
    const Vector x0 = normal_matrix(rng, n, 1);
    Vector b = M * x0 + std::pow(10.0, uniform(rng, -3, 3)) * normal_matrix(rng, q, 1);
    if (instance % 5 == 0) b = M * normal_matrix(rng, n, 1);
    const double lambda = std::pow(10.0, uniform(rng, -3, 3));
    const BoxFactors f = box_factors(Matrix::Identity(q, q), M, Q);
    Vector x = x0;
    Vector room = Vector::Zero(static_cast<Eigen::Index>(f.room()));
    const Step step = solve_box(f, lambda, b.data(), x.data(), room.data());
    const Vector u = room.head(q);
    const Vector r = b - M * x;
    const double size = b.norm() + (M * x0).norm() + lambda * f.H.norm();
    CAPTURE(instance);
    CHECK(u.cwiseAbs().maxCoeff() <= lambda);
    const Vector gradient = 2.0 * Q * (x - x0) - M.transpose() * u;
    worst = std::max(worst, gradient.norm() / (lambda * M.norm() + 2.0 * Q.norm() * (x.norm() + x0.norm())));
    for (int i = 0; i < q; ++i) {  // complementarity
      const double wrong = std::abs(u(i)) < lambda ? std::abs(r(i)) : u(i) > 0 ? -r(i) : r(i);
      worst = std::max(worst, wrong / size);
    }
    most = std::max(most, step.iterations);
  }
  std::cout << "rdkf elementwise step: 500 problems from seed 20261125, optimality " << worst
            << ", active-set iterations at most " << most << "\n";
  CHECK(worst <= 1e-11);
}

TEST_CASE("Ipopt agrees within what its smoothing allows, or is refused with what to do") {
  if (!ipopt_available()) {
    CHECK_THROWS_WITH_AS(require_ipopt(), doctest::Contains("coinor-libipopt-dev"), InvalidInput);
    return;
  }
  Rng rng(7);
  double worst = 0.0;
  for (int instance = 0; instance < 60; ++instance) {
    const int n = whole(rng, 1, 10);
    const int q = whole(rng, 1, 8);
    const Matrix M = normal_matrix(rng, q, n);
    const Matrix root = normal_matrix(rng, n, n);
    const Matrix Q = root * root.transpose() + 0.1 * Matrix::Identity(n, n);
    const Vector x0 = normal_matrix(rng, n, 1);
    const Vector b = M * x0 + uniform(rng, 0.1, 20.0) * normal_matrix(rng, q, 1);
    const double lambda = uniform(rng, 0.1, 5.0);
    const Solution exact = solved(step_factors(Matrix::Identity(q, q), M, Q, Penalty::norm), lambda, b, x0);
    Vector x = x0;
    const Step step = solve_ipopt(Q, M, b, {lambda, 0.0}, x.data());
    CAPTURE(instance);
    CHECK(step.iterations >= 0);
    worst = std::max(worst, (x - exact.x).norm() / (1.0 + exact.x.norm()));
  }
  std::cout << "rdkf step: 60 problems from seed 7, largest distance of Ipopt's solution " << worst << "\n";
  CHECK(worst <= 1e-3);
}
