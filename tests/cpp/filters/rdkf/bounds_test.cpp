// SPDX-License-Identifier: Apache-2.0
// Searches for a violation of every bound that is printed or reported.
#include <doctest/doctest.h>

#include <iostream>

#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/rdkf/analysis.hpp"
#include "garrison/filters/rdkf/filter.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

const std::vector<std::string> kPenalties{"norm", "huber", "l1", "group"};

rdkf::Penalty named(const std::string& name) {
  return name == "huber"   ? rdkf::Penalty::huber
         : name == "l1"    ? rdkf::Penalty::l1
         : name == "group" ? rdkf::Penalty::group
                           : rdkf::Penalty::norm;
}

/// Estimates n x N after one step from `x0` with measurements y.
Matrix one_step(Runner& runner, const Model& model, const Matrix& x0, const Vector& y) {
  runner.reset(x0, nullptr);
  runner.step(1, y.data());
  Matrix x(model.states(), model.agents());
  Frame frame;
  frame.estimate = x.data();
  runner.read(frame);
  return x;
}

}  // namespace

TEST_CASE("no measurement moves an estimate farther than (10), 2400 instances with attacks up to 1e12") {
  Rng rng(31);
  double worst = 0.0;
  for (int instance = 0; instance < 400; ++instance) {
    const int n = whole(rng, 1, 5);
    const int N = whole(rng, 1, 4);
    const Model model = covariance_model(rng, n, N, uniform(rng, 0.2, 1.3));
    const Network network = connected_network(rng, N);
    const auto& penalty = kPenalties[static_cast<std::size_t>(instance) % 4];
    const double lambda = std::pow(10.0, uniform(rng, -2, 2));
    const auto s = rdkf::setting(model, network);
    const auto constants = rdkf::constants(s, rdkf::steady_state(s), lambda, named(penalty));
    const auto runner =
        make_filter("rdkf", {{"weight", lambda}, {"penalty", penalty}})->prepare(model, network)->runner(1);
    const Matrix x0 = normal_matrix(rng, n, N);
    const Vector none = Vector::Constant(model.total_outputs(), kNaN);
    const Matrix prediction = one_step(*runner, model, x0, none);
    Matrix before = prediction;
    for (int attack = 0; attack < 6; ++attack) {
      const double size = std::pow(10.0, uniform(rng, -2, 12));
      const Vector y = size * normal_matrix(rng, model.total_outputs(), 1);
      const Matrix x = one_step(*runner, model, x0, y);
      CAPTURE(instance);
      CAPTURE(penalty);
      for (int i = 0; i < N; ++i) {
        const double rounding = 1e-12 * (1.0 + prediction.col(i).norm());
        const double half = constants.prior_deviation_bound(i);
        CHECK((x.col(i) - prediction.col(i)).norm() <= half * (1.0 + 1e-10) + rounding);
        CHECK((x.col(i) - before.col(i)).norm() <= constants.resiliency_bound(i) * (1.0 + 1e-10) + rounding);
        if (half > 0.0) worst = std::max(worst, (x.col(i) - prediction.col(i)).norm() / half);
      }
      before = x;
    }
  }
  std::cout << "rdkf bound (10): 2400 instances from seed 31, largest share of the bound " << worst << "\n";
  CHECK(worst > 0.99);  // and it is reached
}

