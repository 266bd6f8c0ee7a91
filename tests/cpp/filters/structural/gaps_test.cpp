// SPDX-License-Identifier: Apache-2.0
// Tests go on through gaps, and keep what they promise.
#include <doctest/doctest.h>

#include "garrison/attacks/message.hpp"
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

TEST_CASE("what a message says of the bound has its price, and a liar's numbers stay harmless") {
  test::Rng rng(73);
  for (const int n : {2, 16, 17}) {
    const Matrix A = 0.9 * Matrix::Identity(n, n);
    const Model model =
        test::known_model(A, test::normal_matrix(rng, 2 * n, n), 0.1 * Matrix::Identity(n, n), 0.3);
    const Network network = Network::complete(2 * n);
    Matrix y = record_of(rng, model, 60, 0.0, -1);
    y(49, 1) = kNaN;
    const Record r = replay(model, network, *make_filter("structural", {}), y, Matrix(), {});
    CAPTURE(n);
    const int carried = n <= 16 ? n * (n + 1) / 2 : 0;
    CHECK(r.bytes_per_step == 2 * n * (2 * n - 1) * (8 * (n + 1 + carried) + 1 + 1 + 2));
    CHECK(std::isnan(r.threshold[static_cast<std::size_t>(51 * 2 * n)]) == (n > 16));
    const Record screened =
        replay(model, network, *make_filter("structural", {{"isolate", true}}), y, Matrix(), {});
    CHECK_FALSE(std::isnan(screened.threshold[static_cast<std::size_t>(51 * 2 * n)]));
  }
  const Model model = test::known_model(0.9 * Matrix::Identity(2, 2), test::normal_matrix(rng, 4, 2),
                                        0.1 * Matrix::Identity(2, 2), 0.3);
  const Matrix y = record_of(rng, model, 200, 0.2, -1);
  for (const bool isolate : {false, true})
    for (const double lie : {-1e3, 0.0, 1e3, 1e149}) {
      RunOptions o;
      o.message_attacks.push_back(falsify(Schedule(20, {0}, 60), "covariance", lie, {}));
      o.keep.signals = true;
      const Record r = replay(model, Network::complete(4), *make_filter("structural", {{"isolate", isolate}}),
                              y, Matrix(), o);
      CAPTURE(lie);
      CHECK(r.link.refused == 0);
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(r.threshold[4 * 200 + i] < 20.0);
        CHECK(std::abs(r.estimate[(4 * 200 + i) * 2]) < 20.0);
      }
    }
}

TEST_CASE("a run says which sensors were hardly tested, and that too many were accused") {
  const Model model =
      test::known_model(Matrix::Constant(1, 1, 0.9), Matrix::Ones(3, 1), Matrix::Constant(1, 1, 0.1), 1.0);
  test::Rng rng(74);
  const Matrix y = record_of(rng, model, 200, 0.0, -1);
  const auto warnings = [&](const ParamMap& params, const Matrix& data) {
    return replay(model, Network::complete(3), *make_filter("structural", params), data, Matrix(), {})
        .warnings;
  };
  CHECK(warnings({}, y).empty());
  for (int seed = 0; seed < 20; ++seed) {  // many alarms, as asked for: no reason to doubt anything
    test::Rng honest(75 + static_cast<std::uint64_t>(seed));
    CAPTURE(seed);
    CHECK(warnings({{"false_alarm", 0.05}}, record_of(honest, model, 2000, 0.0, -1)).empty());
  }
  const auto hardly = warnings({{"settle", std::int64_t{194}}}, y);
  REQUIRE(hardly.size() == 3);
  CHECK(hardly[2].find("sensor 2 was tested in 3 % of the samples") == 0);
  Matrix off = y;
  off.bottomRows(100).leftCols(2).array() += 50.0;
  const auto many = warnings({}, off);
  REQUIRE(many.size() == 1);
  CHECK(many[0].find("more than half of the sensors were accused for 100 samples in a row") == 0);
  const Model lone =
      test::known_model(Matrix::Constant(1, 1, 1.0), Matrix::Ones(1, 1), Matrix::Constant(1, 1, 0.04), 0.25);
  Matrix glitch = Matrix::Zero(60, 1);
  glitch(30) = 8.0;
  const auto of_lone = [&](bool isolate) {
    return replay(lone, Network(1, std::vector<Edge>{}), *make_filter("structural", {{"isolate", isolate}}),
                  glitch, Matrix(), {})
        .warnings;
  };
  const auto needed = of_lone(true);
  REQUIRE(needed.size() == 1);
  CHECK(needed[0].find("sensor 0 was accused, but it alone sees a mode that does not decay") == 0);
  for (const auto& other : of_lone(false)) CHECK(other.find("isolate") == std::string::npos);
}
