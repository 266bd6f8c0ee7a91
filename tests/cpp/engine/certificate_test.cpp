// SPDX-License-Identifier: Apache-2.0
// Certificates in engines and agents: the same bits, exact bytes, snapshots, designs.
#include <doctest/doctest.h>

#include <array>
#include <cstring>

#include "../agents_by_hand.hpp"
#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/design_file.hpp"

using namespace garrison;
using certificate::Spread;
using certificate::Wanted;

namespace {

constexpr int kAgents = 7;
constexpr int kSamples = 30;
/// States of the plant; the sanitizers take twenty times as long for the same.
#if defined(__SANITIZE_ADDRESS__)
constexpr std::array kStates{3};
#else
constexpr std::array kStates{1, 3, 9};
#endif

struct Setup {
  Model model;
  Network network;
  Matrix y;  // with entries that are missing or absurd
};

Setup setup(int n, std::uint64_t seed) {
  test::Rng rng(seed);
  Model model = test::scalar_model(rng, n, kAgents, 0.98, 0.02, 0.01);
  Network network = test::connected_network(rng, kAgents);
  Matrix y = 0.01 * test::normal_matrix(rng, kSamples, kAgents);
  y(3, 1) = kNaN;
  y(5, 2) = kInfinity;
  y(8, 0) = 1e300;
  y(9, 3) = 40.0;
  return {std::move(model), std::move(network), std::move(y)};
}

const std::vector<Wanted> kWanted{{Spread::local, 0.0, 1, 1000},
                                  {Spread::local, 1e-6, 1, 1000},
                                  {Spread::direct, 1e-6, 1, 1000},
                                  {Spread::direct, 0.0, 1, 1000},
                                  {Spread::flooded, 1e-6, 1, 1000},
                                  {Spread::flooded, 1e-6, 1, 0},
                                  {Spread::flooded, 0.0, 1, 1000},
                                  {Spread::local, 1e-3, 1, 0, 6.0, 5.5},
                                  {Spread::local, 1e-6, 1, 1000, 0.0, 0.0, true},
                                  {Spread::direct, 1e-6, 1, 1000, 0.0, 0.0, true},
                                  {Spread::flooded, 1e-6, 1, 1000, 0.0, 0.0, true}};

/// Bounds of agents driven by hand, [time][agent], with their kinds behind.
struct ByHand {
  Bulk<double> bound;
  Bulk<std::uint8_t> kind;

  void append(test::AgentsByHand& agents) {
    for (const auto& agent : agents.all()) {
      const Report report = agent->report();
      const std::size_t at = bound.size();
      bound.resize(at + 1);
      kind.resize(at + 1);
      bound[at] = report.bound;
      kind[at] = static_cast<std::uint8_t>(report.kind);
    }
  }
};

template <class T>
bool same(const Bulk<T>& a, const Bulk<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

RunOptions options(const Vector& x0) {
  RunOptions o;
  o.start = x0;
  o.seed = 3;
  return o;
}

Record replayed(const Prepared& prepared, const Setup& s, const RunOptions& o) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> y = s.y;
  return replay(prepared, Log{y.data(), nullptr, 1, kSamples}, o);
}

/// How many bounds are there of each kind.
std::size_t count(const Record& record, CertificateKind kind) {
  std::size_t found = 0;
  for (const auto k : record.bound_kind) found += k == static_cast<std::uint8_t>(kind) ? 1 : 0;
  return found;
}

}  // namespace

TEST_CASE("certificates of the engine are those of agents driven by bytes, bit for bit") {
  std::size_t witnesses = 0;
  std::size_t relayed = 0;
  for (const int n : kStates) {
    const Setup s = setup(n, static_cast<std::uint64_t>(160 + n));
    const Vector x0 = Vector::Constant(n, 0.3);
    for (const auto& filter : test::every_filter()) {
      const auto plain = filter->prepare(s.model, s.network);
      for (std::size_t w = 0; w < kWanted.size(); ++w) {
        if (n > 3 && w % 3 != 0) continue;  // slow, and other code for the filter alone
        const auto prepared = certified(*plain, kWanted[w]);
        for (const bool faults : {false, true}) {
          CAPTURE(n);
          CAPTURE(filter->name());
          CAPTURE(w);
          CAPTURE(faults);
          RunOptions o = options(x0);
          if (faults)
            o.link = {0.3, 0.1, 2, {{2, -1, 5, 9}}, {{{3, 12, 0}, s.network.neighbours(3).front()}}};
          const Record record = replayed(*prepared, s, o);
          const Link link(s.network, o.link, {}, o.seed, 0);
          test::AgentsByHand agents(*prepared, s.network, faults ? &link : nullptr);
          for (const auto& agent : agents.all()) agent->reset(x0);
          ByHand found;
          found.append(agents);
          for (int t = 1; t <= kSamples; ++t) {
            agents.step(t, [&](int i) { return Vector::Constant(1, s.y(t - 1, i)); });
            found.append(agents);
          }
          CHECK(same(record.bound, found.bound));
          CHECK(same(record.bound_kind, found.kind));
          // The filter itself does not notice.
          CHECK(same(record.estimate, replayed(*plain, s, o).estimate));
          witnesses += count(record, CertificateKind::witness);
          relayed += count(record, CertificateKind::relayed);
        }
      }
    }
  }
  CHECK(witnesses > 250 * kStates.size());
  CHECK(relayed > 250 * kStates.size());
}

