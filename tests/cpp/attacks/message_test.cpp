// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/message.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "../agents_by_hand.hpp"
#include "garrison/core/fields.hpp"
#include "garrison/engine/link.hpp"

using namespace garrison;

namespace {

const Random kRandom(3, 0, Purpose::attack);

/// A message of numbers alone.
struct Numbers {
  std::vector<double> values;
  template <class V>
  void visit(V& v) {
    v.numbers("estimate", values);
  }
};

std::vector<double> rewritten(const MessageAttack& attack, const Hop& hop, std::vector<double> values) {
  Numbers message{std::move(values)};
  attack.rewrite(hop, kRandom, FieldList(message));
  return message.values;
}

double length_of_change(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

}  // namespace

TEST_CASE("forge tells everybody the same lie, silence tells nothing") {
  const std::vector<double> x{1.0, -2.0, 3.0};
  const Hop hop{4, 0, 1, 2};
  CHECK(rewritten(*forge(Schedule(1, {1}), 5.0, false), hop, x) == std::vector<double>{6.0, 3.0, 8.0});
  CHECK(rewritten(*forge(Schedule(1, {1}), 5.0, true), hop, x) == std::vector<double>{5.0, 5.0, 5.0});
  CHECK(rewritten(*forge(Schedule(1, {1}), 5.0, false), {9, 3, 1, 7}, x) ==
        std::vector<double>{6.0, 3.0, 8.0});
  Numbers message{x};
  CHECK(!silence(Schedule(1, {1}))->rewrite(hop, kRandom, FieldList(message)));
}

TEST_CASE("equivocation moves by its size in another direction for each receiver and round") {
  const auto attack = equivocate(Schedule(1, {1}), 2.5);
  for (const std::size_t n : {1U, 3U, 9U}) {
    const std::vector<double> x(n, 0.7);
    const auto lie = rewritten(*attack, {4, 0, 1, 2}, x);
    CHECK(length_of_change(lie, x) == doctest::Approx(2.5));
    CHECK(rewritten(*attack, {4, 0, 1, 2}, x) == lie);
    if (n == 1) continue;
    CHECK(rewritten(*attack, {4, 0, 1, 3}, x) != lie);
    CHECK(rewritten(*attack, {4, 1, 1, 2}, x) != lie);
    CHECK(rewritten(*attack, {5, 0, 1, 2}, x) != lie);
  }
  CHECK_THROWS_WITH_AS(equivocate(Schedule(1, {1}), -1.0), doctest::Contains("size: got -1"), InvalidInput);
  CHECK_THROWS_AS(equivocate(Schedule(1, {1}), kNaN), InvalidInput);
}

TEST_CASE("a link lets attacks lie by their schedule, one after the other") {
  const Network net = Network::complete(4);
  const Link link(net, {}, {forge(Schedule(3, {1}, 6), 5.0, false), forge(Schedule(5, {1}), 0.0, true)}, 1,
                  0);
  CHECK(!link.perfect());
  CHECK(link.lies(1));
  CHECK(!link.lies(2));
  const auto said = [&](std::int64_t t, int sender) {
    Numbers message{{1.0}};
    bool changed = false;
    CHECK(link.rewrite({t, 0, sender, 3}, FieldList(message), changed));
    CHECK(changed == (sender == 1 && t >= 3));
    return message.values[0];
  };
  CHECK(said(2, 1) == 1.0);
  CHECK(said(3, 1) == 6.0);
  CHECK(said(3, 2) == 1.0);
  CHECK(said(5, 1) == 0.0);  // the later attack has the last word
  CHECK(said(9, 1) == 0.0);
  const Link chance(net, {}, {forge(Schedule(1, {1}, Schedule::kForever, 0.25), 5.0, false)}, 1, 0);
  int lies = 0;
  for (int t = 1; t <= 8000; ++t) {
    Numbers message{{1.0}};
    bool changed = false;
    chance.rewrite({t, 0, 1, 2}, FieldList(message), changed);
    lies += changed ? 1 : 0;
  }
  CHECK(std::abs(lies - 2000) < 200);
}

TEST_CASE("honest links fail with their probability and the seed decides") {
  const Network net = Network::complete(4);
  const Link link(net, {0.3, 0.5, 4, {}, {}}, {}, 9, 1);
  const Link same(net, {0.3, 0.5, 4, {}, {}}, {}, 9, 1);
  const Link other(net, {0.3, 0.5, 4, {}, {}}, {}, 9, 2);
  int lost = 0;
  int late = 0;
  int different = 0;
  for (int t = 1; t <= 10000; ++t) {
    const Envelope message{t % 4, t, t % 3};
    const auto fate = [&](const Link& of) { return test::fate(of, message, (t + 1) % 4); };
    lost += fate(link) == Fate::lost ? 1 : 0;
    late += fate(link) == Fate::late ? 1 : 0;
    CHECK(fate(link) == fate(same));
    different += fate(link) != fate(other) ? 1 : 0;
  }
  CHECK(std::abs(lost - 3000) < 200);
  CHECK(std::abs(late - 3500) < 200);  // 0.7 * 0.5
  CHECK(different > 1000);
  CHECK(Link(net, {}, {}, 1, 0).perfect());
  CHECK_THROWS_WITH_AS(Link(net, {-0.1, 0.0, 1, {}, {}}, {}, 1, 0), doctest::Contains("link.drop: got -0.1"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(Link(net, {0.0, kNaN, 1, {}, {}}, {}, 1, 0), doctest::Contains("link.delay: got nan"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(Link(net, {0.0, 0.0, 0, {}, {}}, {}, 1, 0),
                       doctest::Contains("link.delay_rounds: got 0"), InvalidInput);
  CHECK_THROWS_WITH_AS(Link(net, {}, {silence(Schedule(1, {4}))}, 1, 0), doctest::Contains("ids in 0..3"),
                       InvalidInput);
}

TEST_CASE("a lie may be about any field, whatever it is") {
  struct Message {
    Vec<2> x{{1.0, 2.0}};
    double bound = 3.0;
    bool intact = true;
    int rest = 4;
    AgentSet proved{5};
    LabelSet labels{3};
    void visit(FieldList& v) {
      v.numbers("estimate", x);
      v.optional("bound", bound);
      v.flag("intact", intact);
      v.count("rest", rest, 9);
      v.set("proved", proved);
      v.labels("labels", labels);
    }
  };
  const auto told = [](const char* field, double value, std::vector<int> members = {}) {
    Message m;
    falsify(Schedule(1, {1}), field, value, std::move(members))->rewrite({4, 0, 1, 2}, kRandom, FieldList(m));
    return m;
  };
  CHECK(told("estimate", 7.0).x == Vec<2>(7.0, 7.0));
  CHECK(told("bound", 0.0).bound == 0.0);
  CHECK(!told("intact", 0.0).intact);
  CHECK(told("rest", 9.0).rest == 9);
  CHECK(told("rest", 10.0).rest == -1);  // no agent could send it: refused by who gets it
  CHECK(told("proved", 0.0, {1, 4}).proved.size() == 2);
  CHECK(told("labels", 0.0, {1, 4}).labels.contains(4));
  CHECK(told("intact", 0.0).x == Vec<2>(1.0, 2.0));
  CHECK_THROWS_WITH_AS(outdated(Schedule(1, {1}), 0), doctest::Contains("outdated.age: got 0"), InvalidInput);
  CHECK_THROWS_AS(falsify(Schedule(1, {1}), "proved", 0.0, {-1}), InvalidInput);
}
