// SPDX-License-Identifier: Apache-2.0
// Some outputs of a sensor are missing: the step is that of a sensor without them.
#include <doctest/doctest.h>

#include <numeric>

#include "../../agents_by_hand.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/rdkf/partial_step.hpp"
#include "garrison/filters/rdkf/steady_state.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

std::vector<int> random_rows(Rng& rng, int q) {
  std::vector<int> rows;
  for (int r = 0; r < q; ++r)
    if (uniform(rng, 0, 1) < 0.6) rows.push_back(r);
  if (rows.empty()) rows.push_back(whole(rng, 0, q - 1));
  return rows;
}
std::vector<char> flags(const std::vector<int>& rows, int q) {
  std::vector<char> present(static_cast<std::size_t>(q), 0);
  for (const int r : rows) present[static_cast<std::size_t>(r)] = 1;
  return present;
}
Matrix inverse_root(const Matrix& S) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(S).operatorInverseSqrt();
}

/// What (8) costs at x for each penalty, from the present rows of every sensor, by its formula.
double cost(const std::string& penalty, double lambda, const rdkf::Setting& s, const Matrix& Q,
            const Vector& x0, const Matrix& y, const Model& model, int i, const Vector& x) {
  double sum = (x - x0).dot(Q * (x - x0));
  const auto own = std::vector<int>{i};
  for (const int j : penalty == "group" ? s.neighbours[static_cast<std::size_t>(i)] : own) {
    const auto k = static_cast<std::size_t>(j);
    std::vector<int> rows;
    for (int r = 0; r < model.outputs(j); ++r)
      if (std::abs(y(0, model.offset(j) + r)) < kHuge) rows.push_back(r);
    if (rows.empty()) continue;
    Vector measured(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r)
      measured(static_cast<Eigen::Index>(r)) = y(0, model.offset(j) + rows[r]);
    const Vector residual = inverse_root(s.Sv[k](rows, rows)) * (measured - s.C[k](rows, Eigen::all) * x);
    const double length = residual.norm();
    sum += penalty == "l1"        ? lambda * residual.lpNorm<1>()
           : penalty != "huber"   ? lambda * length
           : length <= lambda / 2 ? length * length
                                  : lambda * length - lambda * lambda / 4;
  }
  return sum;
}

}  // namespace

TEST_CASE("factors without the missing rows are those of a sensor that never had them") {
  Rng rng(31);
  for (int instance = 0; instance < 300; ++instance) {
    const int n = whole(rng, 1, 6);
    const int q = whole(rng, 2, 7);
    rdkf::SensorRows sensor{definite(rng, q, 0.5), normal_matrix(rng, q, n)};
    if (instance % 5 == 0) sensor.C.row(1) = sensor.C.row(0);
    const Matrix Q = definite(rng, n, 2.0);
    const Matrix L = Eigen::LLT<Matrix>(Q).matrixL();
    const auto penalty = instance % 2 == 0 ? rdkf::Penalty::norm : rdkf::Penalty::huber;
    rdkf::PartialStep step;
    rdkf::PartialStep box;
    step.resize(sensor, false);
    box.resize(sensor, true);
    for (int repeat = 0; repeat < 3; ++repeat) {  // the room is used again
      const auto rows = random_rows(rng, q);
      const auto present = flags(rows, q);
      const Matrix root = inverse_root(sensor.S(rows, rows));
      const Matrix C = sensor.C(rows, Eigen::all);
      Vector y = 3.0 * normal_matrix(rng, q, 1);
      for (int r = 0; r < q; ++r)
        if (present[static_cast<std::size_t>(r)] == 0) y(r) = 0.0;
      const Vector few = y(rows);
      const Vector x0 = normal_matrix(rng, n, 1);
      const double lambda = std::exp(uniform(rng, -3.0, 2.0));
      const auto solved = [&](const rdkf::StepFactors& f, const Vector& measured) {
        Vector x = x0;
        Aligned<double> room(f.room());
        rdkf::solve(f, {lambda, 0.0}, measured.data(), x.data(), room.data());
        return x;
      };
      const auto boxed = [&](const rdkf::BoxFactors& f, const Vector& measured) {
        Vector x = x0;
        std::vector<double> room(f.room());
        rdkf::solve_box(f, lambda, measured.data(), x.data(), room.data());
        return x;
      };
      const Vector full = solved(step.step(sensor, L, penalty, present.data()), y);
      const Vector right = solved(rdkf::step_factors(root, C, Q, penalty), few);
      CHECK((full - right).norm() <= 1e-9 * (1.0 + right.norm()));
      const Vector full1 = boxed(box.box(sensor, L, present.data()), y);
      const Vector right1 = boxed(rdkf::box_factors(root, C, Q), few);
      CHECK((full1 - right1).norm() <= 1e-7 * (1.0 + right1.norm()));
    }
  }
}