TEST_CASE("bytes of a certificate are counted as they travel") {
  const Setup s = setup(3, 5);
  for (const auto& filter : test::every_filter()) {
    const auto plain = filter->prepare(s.model, s.network);
    for (const Wanted& wanted : kWanted) {
      const auto prepared = certified(*plain, wanted);
      const Record record = replayed(*prepared, s, options(Vector::Zero(3)));
      std::vector<std::unique_ptr<Agent>> agents;
      for (int i = 0; i < kAgents; ++i) agents.push_back(prepared->agent(i));
      std::int64_t bytes = 0;
      std::vector<std::vector<std::byte>> sent(kAgents);
      const auto room = [&](int i) {
        return std::vector<std::byte>(agents[static_cast<std::size_t>(i)]->most_bytes());
      };
      for (int t = 1; t <= kSamples; ++t) {
        for (int i = 0; i < kAgents; ++i) {
          auto body = room(i);
          const double y = s.y(t - 1, i);
          body.resize(agents[static_cast<std::size_t>(i)]->sense(t, {&y, 1}, body).bytes);
          sent[static_cast<std::size_t>(i)] = body;
        }
        for (int round = 0; round < agents.front()->rounds(); ++round) {
          for (int i = 0; i < kAgents; ++i)
            for (const int j : s.network.neighbours(i)) {
              const auto& body = sent[static_cast<std::size_t>(j)];
              bytes += static_cast<std::int64_t>(body.size());
              REQUIRE(agents[static_cast<std::size_t>(i)]->deliver({j, t, round}, body) == Refusal::none);
            }
          for (int i = 0; i < kAgents; ++i) {
            auto body = room(i);
            body.resize(agents[static_cast<std::size_t>(i)]->fuse(body).bytes);
            sent[static_cast<std::size_t>(i)] = body;
          }
        }
      }
      CAPTURE(filter->name());
      // Two means over the samples, each rounded down.
      CHECK(bytes / kSamples - record.bytes_per_step >= 0);
      CHECK(bytes / kSamples - record.bytes_per_step <= 1);
    }
  }
}

TEST_CASE("a certificate that says nothing adds no bytes, and bytes that say nothing are refused") {
  const Setup s = setup(3, 5);
  Wanted direct;  // says its measurement in the first round, and nothing after it
  direct.spread = Spread::direct;
  direct.attacked = 1;
  for (const auto& filter : test::every_filter()) {
    const auto plain = filter->prepare(s.model, s.network);
    const auto prepared = certified(*plain, direct);
    const int hears = s.network.neighbours(3).front();
    const auto bare = plain->agent(hears);
    const auto says = prepared->agent(hears);
    const auto listens = prepared->agent(3);
    if (says->rounds() < 2) continue;
    CAPTURE(filter->name());
    std::vector<std::byte> small(bare->most_bytes());
    std::vector<std::byte> body(says->most_bytes());
    const double y = s.y(0, hears);
    const std::size_t filters = bare->sense(1, {&y, 1}, small).bytes;
    CHECK(says->sense(1, {&y, 1}, body).bytes == filters + 1 + 8);
    const std::size_t next = says->fuse(body).bytes;
    CHECK(next == bare->fuse(small).bytes);
    body.resize(next);
    CHECK(listens->deliver({hears, 1, 1}, body) == Refusal::none);
    body.push_back(std::byte{0});  // no measurement is there
    CHECK(prepared->agent(3)->deliver({hears, 1, 1}, body) == Refusal::size);
  }
}

