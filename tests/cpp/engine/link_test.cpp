// SPDX-License-Identifier: Apache-2.0
// Link faults inside the engine: small networks whose numbers can be worked out by hand.
#include "garrison/engine/link.hpp"

#include <doctest/doctest.h>

#include <cstring>

#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

bool same(const Bulk<double>& a, const Bulk<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Two agents without measurements that only average: x = 0 and 8, step 1/4.
Record two_agents(int rounds, int steps, const LinkFaults& faults,
                  std::vector<std::shared_ptr<const MessageAttack>> attacks) {
  const Model model(Matrix::Ones(1, 1), std::vector<Matrix>(2, Matrix::Ones(1, 1)));
  RunOptions o;
  o.start = Matrix{{0.0, 8.0}};
  o.link = faults;
  o.message_attacks = std::move(attacks);
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{rounds}}, {"step", 0.25}});
  return replay(model, Network::path(2), *filter, Matrix::Constant(steps, 2, kNaN), Matrix(), o);
}

}  // namespace

TEST_CASE("a late message is lost, by however many rounds it is late") {
  const Record one = two_agents(1, 3, {0.0, 1.0, 1, {}, {}}, {});
  CHECK(one.estimate == Bulk<double>{0, 8, 0, 8, 0, 8, 0, 8});
  CHECK(one.link.late == 6);
  CHECK(one.link.lost == 0);
  const Record ten = two_agents(2, 2, {0.0, 1.0, 10, {}, {}}, {});
  CHECK(ten.estimate == Bulk<double>{0, 8, 0, 8, 0, 8});
  CHECK(ten.link.late == 8);
}

TEST_CASE("scheduled and recorded faults lose what they say, and nothing else") {
  const Record cut =
      two_agents(1, 3, {0.0, 0.0, 1, {{0, 1, 2, 3}}, {}}, {});  // at t = 2 agent 1 hears nothing
  CHECK(cut.estimate == Bulk<double>{0, 8, 2, 6, 3, 6, 3.75, 5.25});
  CHECK(cut.link.lost == 1);
  const Record all = two_agents(1, 2, {0.0, 0.0, 1, {{-1, -1, 1, 2}}, {}}, {});
  CHECK(all.estimate == Bulk<double>{0, 8, 0, 8, 2, 6});
  const Record recorded = two_agents(2, 1, {0.0, 0.0, 1, {}, {{{1, 1, 1}, 0}}}, {});  // round 1, from 1 to 0
  CHECK(recorded.estimate == Bulk<double>{0, 8, 2, 5});
  CHECK(recorded.link.lost == 1);
  CHECK_THROWS_WITH_AS(two_agents(1, 1, {0.0, 0.0, 1, {{0, 7, 0, 1}}, {}}, {}),
                       doctest::Contains("link.cuts: got agent 7"), InvalidInput);
}

TEST_CASE("a liar that sends what it sent a sample ago as new is taken at its word") {
  const Record r = two_agents(1, 2, {}, {outdated(Schedule(1, {0}), 1)});
  CHECK(r.link.lost == 1);  // nothing that old yet
  CHECK(r.estimate == Bulk<double>{0, 8, 2, 8, 3.5, 6});
}

TEST_CASE("only the victims of a forged message see it") {
  const Record r = two_agents(1, 1, {}, {forge(Schedule(1, {0}), 4.0, true)});
  CHECK(r.estimate == Bulk<double>{0, 8, 2, 7});
  CHECK(r.link.forged == 1);
  CHECK(r.link.sent == 1);
  const Record withheld = two_agents(1, 1, {}, {silence(Schedule(1, {0}))});
  CHECK(withheld.estimate == Bulk<double>{0, 8, 2, 8});
  CHECK(withheld.link.lost == 1);
  const Record poison = two_agents(1, 1, {}, {forge(Schedule(1, {0}), kInfinity, true)});
  CHECK(poison.estimate == withheld.estimate);
  CHECK(poison.link.refused == 1);
}

TEST_CASE("faults at their extremes equal what they amount to") {
  test::Rng rng(8);
  const Model model = test::scalar_model(rng, 3, 7, 0.98, 0.02, 0.01);
  const Network net = test::connected_network(rng, 7);
  const Matrix y = test::normal_matrix(rng, 20, 7);
  struct Family {
    const char* name;
    ParamMap params;
    bool listens;  // an agent of "lfre" that can observe the state alone does not
  };
  for (const auto& [name, params, listens] :
       {Family{"saturation", {{"threshold", 0.5}}, true}, {"scalar_gain", {}, true}, {"lfre", {}, false}}) {
    CAPTURE(name);
    const auto run = [&](const LinkFaults& faults,
                         std::vector<std::shared_ptr<const MessageAttack>> attacks = {}) {
      RunOptions o;
      o.link = faults;
      o.message_attacks = std::move(attacks);
      return replay(model, net, *make_filter(name, params), y, Matrix(), o);
    };
    const auto perfect = run({});
    const auto harmless = run({}, {forge(Schedule(1, {2, 5}), 0.0, false)});  // a lie that says the truth
    CHECK(same(perfect.estimate, harmless.estimate));
    CHECK(harmless.link.forged > 0);
    const auto lost = run({1.0, 0.0, 1, {}, {}});
    const auto silent = run({}, {silence(Schedule(1, {0, 1, 2, 3, 4, 5, 6}))});
    CHECK(same(lost.estimate, silent.estimate));
    CHECK(lost.link.sent == 0);
    CHECK(lost.link.lost == silent.link.lost);
    CHECK(lost.link.lost > 0);
    const auto bad = run({0.3, 0.3, 2, {}, {}});
    CHECK(same(bad.estimate, run({0.3, 0.3, 2, {}, {}}).estimate));
    if (listens) CHECK(!same(bad.estimate, perfect.estimate));
  }
}
