// SPDX-License-Identifier: Apache-2.0
// Tests go on through gaps, and keep what they promise.
#include <doctest/doctest.h>

#include "garrison/attacks/measurement.hpp"
#include "runs.hpp"

using namespace garrison;

namespace {

/// Measurements of honest sensors of x+ = A x; each lost with probability `lost`, those of `whole` never.
Matrix record_of(test::Rng& rng, const Model& model, int steps, double lost, int whole) {
  const Noise& noise = model.noise();
  const Matrix root = noise.process_covariance.llt().matrixL();
  Matrix y(steps, model.agents());
  Vector x = Vector::Zero(model.states());
  for (int t = 0; t < steps; ++t) {
    x = model.A() * x + root * test::normal_matrix(rng, model.states(), 1);
    for (int i = 0; i < model.agents(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      y(t, i) = model.C(i).row(0).dot(x) +
                std::sqrt(noise.measurement_covariance[k](0, 0)) * test::normal_matrix(rng, 1, 1)(0);
      if (i != whole && test::uniform(rng, 0, 1) < lost) y(t, i) = kNaN;
    }
  }
  return y;
}

double share(const Record& r, int agent, Verdict verdict, int from) {
  double count = 0.0;
  for (int t = from; t <= r.steps; ++t)
    count += r.verdict[static_cast<std::size_t>(t * r.agents + agent)] == static_cast<std::uint8_t>(verdict);
  return count / (r.steps - from + 1);
}

}  // namespace

TEST_CASE("a liar among twelve is found while the others miss samples") {
  const Model model =
      test::known_model(Matrix::Constant(1, 1, 0.9), Matrix::Ones(12, 1), Matrix::Constant(1, 1, 0.1), 1.0);
  for (const bool isolate : {false, true})
    for (const char* test : {"auto", "innovation"})
      for (const double lost : {0.0, 0.05, 0.2, 0.5}) {
        test::Rng rng(71);
        Matrix y = record_of(rng, model, 300, lost, 0);
        y.col(0).tail(250).array() += 100.0;
        const auto filter = make_filter("structural", {{"isolate", isolate}, {"test", std::string(test)}});
        const Record r = replay(model, Network::complete(12), *filter, y, Matrix(), {});
        CAPTURE(isolate);
        CAPTURE(test);
        CAPTURE(lost);
        CHECK(share(r, 0, Verdict::cleared, 55) == 0.0);
        CHECK(share(r, 0, Verdict::attacked, 55) > 0.99);
        if (isolate)
          for (int i = 1; i < 12; ++i) CHECK(share(r, i, Verdict::attacked, 55) < 0.2);
      }
}

TEST_CASE("with losses and delays nothing alarms more often than asked for") {
  test::Rng rng(72);
  double tested = 0.0;
  int systems = 0;
  for (int k = 0; k < 12; ++k) {
    const int N = test::whole(rng, 2, 6);
    const int n = test::whole(rng, 1, 3);
    Matrix A = test::normal_matrix(rng, n, n);
    A *= test::uniform(rng, 0.7, 1.05) / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
    const Model model =
        test::known_model(A, test::normal_matrix(rng, N, n), 0.1 * Matrix::Identity(n, n), 0.3);
    const Network network = test::connected_network(rng, N);
    for (const char* test : {"residual", "innovation"})
      for (const std::int64_t window : {1, 5})
        for (const int rounds : {3, 10}) {
          RunOptions o;
          o.trials = 40;
          o.seed = 9;
          o.link.delay = 0.3;
          o.link.delay_rounds = rounds;
          const auto filter = make_filter(
              "structural", {{"false_alarm", 0.01}, {"test", std::string(test)}, {"window", window}});
          const Record r = simulate(model, network, *filter, {300, {}, 0.0, "normal"}, o);
          const test::Rate rate = test::alarm_rate(r, 1);
          CAPTURE(k);
          CAPTURE(test);
          CAPTURE(window);
          CAPTURE(rate.tested);
          CHECK(rate.mean <= 0.01 + 4.5 * rate.error);
          tested += rate.tested;
          ++systems;
        }
    Matrix y = record_of(rng, model, 4000, 0.2, -1);
    const Record r = replay(model, network, *make_filter("structural", {}), y, Matrix(), {});
    CHECK(test::alarm_rate(r, 1).mean <= 0.013);
  }
  CHECK(tested / systems > 0.8);
}