TEST_CASE(
    "an agent that loads a snapshot goes on with the same certificate, from the same part of a design") {
  const Setup s = setup(3, 8);
  for (const Wanted& wanted : kWanted) {
    const auto filter = make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}});
    const auto prepared = certified(*filter->prepare(s.model, s.network), wanted);
    const auto again = read_design(write_design(*prepared));
    CHECK(again->certificate()->wanted == wanted);
    CHECK(again->fingerprint() == prepared->fingerprint());
    CHECK(again->fingerprint() != filter->prepare(s.model, s.network)->fingerprint());
    test::AgentsByHand one(*prepared, s.network);
    test::AgentsByHand other(*again, s.network);
    ByHand first, second;
    for (int t = 1; t <= kSamples; ++t) {
      const auto y = [&](int i) { return Vector::Constant(1, s.y(t - 1, i)); };
      one.step(t, y);
      first.append(one);
      if (t == 12)
        for (int i = 0; i < kAgents; ++i) {
          std::vector<std::byte> snapshot(one[i].snapshot_bytes());
          REQUIRE(one[i].save(snapshot) == snapshot.size());
          other.all()[static_cast<std::size_t>(i)] = read_part(write_part(*prepared, i));
          REQUIRE(other[i].load(snapshot) == Refusal::none);
        }
      else
        other.step(t, y);
      second.append(other);
    }
    CHECK(same(first.bound, second.bound));
    CHECK(same(first.kind, second.kind));
  }
}

TEST_CASE("a bound outlives an outage, and an agent that joins has one from what it heard") {
  const Setup s = setup(2, 9);
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{2}}});
  const auto prepared = certified(*filter->prepare(s.model, s.network), {Spread::flooded, 0.0, 1, 1000});
  test::AgentsByHand agents(*prepared, s.network);
  const auto y = [&](int) { return Vector::Constant(1, 0.001); };
  for (int t = 1; t <= 3; ++t) agents.step(t, y);
  std::vector<std::byte> body(agents[0].most_bytes());
  double last = agents[0].report().bound;
  for (int t = 4; t <= 60; ++t) {  // nobody is heard any more, and nothing is measured
    const double none = kNaN;
    agents[0].sense(t, {&none, 1}, body);
    while (agents[0].round() < agents[0].rounds()) agents[0].fuse(body);
    const Report r = agents[0].report();
    CHECK(r.kind == CertificateKind::relayed);
    CHECK(r.bound > last);
    last = r.bound;
  }
  const auto fresh = prepared->agent(1);
  CHECK(fresh->report().kind == CertificateKind::too_few);
  CHECK(fresh->report().bound == kInfinity);
  REQUIRE(fresh->listen(61) == Refusal::none);
  std::vector<std::byte> told(agents[0].most_bytes());
  const int heard = s.network.neighbours(1)[0];
  auto speaker = prepared->agent(heard);
  speaker->reset(Vector::Zero(2), 60);
  // Whoever just started says nothing: the one below has run from the start.
  speaker->reset(Vector::Zero(2));
  const double one = 0.001;
  Agent::Sent sent;
  for (int t = 1; t <= 61; ++t) {
    sent = speaker->sense(t, {&one, 1}, told);
    while (t < 61 && speaker->round() < speaker->rounds()) speaker->fuse(told);
  }
  REQUIRE(fresh->deliver({heard, 61, 0}, std::span(told).first(sent.bytes)) == Refusal::none);
  REQUIRE(fresh->join() == Refusal::none);
  CHECK(fresh->report().kind == CertificateKind::too_few);  // one row of two agents: s = 1 leaves nothing
}

TEST_CASE("more liars than allowed are called that, and too few rows something else") {
  const Model model(Matrix::Identity(1, 1), std::vector<Matrix>(4, Matrix::Ones(1, 1)),
                    {0.1, Vector::Constant(4, 0.1), {}, {}});
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{2}}});
  const auto prepared =
      certified(*filter->prepare(model, Network::complete(4)), {Spread::flooded, 0.0, 1, 1000});
  Matrix y(3, 4);
  y << 0.0, 0.0, 0.0, 9.0,  // one liar
      0.0, 0.0, 9.0, 9.0,   // two
      0.0, kNaN, kNaN, kNaN;
  const Record r = replay(model, Network::complete(4), *filter, y, Matrix(), {});
  CHECK(r.bound_kind[4] == static_cast<std::uint8_t>(CertificateKind::none));
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = y;
  const Record c = replay(*prepared, Log{rows.data(), nullptr, 1, 3}, {});
  CHECK(c.bound[0] == kInfinity);
  CHECK(c.bound_kind[0] == static_cast<std::uint8_t>(CertificateKind::too_few));
  CHECK(c.bound_kind[4] == static_cast<std::uint8_t>(CertificateKind::witness));
  CHECK(std::isnan(c.bound[8]));
  CHECK(c.bound_kind[8] == static_cast<std::uint8_t>(CertificateKind::refuted));
  CHECK(c.bound_kind[12] == static_cast<std::uint8_t>(CertificateKind::relayed));  // of the first sample
  RunOptions lies;
  lies.message_attacks = {forge(Schedule(1, {0}), 1.0, false)};
  const Record l = replay(*prepared, Log{rows.data(), nullptr, 1, 3}, lies);
  CHECK(std::isnan(l.bound[4]));
  CHECK(l.bound_kind[4] == static_cast<std::uint8_t>(CertificateKind::liars));
  const Record d =
      replay(*certified(*prepared, {Spread::direct, 0.0, 1, 1000}), Log{rows.data(), nullptr, 1, 3}, lies);
  CHECK(std::isfinite(d.bound[4]));
  CHECK(d.bound_kind[4] == static_cast<std::uint8_t>(CertificateKind::witness));
}