TEST_CASE("an agent that misses outputs minimises the cost of those that are there, with every penalty") {
  Rng rng(32);
  for (const std::string penalty : {"norm", "huber", "l1", "group"})
    for (int instance = 0; instance < 12; ++instance) {
      CAPTURE(penalty);
      const int n = whole(rng, 1, 9);
      const int N = whole(rng, 1, 4);
      const Model model = covariance_model(rng, n, N, 0.9);
      const Network network = connected_network(rng, N);
      const double lambda = std::exp(uniform(rng, -1.0, 2.0));
      const auto s = rdkf::setting(model, network);
      const auto steady = rdkf::steady_state(s);
      RunOptions o;
      o.start = normal_matrix(rng, n, N);
      Matrix y = 3.0 * normal_matrix(rng, 1, model.total_outputs());
      const double nothing[] = {kNaN, kInfinity, -1e160};
      for (Eigen::Index r = 0; r < y.cols(); ++r)
        if (uniform(rng, 0, 1) < 0.4) y(0, r) = nothing[whole(rng, 0, 2)];
      const auto filter = make_filter("rdkf", {{"weight", lambda}, {"penalty", penalty}});
      const Record record = replay(model, network, *filter, y, Matrix(), o);
      for (int i = 0; i < N; ++i) {
        Vector sum = Vector::Zero(n);
        for (const int j : s.neighbours[static_cast<std::size_t>(i)])
          sum += Eigen::LLT<Matrix>(steady.Pbar[static_cast<std::size_t>(j)]).solve(s.A * o.start.col(j));
        const Matrix& Q = steady.Q[static_cast<std::size_t>(i)];
        const auto heard = static_cast<double>(s.neighbours[static_cast<std::size_t>(i)].size());
        const Vector x0 = Eigen::LLT<Matrix>(Q).solve(sum) / heard;
        const Vector x = Eigen::Map<const Vector>(record.estimate.data() + (N + i) * n, n);
        const double least = cost(penalty, lambda, s, Q, x0, y, model, i, x);
        for (int k = 0; k < 60; ++k) {
          const Vector to = x + std::pow(10.0, -uniform(rng, 0, 4)) * normal_matrix(rng, n, 1);
          CHECK(cost(penalty, lambda, s, Q, x0, y, model, i, to) >= least - 1e-9 * (1.0 + least));
        }
      }
    }
}

TEST_CASE("engine and agents that are driven by bytes agree on missing outputs, bit for bit") {
  Rng rng(33);
  for (const std::string penalty : {"norm", "huber", "l1", "group"}) {
    const int n = 3;
    const int N = 4;
    const Model model = covariance_model(rng, n, N, 0.9);
    const Network network = connected_network(rng, N);
    const auto filter = make_filter("rdkf", {{"weight", 1.0}, {"penalty", penalty}});
    Matrix y = normal_matrix(rng, 30, model.total_outputs());
    for (Eigen::Index t = 0; t < y.rows(); ++t)
      for (Eigen::Index r = 0; r < y.cols(); ++r)
        if (uniform(rng, 0, 1) < 0.3) y(t, r) = kNaN;
    const Record record = replay(model, network, *filter, y, Matrix(), {});
    const auto prepared = filter->prepare(model, network);
    AgentsByHand agents(*prepared, network);
    std::vector<double> estimates(static_cast<std::size_t>(N * n), 0.0);
    for (int t = 1; t <= 30; ++t) {
      agents.step(t, [&](int i) -> Vector {
        return y.row(t - 1).segment(model.offset(i), model.outputs(i)).transpose();
      });
      agents.append_estimates(estimates);
    }
    CAPTURE(penalty);
    CHECK(std::equal(estimates.begin(), estimates.end(), record.estimate.begin(), record.estimate.end()));
  }
}

TEST_CASE("an output that never comes costs what it is worth, and no more") {
  // One position sensor and one speed sensor of a moving target at one agent; the speed is always missing.
  Matrix A(2, 2);
  A << 1.0, 0.1, 0.0, 1.0;
  Noise noise;
  noise.process_covariance = 0.01 * Matrix::Identity(2, 2);
  noise.measurement_covariance = {0.25 * Matrix::Identity(2, 2)};
  const Model model(A, {Matrix::Identity(2, 2)}, noise);
  const Network network(1, {});
  Rng rng(34);
  const int steps = 400;
  Matrix x = Matrix::Zero(steps + 1, 2);
  Matrix y(steps, 2);
  for (int t = 1; t <= steps; ++t) {
    x.row(t) = (A * x.row(t - 1).transpose() + 0.1 * normal_matrix(rng, 2, 1)).transpose();
    y(t - 1, 0) = x(t, 0) + 0.5 * normal_matrix(rng, 1, 1)(0, 0);
    y(t - 1, 1) = kNaN;
  }
  Matrix none = y;
  none.col(0).setConstant(kNaN);
  for (const char* name : {"dkf", "rdkf"}) {
    const auto filter = make_filter(name, {});
    const auto error = [&](const Matrix& measured) {
      const Record r = replay(model, network, *filter, measured, x, {});
      return std::accumulate(r.error.begin(), r.error.end(), 0.0) / steps;
    };
    CHECK(error(y) < 0.4 * error(none));
  }
}
