// SPDX-License-Identifier: Apache-2.0
// Agents of a group have the bits of agents on their own.
#include "garrison/filters/partial_sharing/side_by_side.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>

#include "../../agents_by_hand.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/engine/batch/batch.hpp"
#include "garrison/engine/mailroom.hpp"
#include "garrison/engine/workers.hpp"
#include "random_setting.hpp"

using namespace garrison;

namespace {

/// Groups of every size: agent k has `outputs[k % size]` outputs. `alike`: those with as many measure the
/// same.
struct Problem {
  Model model;
  Network network;
  Matrix y;

  Problem(int n, int agents, const std::vector<int>& outputs, std::uint64_t seed, bool alike = false)
      : Problem(n, agents, outputs, test::Rng(seed), alike) {}

 private:
  Problem(int n, int agents, const std::vector<int>& outputs, test::Rng rng, bool alike)
      : model(make(n, agents, outputs, rng, alike)),
        network(test::connected_network(rng, agents)),
        y(test::normal_matrix(rng, 90, model.total_outputs())) {
    for (Eigen::Index t = 0; t < y.rows(); ++t)
      for (const double bad : {kNaN, kInfinity, 1e300})
        y(t, test::whole(rng, 0, model.total_outputs() - 1)) = bad;
  }
  static Model make(int n, int agents, const std::vector<int>& outputs, test::Rng& rng, bool alike) {
    std::vector<Matrix> H;
    Noise noise;
    noise.process_covariance = test::covariance(rng, n, 0.2);
    for (int i = 0; i < agents; ++i) {
      const int q = outputs[static_cast<std::size_t>(i) % outputs.size()];
      const auto kinds = outputs.size();
      if (alike && H.size() >= kinds) {
        H.push_back(H[H.size() - kinds]);
        noise.measurement_covariance.push_back(noise.measurement_covariance[H.size() - 1 - kinds]);
        continue;
      }
      H.push_back(test::normal_matrix(rng, q, n));
      noise.measurement_covariance.push_back(q == 0 ? Matrix(0, 0) : test::covariance(rng, q, 1.0));
    }
    return {test::normal_matrix(rng, n, n) * (0.5 / n), H, noise};
  }
};

struct Seen {
  std::vector<double> estimate, statistic;
  std::vector<std::uint8_t> verdict;
  std::vector<double> still;  ///< how many agents have frozen gains, by time
};

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  const auto bits = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) ||
           (std::isnan(x) && std::isnan(y));
  };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), bits);
}

Seen by_engine(const Problem& p, Runner& runner, const Matrix& x0, Link* link) {
  runner.reset(x0, link);
  Seen seen;
  const auto N = static_cast<std::size_t>(p.model.agents());
  Matrix estimate(p.model.states(), p.model.agents());
  std::vector<double> statistic(N), signals(3 * N);
  std::vector<std::uint8_t> verdict(N);
  for (Eigen::Index t = 0; t < p.y.rows(); ++t) {
    const Vector sample = p.y.row(t);
    runner.step(t + 1, sample.data());
    runner.read({.estimate = estimate.data(),
                 .statistic = statistic.data(),
                 .verdict = verdict.data(),
                 .signals = signals.data()});
    seen.estimate.insert(seen.estimate.end(), estimate.data(), estimate.data() + estimate.size());
    seen.statistic.insert(seen.statistic.end(), statistic.begin(), statistic.end());
    seen.verdict.insert(seen.verdict.end(), verdict.begin(), verdict.end());
    double still = 0.0;
    for (std::size_t i = 0; i < N; ++i) still += signals[N + i];
    seen.still.push_back(still);
  }
  return seen;
}

Seen by_hand(const Problem& p, const Prepared& prepared, const Matrix& x0) {
  test::AgentsByHand agents(prepared, p.network);
  for (int i = 0; i < p.model.agents(); ++i) agents[i].reset(x0.col(i));
  Seen seen;
  for (Eigen::Index t = 0; t < p.y.rows(); ++t) {
    agents.step(t + 1,
                [&](int i) { return Vector(p.y.row(t).segment(p.model.offset(i), p.model.outputs(i))); });
    agents.append_estimates(seen.estimate);
    for (const auto& agent : agents.all()) {
      seen.statistic.push_back(agent->report().statistic);
      seen.verdict.push_back(static_cast<std::uint8_t>(agent->report().verdict));
    }
  }
  return seen;
}