TEST_CASE("a certificate that cannot be given is refused by name") {
  const Model bare(Matrix::Identity(1, 1), std::vector<Matrix>(3, Matrix::Ones(1, 1)));
  const auto filter = make_filter("scalar_gain", {});
  const auto prepared = filter->prepare(bare, Network::complete(3));
  CHECK_THROWS_WITH_AS(certified(*prepared, {Spread::local, 0.0, 1, 1000}),
                       doctest::Contains("measurement_bound"), InvalidInput);
  CHECK_THROWS_WITH_AS(certified(*prepared, {Spread::local, 1e-6, 1, 1000}),
                       doctest::Contains("measurement_covariance"), InvalidInput);
  CHECK_THROWS_WITH_AS(certified(*prepared, {Spread::local, 1.0, 1, 1000}),
                       doctest::Contains("failure: got 1"), InvalidInput);
  const Model bounded(Matrix::Identity(1, 1), std::vector<Matrix>(3, Matrix::Ones(1, 1)),
                      {kNaN, Vector::Ones(3), {}, {}});
  CHECK_THROWS_WITH_AS(
      certified(*filter->prepare(bounded, Network::complete(3)), {Spread::local, 0.0, 3, 1000}),
      doctest::Contains("attacked: got 3"), InvalidInput);
}

TEST_CASE("levels that are given take the place of those of the covariances") {
  const Setup s = setup(3, 12);
  const auto plan = certificate::make_plan({Spread::flooded, 1e-3, 1, 1000, 6.0, 5.5}, s.model, s.network);
  CHECK(plan.z1 == 6.0);
  CHECK(plan.z2_full == 5.5);
  CHECK(plan.z2_partial == 5.5);
  const auto refused = [&](const Wanted& wanted, const char* why) {
    CHECK_THROWS_WITH_AS(certificate::make_plan(wanted, s.model, s.network), doctest::Contains(why),
                         InvalidInput);
  };
  refused({Spread::flooded, 1e-3, 1, 1000, 6.0, 0.0}, "levels: got 6 and 0");
  refused({Spread::flooded, 1e-3, 1, 1000, kNaN, 5.5}, "two numbers > 0");
  refused({Spread::flooded, 0.0, 1, 1000, 6.0, 5.5}, "levels with failure = 0");
}

TEST_CASE("what is flooded reaches everybody although each agent passes it on a few times only") {
  // A chain: everything has to pass through everybody.
  const int N = 6;
  std::vector<Edge> edges;
  for (int i = 0; i + 1 < N; ++i) edges.push_back({i, i + 1});
  const Network network(N, edges);
  const Model model(Matrix::Identity(1, 1), std::vector<Matrix>(N, Matrix::Ones(1, 1)),
                    {kNaN, {}, Matrix::Identity(1, 1), std::vector<Matrix>(N, Matrix::Ones(1, 1))});
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{12}}});
  // Estimates stay 0, so a bound tells how many rows it is of.
  const auto prepared = certified(*filter->prepare(model, network), {Spread::flooded, 1e-6, 1, 0});
  const Matrix y = Matrix::Zero(1, N);
  RunOptions o;
  o.start = Vector::Zero(1);
  const Record all = replay(*prepared, Log{y.data(), nullptr, 1, 1}, o);
  std::size_t whole = 0;
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    o.seed = static_cast<std::uint64_t>(seed);
    o.link = LinkFaults{.drop = 0.05};
    const Record lossy = replay(*prepared, Log{y.data(), nullptr, 1, 1}, o);
    for (int i = 0; i < N; ++i) {
      const auto at = static_cast<std::size_t>(N + i);
      CHECK((lossy.bound[at] >= all.bound[at] || std::isinf(lossy.bound[at])));
      whole += lossy.bound[at] == all.bound[at] ? 1 : 0;
    }
  }
  MESSAGE("all rows at an agent: " << whole << " of " << kSeeds * N << " at 5 % loss");
  CHECK(whole > 0.98 * kSeeds * N);
}
