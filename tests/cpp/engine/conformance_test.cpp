// SPDX-License-Identifier: Apache-2.0
// What every family owes its drivers, at every dimension.
#include <doctest/doctest.h>

#include <cstring>
#include <set>

#include "../agents_by_hand.hpp"
#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

/// States whose code differs; some of them. Builds with few dimensions, for the sanitizers, which take twenty
/// times as long, have code for 2, 4, 8 and any number.
#ifdef GARRISON_FEW_DIMENSIONS
const std::vector<int> kDimensions{3, 8};
const std::vector<int> kSome{3};
#else
const std::vector<int> kDimensions{1, 2, 3, 5, 8, 9};
const std::vector<int> kSome{1, 3, 9};
#endif

struct Setup {
  Model model;
  Network network;
  Matrix y;  // with NaN, inf and huge entries
};

Setup setup(int n, int agents, std::uint64_t seed) {
  test::Rng rng(seed);
  Model model = test::scalar_model(rng, n, agents, 0.98, 0.02, 0.01);
  const Network network = test::connected_network(rng, agents);
  Matrix y = test::normal_matrix(rng, 30, agents);
  y(3, 1) = kNaN;
  y(5, 2) = kInfinity;
  y(6, 2) = -kInfinity;
  y(8, 0) = 1e300;
  y(9, 3) = kNaN;
  return {std::move(model), network, std::move(y)};
}

bool same(const Bulk<double>& a, const Bulk<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Estimates of agents that are driven by hand over `link`, [time][agent][state].
Bulk<double> by_hand(const Setup& s, const AnyFilter& filter, const Vector& x0, const Link* link = nullptr) {
  test::AgentsByHand agents(*filter.prepare(s.model, s.network), s.network, link);
  for (const auto& agent : agents.all()) agent->reset(x0);
  Bulk<double> out;
  agents.append_estimates(out);
  for (Eigen::Index t = 0; t < s.y.rows(); ++t) {
    agents.step(t + 1, [&](int i) { return Vector::Constant(1, s.y(t, i)); });
    agents.append_estimates(out);
  }
  return out;
}

bool all_finite(const Bulk<double>& values) {
  for (const double v : values)
    if (!std::isfinite(v)) return false;
  return true;
}

RunOptions options_with(const Vector& x0, int trials = 1) {
  RunOptions o;
  o.start = x0;
  o.trials = trials;
  o.seed = 3;
  return o;
}

}  // namespace

TEST_CASE("replay gives the bits of agents driven by hand, and survives bad measurements") {
  for (const int n : kDimensions) {
    const Setup s = setup(n, 7, static_cast<std::uint64_t>(40 + n));
    const Vector x0 = Vector::Constant(n, 0.3);
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      const Record record = replay(s.model, s.network, *filter, s.y, Matrix(), options_with(x0));
      CHECK(same(record.estimate, by_hand(s, *filter, x0)));
      CHECK(all_finite(record.estimate));
      CHECK(record.missing == 2);
      CHECK(record.nonfinite == 3);
    }
  }
}

TEST_CASE("nobody starts anew because measurements are missing") {
  for (const int n : kSome) {
    Setup s = setup(n, 7, static_cast<std::uint64_t>(80 + n));
    test::Rng rng(90 + static_cast<std::uint64_t>(n));
    s.y = test::normal_matrix(rng, 30, 7);
    for (Eigen::Index t = 4; t < 26; t += 2) s.y.row(t).head(t % 7).setConstant(kNaN);
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      const Record record =
          replay(s.model, s.network, *filter, s.y, Matrix(), options_with(Vector::Constant(n, 0.3)));
      CHECK(record.missing > 20);
      CHECK(record.resets == 0);
      CHECK(record.overflows == 0);
    }
  }
}

TEST_CASE("agents driven by bytes lose and hear just what the engine says, bit for bit") {
  for (const int n : kSome) {
    const Setup s = setup(n, 7, static_cast<std::uint64_t>(60 + n));
    const Vector x0 = Vector::Constant(n, 0.3);
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      RunOptions o = options_with(x0);
      o.link = {0.2, 0.1, 2, {{2, -1, 5, 9}}, {{{3, 12, 0}, s.network.neighbours(3).front()}}};
      const Record record = replay(s.model, s.network, *filter, s.y, Matrix(), o);
      const Link link(s.network, o.link, {}, o.seed, 0);
      CHECK(same(record.estimate, by_hand(s, *filter, x0, &link)));
      CHECK(record.link.late > 0);
    }
  }
}