void check_same(const Seen& a, const Seen& b) {
  CHECK(same(a.estimate, b.estimate));
  CHECK(same(a.statistic, b.statistic));
  CHECK(a.verdict == b.verdict);
}

}  // namespace

TEST_CASE("groups, with and without messages, have the bits of agents driven by hand") {
  const auto check = [](int n, const std::vector<int>& outputs, const std::string& gains, bool alike) {
    CAPTURE(n);
    CAPTURE(outputs.size());
    CAPTURE(gains);
    CAPTURE(alike);
    const Problem p(n, 29, outputs, static_cast<std::uint64_t>(n), alike);
    const auto prepared =
        make_filter("partial_sharing",
                    {{"gain", 0.1}, {"shared", std::int64_t{(n + 1) / 2}}, {"gains", gains}})
            ->prepare(p.model, p.network);
    const Matrix x0 = Matrix::Constant(n, 29, 0.3);
    const auto runner = prepared->runner(1);
    const Seen direct = by_engine(p, *runner, x0, nullptr);
    CHECK(std::isfinite(*std::max_element(direct.estimate.begin(), direct.estimate.end())));
    check_same(direct, by_hand(p, *prepared, x0));
    Link never(p.network, {1e-300, 0.0, 1}, {}, 1, 0);  // no message is lost, but each could be
    check_same(direct, by_engine(p, *runner, x0, &never));
    CHECK(never.counters.lost == 0);
    if (gains != "frozen") return;
    CHECK(direct.still.back() == 29.0);
    const bool one_by_one =
        std::any_of(direct.still.begin(), direct.still.end(), [](double s) { return s > 0 && s < 29; });
    CHECK(one_by_one == (!alike || outputs.size() > 1));  // some agents of a group earlier than others
  };
  for (const int n : {1, 3, 4, 8, 9})
    for (const std::vector<int>& outputs :
         {std::vector<int>{2}, std::vector<int>{0, 1, 1, 2, 2, 2, n + 1, n + 1}})
      for (const char* gains : {"frozen", "varying", "steady"})
        for (const bool alike : {false, true}) check(n, outputs, gains, alike);
}

TEST_CASE("groups of like agents read one copy of sensors and gains") {
  for (const char* gains : {"frozen", "steady"})
    for (const bool alike : {false, true}) {
      CAPTURE(gains);
      CAPTURE(alike);
      const Problem p(4, 20, {2}, 6, alike);
      PartialSharing::Params params;
      params.gain = 0.1;
      params.gains = gains;
      const PartialSharing::Gains g = PartialSharing::design(params, p.model, p.network);
      std::vector<double> C;  // of all agents, row by row
      for (int i = 0; i < 20; ++i)
        for (const double c : Vector(p.model.C(i).transpose().reshaped())) C.push_back(c);
      std::vector<PartialSharing::State<4>> states(20);
      PartialSharing::Message<4> unused;
      const auto local = [&](std::size_t k) {
        return Local{static_cast<int>(k), 20, 4, 2, 0, p.model.A().data(), C.data() + 8 * k};
      };
      SideBySide<PartialSharing, 4> all(std::span<PartialSharing::State<4>>(states), 4);
      all.join(local);
      for (std::size_t k = 0; k < states.size(); ++k)
        PartialSharing::init<4>(local(k), g, Vec<4>::Zero(), states[k], unused);
      all.start(g, local);
      const auto& [first, second, last] = std::tie(*states[0].group, *states[8].group, *states[16].group);
      const auto sharing = [&] { return second.C == first.C && second.G == first.G; };
      CHECK(sharing() == (alike && g.steady.size() == 20));
      CHECK(last.C != first.C);  // four agents and four idle lanes
      Workers workers(1);
      const std::vector<std::size_t> nobody(21, 0);
      const Vector y = Vector::Ones(40);
      const ConsensusPlan plan(p.network.offsets(), p.network.lists(), 4);
      for (int t = 1; t <= 200; ++t)
        all.step(BatchSample{g, plan, Wiring{nobody.data(), nullptr}, workers, t, local,
                             [&](std::size_t k) { return y.data() + 2 * k; }, [](const auto&) {}});
      CHECK(!first.moving());
      CHECK(sharing() == alike);
    }
}

