// SPDX-License-Identifier: Apache-2.0
// Each kind of bad input is refused with a message that names it, or survived.
#include <doctest/doctest.h>

#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/rdkf/ipopt_step.hpp"
#include "garrison/filters/rdkf/setting.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

const Network kPair = Network::path(2);

Model pair(double a, const Matrix& Sw, const Matrix& Sv, const Matrix& C = Matrix::Ones(1, 2)) {
  Noise noise;
  noise.process_covariance = Sw;
  noise.measurement_covariance = {Sv, Sv};
  return {a * Matrix::Identity(2, 2), {C, Matrix{{1.0, -1.0}}}, noise};
}

const Matrix kTwo = Matrix::Identity(2, 2);
const Matrix kOne = Matrix::Identity(1, 1);

void refused(const Model& model, const Network& network, const ParamMap& params, const char* words) {
  CHECK_THROWS_WITH_AS(make_filter("rdkf", params)->prepare(model, network), doctest::Contains(words),
                       InvalidInput);
}

}  // namespace

TEST_CASE("what cannot be used is refused by name") {
  const Model good = pair(0.9, kTwo, kOne);
  CHECK_NOTHROW(make_filter("rdkf", {})->prepare(good, kPair));
  refused(good, kPair, {{"weight", -1.0}}, "lambda");
  refused(good, kPair, {{"weight", kNaN}}, "lambda");
  refused(good, kPair, {{"weight", kInfinity}}, "lambda");
  refused(good, kPair, {{"penalty", std::string("l2")}}, "norm, huber, l1, group");
  refused(good, kPair, {{"smoothing", 0.1}, {"penalty", std::string("huber")}}, "smoothing");
  refused(good, kPair, {{"solver", std::string("ipopt")}, {"penalty", std::string("l1")}}, "ipopt");
  if (!rdkf::ipopt_available()) refused(good, kPair, {{"solver", std::string("ipopt")}}, "apt-get install");
  refused(good, kPair, {{"initial_error", 1.0}}, "process_bound");
  refused(good, Network(2, {}), {}, "not connected");
  refused(pair(0.9, 0.0 * kTwo, kOne), kPair, {}, "process_covariance (Sw[0])");
  refused(pair(0.9, kTwo, 0.0 * kOne), kPair, {}, "measurement_covariance (Sv[0])");
  refused(pair(1.2, kTwo, kOne, Matrix{{-1.0, 1.0}}), kPair, {}, "not detectable");
  refused(Model(kTwo, {Matrix::Ones(1, 2), Matrix::Ones(1, 2)}), kPair, {}, "process_covariance: got none");
  CHECK_THROWS_WITH_AS(pair(0.9, kTwo, -1.0 * kOne), doctest::Contains("positive semidefinite covariance"),
                       InvalidInput);
}

TEST_CASE("a mode that is hardly seen is found by its growth") {
  Noise noise;
  noise.process_covariance = kTwo;
  noise.measurement_covariance = {kOne};
  const Model model(Vector{{2.0, 0.5}}.asDiagonal(), {Matrix{{1e-9, 1.0}}}, noise);
  CHECK_THROWS_WITH_AS(make_filter("rdkf", {})->prepare(model, Network(1, {})), doctest::Contains("(5)"),
                       InvalidInput);
}

TEST_CASE("a check lists what does not hold instead of refusing it") {
  const Check apart = make_filter("rdkf", {})->check(pair(0.9, kTwo, kOne), Network(2, {}));
  CHECK_FALSE(apart.holds());
  const Check unseen = make_filter("dkf", {})->check(pair(1.2, kTwo, kOne, Matrix{{-1.0, 1.0}}), kPair);
  CHECK_FALSE(unseen.holds());
  const Check fine = make_filter("rdkf", {})->check(pair(1.0, kTwo, kOne), kPair);
  CHECK(fine.holds());
  bool said = false;
  for (const auto& c : fine.conditions)
    said = said || c.meaning.find("no bound for persistent attacks: radius = ") != std::string::npos;
  CHECK(said);
}

TEST_CASE("an edge given twice or backwards does not change the number of neighbours") {
  Rng rng(3);
  const Model model = covariance_model(rng, 3, 4, 1.05);
  const Matrix y = normal_matrix(rng, 10, model.total_outputs());
  const auto filter = make_filter("rdkf", {});
  const std::vector<Edge> once{{0, 1}, {1, 2}, {2, 3}};
  const std::vector<Edge> twice{{0, 1}, {1, 0}, {1, 2}, {2, 1}, {2, 1}, {2, 3}};
  const Record a = replay(model, Network(4, once), *filter, y, Matrix(), {});
  const Record b = replay(model, Network(4, twice), *filter, y, Matrix(), {});
  CHECK(a.estimate == b.estimate);
}

TEST_CASE("nan, inf and huge measurements count as none and never come out, whatever the penalty") {
  Rng rng(4);
  for (const char* penalty : {"norm", "huber", "l1", "group"}) {
    const Model model = covariance_model(rng, 3, 5, 1.02);
    const Network network = connected_network(rng, 5);
    const int M = model.total_outputs();
    Matrix y = normal_matrix(rng, 40, M);
    Matrix missing = y;
    const double bad[] = {kNaN, kInfinity, -kInfinity, 1e300, -1e300, 1e160};
    for (int t = 5; t < 35; ++t) {
      const int k = whole(rng, 0, M - 1);
      y(t, k) = bad[t % 6];
      missing(t, k) = kNaN;  // that one alone: the agent's other outputs still count
    }
    const auto filter = make_filter("rdkf", {{"penalty", std::string(penalty)}});
    const Record a = replay(model, network, *filter, y, Matrix(), {});
    const Record b = replay(model, network, *filter, missing, Matrix(), {});
    CAPTURE(penalty);
    for (const double v : a.estimate) CHECK(std::isfinite(v));
    CHECK(a.estimate == b.estimate);
    for (const double size : {1e100, 1e140, 1e149}) {
      const Record huge = replay(model, network, *filter, size * normal_matrix(rng, 10, M), Matrix(), {});
      for (const double v : huge.estimate) CHECK(std::isfinite(v));
    }
  }
}