TEST_CASE("every family has a place in the tests of all families") {
  std::set<std::string> tested{"platoon", "platoon_baseline"};
  for (const auto& filter : test::every_filter()) tested.insert(filter->name());
  for (const FamilyInfo& family : families()) {
    CHECK_MESSAGE(
        tested.count(family.name) == 1,
        family.name << " has parameters without a default: give them in tests/cpp/every_filter.hpp");
  }
}

TEST_CASE("any number of threads gives the same bits, and so do trials side by side") {
  for (const int n : kDimensions) {
    test::Rng rng(static_cast<std::uint64_t>(n));
    const Model model = test::scalar_model(rng, n, 9, 1.0, 0.02, 0.01);
    const Network network = test::connected_network(rng, 9);
    const std::vector<Attack> attacks{scale(Schedule(5, {2}), 3.0),
                                      random_noise(Schedule(9, {4, 5}, 20, 0.5), "normal", 2.0, false),
                                      denial(Schedule(12, {7}))};
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      RunOptions o = options_with(Vector::Zero(n), 13);
      o.attacks = attacks;
      const PlantOptions plant{25, Vector::Constant(n, 0.2), 0.5, "uniform"};
      const auto prepared = filter->prepare(model, network);
      o.threads = 1;
      const Record one = simulate(*prepared, plant, o);
      o.threads = 4;
      const Record four = simulate(*prepared, plant, o);
      CHECK(same(one.estimate, four.estimate));
      CHECK(same(one.bound, four.bound));
      CHECK(one.verdict == four.verdict);
      o.keep = {true, false, false, false};  // estimates alone: the path with eight trials side by side
      const Record lanes = simulate(*prepared, plant, o);
      CHECK(same(one.estimate, lanes.estimate));
      CHECK(same(one.error, lanes.error));
    }
  }
}

TEST_CASE("a log of many runs replays each as its own trial") {
  test::Rng rng(4);
  const Model model = test::scalar_model(rng, 3, 6, 0.98, 0.02, 0.01);
  const Network network = test::connected_network(rng, 6);
  const auto filter = make_filter("saturation", {{"threshold", 0.5}});
  RunOptions o = options_with(Vector::Zero(3), 11);
  o.attacks = {denial(Schedule(5, {2}))};
  const Record made = simulate(model, network, *filter, {20, Vector::Ones(3), 0.0, "uniform"}, o);
  o.attacks.clear();
  const Log log{made.measurements.data(), made.truth.data(), 11, 20};
  const Record one_by_one = replay(model, network, *filter, log, o);
  o.keep = {true, false, false, false};
  const Record side_by_side = replay(model, network, *filter, log, o);
  for (const Record* again : {&one_by_one, &side_by_side}) {
    CHECK(same(again->estimate, made.estimate));
    CHECK(same(again->error, made.error));
    CHECK(again->missing == made.missing);
  }
  o.trials = 3;
  CHECK_THROWS_WITH_AS(replay(model, network, *filter, log, o),
                       doctest::Contains("trials: got 3, expected 11"), InvalidInput);
}

TEST_CASE("a large network gives the same bits on one thread and on three") {
  const int N = 3 * 20000;
  const Network network = Network::grid(300, 200);
  test::Rng rng(5);
  const Model model = test::scalar_model(rng, 2, N, 0.99, 0.02, 0.01);
  const auto filter =
      make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{4}}, {"step", 0.2}});
  RunOptions o = options_with(Vector::Zero(2));
  o.threads = 1;
  const PlantOptions plant{3, {}, 0.0, "uniform"};
  const Record one = simulate(model, network, *filter, plant, o);
  o.threads = 3;
  CHECK(same(one.estimate, simulate(model, network, *filter, plant, o).estimate));
}

