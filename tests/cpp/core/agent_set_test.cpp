// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/agent_set.hpp"

#include <doctest/doctest.h>

#include <set>

#include "../random_system.hpp"

using namespace garrison;

TEST_CASE("an agent set behaves as a set, also across words") {
  test::Rng rng(1);
  for (const int agents : {1, 63, 64, 65, 128, 200}) {
    AgentSet a(agents);
    AgentSet b(agents);
    std::set<int> in_a;
    std::set<int> in_b;
    for (int k = 0; k < agents; ++k) {
      const int i = test::whole(rng, 0, agents - 1);
      const int j = test::whole(rng, 0, agents - 1);
      a.insert(i);
      in_a.insert(i);
      b.insert(j);
      in_b.insert(j);
    }
    CAPTURE(agents);
    CHECK(a.size() == static_cast<int>(in_a.size()));
    CHECK((a == b) == (in_a == in_b));
    const AgentSet before = a;
    a.unite(b);
    in_a.insert(in_b.begin(), in_b.end());
    CHECK(a.size() == static_cast<int>(in_a.size()));
    for (int i = 0; i < agents; ++i) CHECK(a.contains(i) == (in_a.count(i) == 1));
    AgentSet again = a;
    again.unite(before);
    CHECK(again == a);
    a.clear();
    CHECK(a.size() == 0);
    CHECK(!a.empty());  // sized, but nobody is in it
  }
  CHECK(AgentSet().empty());
  CHECK(AgentSet(0).empty());
  CHECK(AgentSet().size() == 0);
}
