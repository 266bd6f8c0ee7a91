// SPDX-License-Identifier: Apache-2.0
// Agents of a group have the bits of agents on their own.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>

#include "garrison/filters/partial_sharing/update.hpp"
#include "garrison/runtime/family.hpp"
#include "random_setting.hpp"

using namespace garrison;

namespace {

/// Groups of every size: runs of agents with `outputs[k % size]` outputs each.
struct Problem {
  Model model;
  Network network;
  Matrix y;

  Problem(int n, int agents, const std::vector<int>& outputs, std::uint64_t seed)
      : Problem(n, agents, outputs, test::Rng(seed)) {}

 private:
  Problem(int n, int agents, const std::vector<int>& outputs, test::Rng rng)
      : model(make(n, agents, outputs, rng)),
        network(test::connected_network(rng, agents)),
        y(test::normal_matrix(rng, 90, model.total_outputs())) {
    for (Eigen::Index t = 0; t < y.rows(); ++t)
      for (const double bad : {kNaN, kInfinity, 1e300})
        y(t, test::whole(rng, 0, model.total_outputs() - 1)) = bad;
  }
  static Model make(int n, int agents, const std::vector<int>& outputs, test::Rng& rng) {
    std::vector<Matrix> H;
    Noise noise;
    noise.process_covariance = test::covariance(rng, n, 0.2);
    for (int i = 0; i < agents; ++i) {
      const int q = outputs[static_cast<std::size_t>(i) % outputs.size()];
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

Seen by_engine(const Problem& p, const Prepared& prepared, const Matrix& x0, Link* link, int threads = 1) {
  const auto runner = prepared.runner(threads);
  runner->reset(x0, link);
  Seen seen;
  const auto N = static_cast<std::size_t>(p.model.agents());
  Matrix estimate(p.model.states(), p.model.agents());
  std::vector<double> statistic(N), signals(3 * N);
  std::vector<std::uint8_t> verdict(N);
  for (Eigen::Index t = 0; t < p.y.rows(); ++t) {
    const Vector sample = p.y.row(t);
    runner->step(t + 1, sample.data());
    runner->read({.estimate = estimate.data(),
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
  std::vector<std::unique_ptr<AnyAgent>> agents;
  for (int i = 0; i < p.model.agents(); ++i) {
    agents.push_back(prepared.agent(i));
    agents.back()->reset(x0.col(i));
  }
  Seen seen;
  for (Eigen::Index t = 0; t < p.y.rows(); ++t) {
    const Vector sample = p.y.row(t);
    std::vector<std::shared_ptr<AnyMessage>> sent;
    for (const auto& agent : agents)
      sent.push_back(agent->sense({sample.data() + p.model.offset(agent->id()),
                                   static_cast<std::size_t>(p.model.outputs(agent->id()))}));
    for (const auto& agent : agents) {
      std::vector<std::shared_ptr<AnyMessage>> inbox;
      for (const int j : p.network.neighbours(agent->id()))
        inbox.push_back(sent[static_cast<std::size_t>(j)]);
      agent->fuse(inbox);
      const Vector x = agent->estimate();
      const Report r = agent->report();
      seen.estimate.insert(seen.estimate.end(), x.data(), x.data() + x.size());
      seen.statistic.push_back(r.statistic);
      seen.verdict.push_back(static_cast<std::uint8_t>(r.verdict));
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
  for (const int n : {1, 3, 4, 8, 9})
    for (const std::vector<int>& outputs :
         {std::vector<int>{2}, std::vector<int>{0, 1, 1, 2, 2, 2, n + 1, n + 1}})
      for (const char* gains : {"frozen", "varying", "steady"}) {
        CAPTURE(n);
        CAPTURE(outputs.size());
        CAPTURE(gains);
        const Problem p(n, 29, outputs, static_cast<std::uint64_t>(n));
        const auto prepared =
            make_filter("partial_sharing",
                        {{"gain", 0.1}, {"shared", std::int64_t{(n + 1) / 2}}, {"gains", std::string(gains)}})
                ->prepare(p.model, p.network);
        const Matrix x0 = Matrix::Constant(n, 29, 0.3);
        const Seen direct = by_engine(p, *prepared, x0, nullptr);
        CHECK(std::isfinite(*std::max_element(direct.estimate.begin(), direct.estimate.end())));
        check_same(direct, by_hand(p, *prepared, x0));
        Link never(p.network, {1e-300, 0.0, 1}, {}, 1, 0);  // no message is lost, but each could be
        check_same(direct, by_engine(p, *prepared, x0, &never));
        CHECK(never.counters.lost == 0);
        if (std::string(gains) == "frozen") {  // some agents of a group earlier than others
          CHECK(direct.still.back() == 29.0);
          CHECK(std::any_of(direct.still.begin(), direct.still.end(),
                            [](double s) { return s > 0 && s < 29; }));
        }
      }
}

TEST_CASE("predictions that are not finite go by message, and harm only those who have them") {
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
    x0(0, 3) = 1.7e308;
    x0(n - 1, 7) = -1.7e308;
    check_same(by_engine(p, *prepared, x0, nullptr), by_hand(p, *prepared, x0));
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
  Aligned<double> room[2];
  for (auto& each : room) each.resize(Group<m>::size(m, 3));
  Group<m> narrow(m, 3, room[0].data(), x[0].data());
  Group<m> wide(m, 3, room[1].data(), x[1].data());
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
      for (int r = 0; r < 3; ++r) std::copy_n(Vector(y.row(r)).data(), kGroup, group->at(group->y, r));
    Vector squares[2] = {Vector::Zero(kGroup), Vector::Zero(kGroup)};
    Update<m>::run<2>(&common, &narrow, u.data(), x[0].data(), squares[0].data());
    update(common, wide, u.data(), x[1].data(), squares[1].data());
    const Vector expected = x[0].leftCols(kGroup - 1).colwise().squaredNorm();
    CHECK(squares[0].head(kGroup - 1).isApprox(expected, 1e-14));
    CHECK(squares[0] == squares[1]);
    CHECK(x[0] == x[1]);
    CHECK(narrow.frozen == wide.frozen);
  }
  CHECK(narrow.frozen[0]);
}