TEST_CASE("starts inside the refined basin contract by gamma in 120 networks; the printed basin is wrong") {
  Rng rng(32);
  for (int instance = 0; instance < 120; ++instance) {
    const int n = whole(rng, 1, 4);
    const int N = whole(rng, 1, 5);
    const Model model = covariance_model(rng, n, N, uniform(rng, 0.5, 1.4));
    const Network network = connected_network(rng, N);
    const auto s = rdkf::setting(model, network);
    const auto steady = rdkf::steady_state(s);
    const double lambda = uniform(rng, 0.2, 3.0);
    const auto c = rdkf::constants(s, steady, lambda, rdkf::Penalty::norm);
    CHECK(c.level.refined >= c.level.corrected);
    CHECK(c.rate < 1.0);
    Matrix x0 = normal_matrix(rng, n, N);
    x0 *= std::sqrt(c.level.refined / rdkf::lyapunov(steady, x0)) * (1.0 - 1e-9);
    const auto runner = make_filter("rdkf", {{"weight", lambda}})->prepare(model, network)->runner(1);
    runner->reset(x0, nullptr);
    const Vector y = Vector::Zero(model.total_outputs());
    double V = rdkf::lyapunov(steady, x0);
    for (int t = 1; t <= 30; ++t) {
      runner->step(t, y.data());
      Matrix x(n, N);
      Frame frame;
      frame.estimate = x.data();
      runner->read(frame);
      const double next = rdkf::lyapunov(steady, x);
      CAPTURE(instance);
      CHECK(next <= c.rate * V * (1.0 + 1e-9) + 1e-24);
      V = next;
    }
  }
  // One agent, a = 1.1: the printed level admits 1.96, which diverges.
  Noise noise;
  noise.process_covariance = Matrix::Constant(1, 1, 1e-4);
  noise.measurement_covariance = {Matrix::Ones(1, 1)};
  const Model model(Matrix::Constant(1, 1, 1.1), {Matrix::Ones(1, 1)}, noise);
  const auto s = rdkf::setting(model, Network(1, {}));
  const auto steady = rdkf::steady_state(s);
  const auto c = rdkf::constants(s, steady, 1.0, rdkf::Penalty::norm);
  CHECK(std::sqrt(c.level.printed * steady.P[0](0, 0)) > 1.96);
  const double basin = rdkf::scalar_basin(s, steady, 1.0);
  for (const double start : {0.999 * basin, 1.001 * basin, 1.96}) {
    const auto runner = make_filter("rdkf", {})->prepare(model, Network(1, {}))->runner(1);
    runner->reset(Matrix::Constant(1, 1, start), nullptr);
    const double y = 0.0;
    for (int t = 1; t <= 400; ++t) runner->step(t, &y);
    double x = 0.0;
    Frame frame;
    frame.estimate = &x;
    runner->read(frame);
    CHECK((std::abs(x) < 1e-6) == (start < basin));
  }
}

TEST_CASE("run-time bounds hold under every attack, with noise, lost and late messages, 80 systems") {
  Rng rng(33);
  double tightest = kInfinity;
  for (int instance = 0; instance < 80; ++instance) {
    const int n = whole(rng, 1, 4);
    const int N = whole(rng, 1, 6);
    const Model model = covariance_model(rng, n, N, uniform(rng, 0.2, 1.1), 0.05);
    const Network network = connected_network(rng, N);
    const auto filter = make_filter(
        "rdkf",
        {{"initial_error", 1.0}, {"weight", uniform(rng, 0.05, 2.0)}, {"penalty", kPenalties[instance % 4]}});
    // The plant runs here: its noise is bounded, the measurements are anything.
    const int T = 25;
    Matrix truth(T + 1, n);
    truth.row(0).setZero();
    for (int t = 1; t <= T; ++t) {
      const Vector w = normal_matrix(rng, n, 1);
      truth.row(t) = (model.A() * truth.row(t - 1).transpose() + 0.05 * w / w.norm()).transpose();
    }
    Matrix y(T, model.total_outputs());
    for (int t = 0; t < T; ++t)
      y.row(t) = (model.stacked() * truth.row(t + 1).transpose()).transpose() +
                 std::pow(10.0, uniform(rng, -1, 6)) * normal_matrix(rng, 1, model.total_outputs());
    RunOptions o;
    o.start = normal_matrix(rng, n, N);
    o.start = (o.start.array().rowwise() / o.start.colwise().norm().array()).matrix();
    if (instance % 2 == 1) o.link = {0.2, 0.2, 1, {}, {}};
    const Record r = replay(model, network, *filter, y, truth, o);
    CAPTURE(instance);
    for (std::size_t k = 0; k < r.error.size(); ++k) {
      CHECK(r.error[k] <= r.bound[k] * (1.0 + 1e-12));
      if (r.error[k] > 0.0) tightest = std::min(tightest, r.bound[k] / r.error[k]);
    }
  }
  std::cout << "rdkf run-time bound: 80 systems from seed 33, least bound / error " << tightest << "\n";
}

