// SPDX-License-Identifier: Apache-2.0
// Isolation lets a sensor in again that is right again.
#include <doctest/doctest.h>

#include "garrison/attacks/measurement.hpp"
#include "runs.hpp"

using namespace garrison;

namespace {

struct Plant {
  std::string name;
  Matrix A, C;
  int steps = 400;  // an unstable plant soon is where doubles end
};

Matrix rows(std::initializer_list<std::pair<double, double>> all) {
  Matrix C(static_cast<Eigen::Index>(all.size()), 2);
  Eigen::Index i = 0;
  for (const auto& [a, b] : all) C.row(i++) << a, b;
  return C;
}
Matrix shear() { return (Matrix(2, 2) << 1, 1, 0, 1).finished(); }

std::vector<Plant> plants() {
  return {{"integrator, one sensor", Matrix::Constant(1, 1, 1.0), Matrix::Ones(1, 1)},
          {"integrator, three sensors", Matrix::Constant(1, 1, 1.0), Matrix::Ones(3, 1)},
          {"double integrator, one position", shear(), rows({{1, 0}})},
          {"double integrator, three positions", shear(), rows({{1, 0}, {1, 0}, {1, 0}})},
          {"double integrator, ppvv", shear(), rows({{1, 0}, {1, 0}, {0, 1}, {0, 1}})},
          {"unstable, one sensor", Matrix::Constant(1, 1, 1.2), Matrix::Ones(1, 1), 150},
          {"unstable, four sensors", Matrix::Constant(1, 1, 1.1), Matrix::Ones(4, 1), 200}};
}

constexpr int kTrials = 20;

Record run(const Plant& plant, bool isolate, const std::vector<Attack>& attacks, double false_alarm) {
  const auto n = plant.A.rows();
  const Model model = test::known_model(plant.A, plant.C, 0.04 * Matrix::Identity(n, n), 0.25);
  const auto N = static_cast<int>(plant.C.rows());
  RunOptions o;
  o.trials = kTrials;
  o.seed = 11;
  o.attacks = attacks;
  const auto filter =
      make_filter("structural",
                  {{"isolate", isolate}, {"test", std::string("innovation")}, {"false_alarm", false_alarm}});
  return simulate(model, N == 1 ? Network(1, std::vector<Edge>{}) : Network::complete(N), *filter,
                  {plant.steps, {}, 0.0, "normal"}, o);
}

/// Root mean square of the error over trials, agents and the last `last` samples.
double rms(const Record& r, int last) {
  double sum = 0.0;
  int count = 0;
  for (int trial = 0; trial < r.trials; ++trial)
    for (int t = r.steps + 1 - last; t <= r.steps; ++t)
      for (int i = 0; i < r.agents; ++i, ++count)
        sum += std::pow(r.error[static_cast<std::size_t>((trial * (r.steps + 1) + t) * r.agents + i)], 2);
  return std::sqrt(sum / count);
}
/// Share of the last `last` samples in which somebody is accused.
double accused(const Record& r, int last) {
  double count = 0.0;
  for (int trial = 0; trial < r.trials; ++trial)
    for (int t = r.steps + 1 - last; t <= r.steps; ++t)
      for (int i = 0; i < r.agents; ++i)
        count += r.verdict[static_cast<std::size_t>((trial * (r.steps + 1) + t) * r.agents + i)] ==
                 static_cast<std::uint8_t>(Verdict::attacked);
  return count / (static_cast<double>(r.trials) * last * r.agents);
}

}  // namespace

TEST_CASE("after a glitch, a burst, a common burst, a long attack or a false alarm the error comes back") {
  for (const Plant& plant : plants()) {
    const bool two = plant.C.rows() > 1;
    const std::vector<int> both = two ? std::vector{0, 1} : std::vector{0};
    const std::vector<std::pair<std::string, std::vector<Attack>>> attacks{
        {"glitch", {bias(Schedule(30, {0}, 31), 8.0)}},
        {"burst", {bias(Schedule(30, {0}, 36), 8.0)}},
        {"common burst", {bias(Schedule(30, both, 36), 8.0)}},
        {"long attack", {bias(Schedule(30, {0}, plant.steps - 110), 20.0)}},
        {"long common attack", {bias(Schedule(30, both, plant.steps - 110), 20.0)}},
        {"long drift", {ramp(Schedule(30, {0}, plant.steps - 110), 0.1)}}};
    const double clean = rms(run(plant, false, {}, 0.001), 40);
    for (const auto& [what, attack] : attacks) {
      CAPTURE(plant.name);
      CAPTURE(what);
      const Record r = run(plant, true, attack, 0.001);
      CHECK(rms(r, 40) < 1.2 * clean);
      CHECK(accused(r, 40) < 0.1);
    }
    // One sample in a hundred alarms, all the time, and the sensor is left out for `clear_after` samples
    // each: what a lone sensor costs most.
    const Record r = run(plant, true, {}, 0.01);
    CHECK(rms(r, plant.steps) < (two ? 1.3 : 2.5) * clean);
    CHECK(accused(r, plant.steps) < 0.07);
  }
}

TEST_CASE(
    "positions and speeds, one position off by 100: it is accused, nobody else, and the error stays small") {
  const Plant plant = plants()[4];
  const std::vector<Attack> attack{bias(Schedule(50, {0}), 100.0)};
  const Record r = run(plant, true, attack, 0.01);
  double liar = 0.0;
  double honest = 0.0;
  for (std::size_t k = 0; k < r.verdict.size(); ++k) {
    if (static_cast<int>(k) / 4 % 401 < 55) continue;
    const double hit = r.verdict[k] == static_cast<std::uint8_t>(Verdict::attacked) ? 1.0 : 0.0;
    (k % 4 == 0 ? liar : honest) += hit / (20.0 * 346.0);
  }
  CHECK(liar > 0.99);
  CHECK(honest / 3.0 < 0.1);
  CHECK(rms(r, 300) < 0.8);
  CHECK_THROWS_WITH_AS(make_filter("structural", {{"isolate", true}, {"test", std::string("residual")}})
                           ->prepare(test::known_model(plant.A, plant.C, 0.04 * Matrix::Identity(2, 2), 0.25),
                                     Network::complete(4)),
                       doctest::Contains("structural.test: got residual together with isolate"),
                       InvalidInput);
}

TEST_CASE("a sensor that a whole path depends on is believed again after an attack that was believed") {
  const Matrix A = Matrix::Constant(1, 1, 1.03);
  Matrix C = Matrix::Zero(6, 1);
  C(0) = 1.0;
  const Model model = test::known_model(A, C, Matrix::Constant(1, 1, 0.04), 0.25);
  const auto error = [&](bool isolate, std::vector<Attack> attacks) {
    RunOptions o;
    o.trials = 10;
    o.seed = 12;
    o.attacks = std::move(attacks);
    const auto filter = make_filter("structural", {{"isolate", isolate}, {"false_alarm", 0.001}});
    // The errors of this design fall by 1.2 % a sample: from 200 to the noise takes 450 samples.
    return rms(simulate(model, Network::path(6), *filter, {700, {}, 0.0, "normal"}, o), 40);
  };
  for (const double size : {8.0, 20.0, 200.0})
    CHECK(error(true, {bias(Schedule(50, {0}, 100), size)}) < 1.5 * error(false, {}));
}
