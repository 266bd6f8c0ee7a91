// SPDX-License-Identifier: Apache-2.0
// The dimension as a template argument and at run time; what the registry holds; several outputs per agent.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "../agents_by_hand.hpp"
#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/engine.hpp"
#include "garrison/filters/lfre.hpp"
#include "garrison/filters/scalar_gain.hpp"

using namespace garrison;

namespace {

Matrix estimates(Runner& runner, const Model& model, const Matrix& y) {
  runner.reset(Matrix::Constant(model.states(), model.agents(), 0.3), nullptr);
  Matrix all(model.states() * model.agents(), y.rows());
  for (Eigen::Index t = 0; t < y.rows(); ++t) {
    const Vector sample = y.row(t);
    runner.step(t + 1, sample.data());
    runner.read({.estimate = all.col(t).data()});
  }
  return all;
}

/// The registry's engine, whose dimension is fixed up to 8, against one that learns it at run time.
template <class F>
void compare(const typename F::Params& params) {
  for (const int n : {1, 2, 3, 5, 8}) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 7, 0.98, 0.02, 0.01);
    const Network net = test::connected_network(rng, 7);
    Matrix y = test::normal_matrix(rng, 30, 7);
    y(3, 1) = kNaN;
    y(5, 2) = kInfinity;
    const auto prepared = make_filter(std::string(F::name), values(params))->prepare(model, net);
    const Matrix fixed = estimates(*prepared->runner(1), model, y);
    Engine<F, Dynamic> engine(std::make_shared<const typename F::Gains>(F::design(params, model, net)), model,
                              net, 1);
    const Matrix dynamic = estimates(engine, model, y);
    CAPTURE(n);
    CHECK(fixed.allFinite());
    CHECK((fixed - dynamic).cwiseAbs().maxCoeff() <= 1e-12 * (1.0 + fixed.cwiseAbs().maxCoeff()));
  }
}

}  // namespace

TEST_CASE("a fixed dimension gives the numbers of a dynamic one") {
  Saturation::Params algorithm1;
  algorithm1.threshold = 0.5;
  compare<Saturation>(algorithm1);
  Saturation::Params algorithm2 = algorithm1;
  algorithm2.rounds = 12;
  algorithm2.attacked = 2;
  algorithm2.initial_error = 2.0;
  algorithm2.detector = true;
  compare<Saturation>(algorithm2);
  compare<ScalarGain>({});
  compare<Lfre>({});
}

TEST_CASE("every registered family runs, with good and with bad measurements") {
  CHECK(families().size() >= 3);
  for (const auto& family : families()) {
    CAPTURE(family.name);
    CHECK(!family.title.empty());
    CHECK(!family.source.empty());
    for (const auto& info : family.params) CHECK_MESSAGE(!info.doc.empty(), info.name);
  }
  for (const auto& filter : test::every_filter()) {
    CAPTURE(filter->name());
    const auto family = std::find_if(families().begin(), families().end(),
                                     [&](const FamilyInfo& one) { return one.name == filter->name(); });
    REQUIRE(family != families().end());
    CHECK(make_filter(filter->name(), filter->params())->params().size() == family->params.size());
    for (const int n : {1, 2, 3, 5, 8, 9}) {
      CAPTURE(n);
      test::Rng rng(static_cast<std::uint64_t>(n) + 60);
      const Model model = test::scalar_model(rng, n, 6, 0.98, 0.02, 0.01);
      const Network net = test::connected_network(rng, 6);
      Matrix y = test::normal_matrix(rng, 20, 6);
      for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300, -1e300})
        for (int k = 0; k < 4; ++k) y(test::whole(rng, 0, 15), test::whole(rng, 0, 5)) = bad;
      RunOptions o;
      o.keep.signals = true;
      const Record r = replay(model, net, *filter, y, Matrix(), o);
      CHECK(r.signal_names == filter->signal_names());
      CHECK(r.signals.size() == 21 * r.signal_names.size() * 6);
      for (const double v : r.estimate) CHECK(std::isfinite(v));
      CHECK(r.missing + r.nonfinite ==
            (y.array().isFinite() && y.array().abs() < kHuge).select(0, Eigen::ArrayXXi::Ones(20, 6)).sum());
    }
  }
}

TEST_CASE("agents with several outputs or none agree with the engine, from starts of their own") {
  Matrix two(2, 3);
  two << 1, 0, 0, 0, 0.6, 0.8;
  const Model model(0.9 * Matrix::Identity(3, 3), {two, Matrix(0, 3), two.row(1), two.row(0)});
  const Network net = Network::ring(4);
  test::Rng rng(2);
  const Matrix y = test::normal_matrix(rng, 15, 4);
  RunOptions o;
  o.start = test::normal_matrix(rng, 3, 4);
  const auto filter = make_filter("saturation", {{"threshold", 0.7}});
  const Record record = replay(model, net, *filter, y, Matrix(), o);
  const auto prepared = filter->prepare(model, net);
  test::AgentsByHand agents(*prepared, net);
  for (int i = 0; i < 4; ++i) agents[i].reset(o.start.col(i));
  std::vector<double> estimates(record.estimate.begin(), record.estimate.begin() + 12);
  for (int t = 0; t < 15; ++t) {
    agents.step(t + 1, [&](int i) { return Vector(y.row(t).segment(model.offset(i), model.outputs(i))); });
    agents.append_estimates(estimates);
  }
  REQUIRE(estimates.size() == record.estimate.size());
  CHECK(std::memcmp(estimates.data(), record.estimate.data(), estimates.size() * sizeof(double)) == 0);
}