TEST_CASE("other names for the agents change nothing but rounding") {
  const Setup s = setup(3, 8, 77);
  std::vector<int> name{5, 2, 7, 0, 1, 6, 3, 4};
  std::vector<Matrix> C(8);
  Matrix y(s.y.rows(), 8);
  for (int i = 0; i < 8; ++i) {
    C[static_cast<std::size_t>(name[static_cast<std::size_t>(i)])] = s.model.C(i);
    y.col(name[static_cast<std::size_t>(i)]) = s.y.col(i);
  }
  std::vector<Edge> edges;
  for (const auto& [a, b] : s.network.edges())
    edges.emplace_back(name[static_cast<std::size_t>(a)], name[static_cast<std::size_t>(b)]);
  const Model renamed(s.model.A(), C, s.model.noise());
  for (const auto& filter : test::every_filter()) {
    const auto a = replay(s.model, s.network, *filter, s.y, Matrix(), options_with(Vector::Zero(3)));
    const auto b = replay(renamed, Network(8, edges), *filter, y, Matrix(), options_with(Vector::Zero(3)));
    double worst = 0.0;
    for (std::size_t t = 0; t < 31; ++t)
      for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          worst = std::max(worst, std::abs(a.estimate[(t * 8 + i) * 3 + k] -
                                           b.estimate[(t * 8 + static_cast<std::size_t>(name[i])) * 3 + k]));
    CAPTURE(filter->name());
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("lost, late and forged messages are counted and never spread what is not finite") {
  for (const int n : kSome) {
    const Setup s = setup(n, 7, static_cast<std::uint64_t>(90 + n));
    for (const auto& filter : test::every_filter()) {
      CAPTURE(n);
      CAPTURE(filter->name());
      RunOptions o = options_with(Vector::Zero(n));
      o.link = {0.2, 0.2, 2, {}, {}};
      o.message_attacks = {forge(Schedule(4, {1}), kNaN, true), forge(Schedule(8, {2}, 12), 5.0, false),
                           equivocate(Schedule(6, {3}), 2.0), silence(Schedule(10, {4}))};
      const Record record = replay(s.model, s.network, *filter, s.y, Matrix(), o);
      CHECK(all_finite(record.estimate));
      CHECK(record.link.refused > 0);
      CHECK(record.link.forged > 0);
      CHECK(record.link.late > 0);
      const auto prepared = filter->prepare(s.model, s.network);
      const std::int64_t edges = 2 * static_cast<std::int64_t>(s.network.edges().size());
      const std::int64_t all = edges * 30 * prepared->agent(0)->rounds();
      const auto& c = record.link;
      CHECK(c.sent + c.lost + c.late + c.forged + c.refused == all);
      for (const double bound :
           record.bound)  // nobody vouches for an estimate with messages missing behind it
        if (&bound - record.bound.data() >= 7 * 20) CHECK(std::isnan(bound));
    }
  }
}

TEST_CASE("an estimate that overflows is withheld, and the agent rejoins from its neighbours") {
  const Model model(Matrix::Constant(1, 1, 1e100), std::vector<Matrix>(3, Matrix::Ones(1, 1)));
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{1}}});
  const Matrix y = Matrix::Constant(4, 3, kNaN);
  RunOptions o;
  o.start = Matrix::Zero(1, 3);
  o.start(0, 0) = 1e100;  // 1e200 after one step
  const Record record = replay(model, Network::path(3), *filter, y, Matrix(), o);
  CHECK(record.overflows == 1);
  CHECK(record.resets == 1);
  CHECK(record.estimate[3] == 0.0);  // what agent 1 sent
  CHECK(all_finite(record.estimate));
  CHECK_THROWS_WITH_AS(
      replay(model, Network::path(3), *filter, y, Matrix(), options_with(Vector::Constant(1, 1e200))),
      doctest::Contains("start: got a number that is not finite, or beyond 1e150"), InvalidInput);
}

TEST_CASE("a liar that sends 1e308 for three samples leaves nobody with an estimate that is of no use") {
  for (const int n : {2, 9}) {
    const Setup s = setup(n, 7, static_cast<std::uint64_t>(80 + n));
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> y = s.y;
    const Log log{y.data(), nullptr, 1, static_cast<int>(y.rows())};
    for (const auto& filter : test::every_filter()) {
      const auto prepared = filter->prepare(s.model, s.network);
      for (const double lie : {1e308, 1e149, -1e140}) {
        CAPTURE(filter->name());
        CAPTURE(lie);
        RunOptions o = options_with(Vector::Zero(n));
        o.message_attacks = {forge(Schedule(4, {1}, 7), lie, true)};
        const Record record = replay(*prepared, log, o);
        CHECK(all_finite(record.estimate));
        CHECK((lie == 1e308 ? record.link.refused : record.link.forged) > 0);
      }
    }
  }
}