TEST_CASE("attacks for ever stay within the persistent bound where it exists, 40 systems") {
  Rng rng(34);
  int known = 0;
  double largest = 0.0;
  for (int instance = 0; instance < 40; ++instance) {
    const int n = whole(rng, 1, 3);
    const int N = whole(rng, 1, 5);
    const Model model = covariance_model(rng, n, N, uniform(rng, 0.2, 1.05));
    const Network network = connected_network(rng, N);
    const auto& penalty = kPenalties[static_cast<std::size_t>(instance) % 4];
    const auto s = rdkf::setting(model, network);
    const auto c = rdkf::constants(s, rdkf::steady_state(s), 1.0, named(penalty));
    const bool exists = c.prior_error_radius < 1.0 - 1e-9;
    CHECK(exists == c.persistent_bound.allFinite());
    if (!exists) continue;
    ++known;
    const auto runner = make_filter("rdkf", {{"penalty", penalty}})->prepare(model, network)->runner(1);
    runner->reset(Matrix::Zero(n, N), nullptr);  // the truth is 0: the error is the estimate
    const Vector push = 1e6 * normal_matrix(rng, model.total_outputs(), 1);
    for (int t = 1; t <= 200; ++t) {
      const Vector y = t % 3 == 0 && instance % 2 == 0 ? Vector(-push) : push;
      runner->step(t, y.data());
      Matrix x(n, N);
      Frame frame;
      frame.estimate = x.data();
      runner->read(frame);
      CAPTURE(instance);
      for (int i = 0; i < N; ++i) {
        CHECK(x.col(i).norm() <= c.persistent_bound(i));
        largest = std::max(largest, x.col(i).norm() / c.persistent_bound(i));
      }
    }
  }
  std::cout << "rdkf persistent bound: " << known << " systems from seed 34, largest share " << largest
            << "\n";
  CHECK(known > 10);
}

TEST_CASE("what any attack shifts against the same run without it is the doubled bound: one agent, a = 0.8") {
  Noise noise;
  noise.process_covariance = Matrix{{1.0}};
  noise.measurement_covariance = {Matrix{{1.0}}};
  const Model model(Matrix{{0.8}}, {Matrix{{1.0}}}, noise);
  const auto filter = make_filter("rdkf", {{"weight", 1.0}});
  double persistent = kNaN;
  double shift = kNaN;
  for (const auto& q : filter->check(model, Network(1, {})).quantities) {
    if (q.name == "persistent bound") persistent = q.value;
    if (q.name == "persistent shift") shift = q.value;
  }
  CHECK(persistent == doctest::Approx(3.42).epsilon(0.01));
  CHECK(shift == 2.0 * persistent);
  const auto settled = [&](double y) {  // from the truth 0, the same measurement for ever
    const auto runner = filter->prepare(model, Network(1, {}))->runner(1);
    runner->reset(Matrix::Zero(1, 1), nullptr);
    double x = kNaN;
    Frame frame;
    frame.estimate = &x;
    for (int t = 1; t <= 300; ++t) runner->step(t, &y);
    runner->read(frame);
    return x;
  };
  const double up = settled(1e6);
  const double down = settled(-1e6);
  CHECK(std::abs(up) <= persistent);
  CHECK(up - down > persistent);  // 6.85: the single bound is not one of shifts
  CHECK(up - down <= shift);
  CHECK(up - down >= 0.99 * shift);
}