TEST_CASE("predictions that are of no use go by message, and harm only those who have them") {
  for (const int n : {4, 8}) {
    Problem p(n, 19, {2}, 5);
    p.model = Model(
        2.0 * Matrix::Ones(n, n),
        [&] {
          std::vector<Matrix> C;
          for (int i = 0; i < 19; ++i) C.push_back(p.model.C(i));
          return C;
        }(),
        p.model.noise());
    const auto prepared = make_filter("partial_sharing", {{"gain", 0.1}, {"gains", std::string("varying")}})
                              ->prepare(p.model, p.network);
    Matrix x0 = Matrix::Zero(n, 19);
    x0(0, 3) = 9e149;
    x0(n - 1, 7) = -9e149;
    check_same(by_engine(p, *prepared->runner(1), x0, nullptr), by_hand(p, *prepared, x0));
  }
}

TEST_CASE("groups have the same bits on one thread and on three") {
  const int N = 2 * 20000 + 11;
  const Network network = Network::grid(N, 1);
  test::Rng rng(8);
  const Model model = test::scalar_model(rng, 2, N, 0.99, 0.02, 0.01);
  const auto prepared =
      make_filter("partial_sharing", {{"gain", 0.1}, {"shared", std::int64_t{1}}})->prepare(model, network);
  Matrix estimates[2];
  for (const int threads : {1, 3}) {
    const auto runner = prepared->runner(threads);
    runner->reset(Matrix::Zero(2, N), nullptr);
    test::Rng noise(9);
    for (int t = 1; t <= 5; ++t) {
      const Vector y = test::normal_matrix(noise, N, 1);
      runner->step(t, y.data());
    }
    Matrix& all = estimates[threads / 2];
    all.resize(2, N);
    runner->read({.estimate = all.data()});
  }
  CHECK(estimates[0].allFinite());
  CHECK(estimates[0] == estimates[1]);
}

TEST_CASE("narrow vectors give the bits of wide ones") {
  using namespace partial_sharing;
  constexpr int m = 8;
  test::Rng rng(10);
  const Matrix A = test::normal_matrix(rng, m, m) * 0.1;
  const Matrix Q = test::covariance(rng, m, 0.2);
  const Common common{A.data(), Q.data(), 0.1, true};
  Matrix x[2];
  x[0] = x[1] = test::normal_matrix(rng, m, kGroup);
  Group<m> narrow(m, 3);
  Group<m> wide(m, 3);
  narrow.x = x[0].data();
  wide.x = x[1].data();
  for (Group<m>* group : {&narrow, &wide}) {
    group->agents = kGroup - 1;
    test::Rng same(11);
    for (int lane = 0; lane < group->agents; ++lane) {
      for (int k = 0; k < 3 * m; ++k) group->at(group->C, k, lane) = lane * test::uniform(same, -1, 1);
      for (int k = 0; k < packed(3); ++k) group->at(group->W, k, lane) = test::uniform(same, -1, 1);
      for (int i = 0; i < m; ++i) group->at(group->P, packed(i, i), lane) = 1.0;
    }
  }
  for (int t = 0; t < 60; ++t) {
    const Matrix y = test::normal_matrix(rng, 3, kGroup);
    const Matrix u = test::normal_matrix(rng, m, kGroup);
    for (Group<m>* group : {&narrow, &wide})
      for (int r = 0; r < 3; ++r) std::copy_n(Vector(y.row(r)).data(), kGroup, &group->at(group->y, r, 0));
    Outcome outcome[2];
    Update<m>::run<2>(&common, &narrow, u.data(), x[0].data(), &outcome[0]);
    update(common, wide, u.data(), x[1].data(), outcome[1]);
    const Eigen::Map<const Vector> squares[2] = {{outcome[0].squares, kGroup}, {outcome[1].squares, kGroup}};
    const Vector expected = x[0].leftCols(kGroup - 1).colwise().squaredNorm();
    CHECK(squares[0].head(kGroup - 1).isApprox(expected, 1e-14));
    CHECK(squares[0] == squares[1]);
    CHECK(x[0] == x[1]);
    CHECK(narrow.frozen == wide.frozen);
  }
  CHECK(narrow.is_frozen(0));
}
