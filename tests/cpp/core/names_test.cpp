// SPDX-License-Identifier: Apache-2.0
// Names and units of states, measurements and agents; equality; sizes that do not fit into memory.
#include <doctest/doctest.h>

#include <cstdlib>
#include <limits>

#include "garrison/attacks/registry.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/split_outputs.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/filters/families.hpp"

using namespace garrison;

namespace {

Model model(Labels labels) {
  return {Matrix::Identity(2, 2), {Matrix::Identity(2, 2), Matrix::Ones(1, 2)}, {}, {}, std::move(labels)};
}

}  // namespace

TEST_CASE("labels fit the model or are refused") {
  CHECK(model({}).state_names() == std::vector<std::string>{"x1", "x2"});
  const Model named = model({.states = {"height", "speed"},
                             .outputs = {"gauge", "log", "sum"},
                             .sources = {"box", "box", "ship"},
                             .units = {{"height", "m"}, {"sum", "m"}}});
  CHECK(named.state_names()[1] == "speed");
  CHECK(named.labels().units.at("sum") == "m");
  CHECK_THROWS_WITH_AS(model({.states = {"a"}}), doctest::Contains("states: got 1 name, expected 2"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(model({.states = {"a", "a"}}), doctest::Contains("states[1]: got \"a\" once more"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(model({.outputs = {"a", "", "c"}}), doctest::Contains("outputs[1]: got an empty name"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(model({.sources = {"a"}}), doctest::Contains("sources: got 1 name, expected 3"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(model({.units = {{"x3", "m"}}}), doctest::Contains("unknown name \"x3\""),
                       InvalidInput);
}

TEST_CASE("models and networks are equal by value, unknown bounds included") {
  CHECK(model({}) == model({}));
  CHECK_FALSE(model({}) == model({.states = {"a", "b"}}));
  const Model known(Matrix::Identity(2, 2), {Matrix::Identity(2, 2), Matrix::Ones(1, 2)}, {0.1, {}, {}, {}});
  CHECK_FALSE(model({}) == known);
  CHECK(Network::ring(3) == Network::complete(3));
  const std::vector<Edge> edges{{0, 1}};
  CHECK_FALSE(Network(2, edges) == Network(2, edges, true));
  CHECK_FALSE(Network(2, edges) == Network(2, edges, false, {"a", "b"}));
  CHECK_THROWS_WITH_AS(Network(2, edges, false, {"a"}), doctest::Contains("names: got 1 name, expected 2"),
                       InvalidInput);
}

TEST_CASE("an agent per output: names go along") {
  const std::vector<Edge> edges{{0, 1}};
  const Network network(2, edges, false, {"DUB", "VAL"});
  const Labels labels{.outputs = {"gauge", "log", "sum"}, .sources = {"box", "box", "ship"}};
  const SplitSystem split = split_outputs(model(labels), network);
  CHECK(split.network.names() == std::vector<std::string>{"DUB:gauge", "DUB:log", "VAL"});
  CHECK(split.model.labels() == labels);
  CHECK(split_outputs(model({}), network).network.names()[1] == "DUB:2");
  CHECK(split_outputs(model({}), Network(2, edges)).network.names().empty());
}

TEST_CASE("sizes that do not fit into memory are refused before anything is allocated") {
  const int most = std::numeric_limits<int>::max();
  REQUIRE(setenv("GARRISON_MEMORY_GB", "0.001", 1) == 0);
  CHECK_THROWS_WITH_AS(Network::ring(most), doctest::Contains("GARRISON_MEMORY_GB"), InvalidInput);
  CHECK_THROWS_AS(Network::complete(100000), InvalidInput);
  CHECK_THROWS_AS(Network::grid(most, most), InvalidInput);
  CHECK_THROWS_AS(Network::random_geometric(100000, 1.0, 1), InvalidInput);
  CHECK_THROWS_AS(Network::path(5000).laplacian(), InvalidInput);
  REQUIRE(setenv("GARRISON_MEMORY_GB", "much", 1) == 0);
  CHECK_THROWS_WITH_AS(memory_limit(), doctest::Contains("GARRISON_MEMORY_GB: got \"much\""), InvalidInput);
  REQUIRE(unsetenv("GARRISON_MEMORY_GB") == 0);
  CHECK(memory_limit() > 1e8);
  CHECK(Network::complete(100).edges().size() == 4950);
}

TEST_CASE("the registry is the list of families") {
  std::size_t k = 0;
  REQUIRE(families().size() == Families::size);
  Families::each([&]<class F> {
    CHECK(families()[k++].name == F::name);
    CHECK(F::signal_names().size() == F::signal_count);  // engines keep room for so many
  });
}

TEST_CASE("an attack remembers its schedule and its parameters") {
  const Schedule schedule({{3, {2, 1}}, {5, {4}}}, 9, 0.25);
  const AnyAttack attack = make_attack("sinusoid", schedule, {{"amplitude", 2.0}});
  CHECK(std::get<double>(attack.params.at("amplitude")) == 2.0);
  CHECK(std::get<double>(attack.params.at("period")) == 20.0);
  CHECK(attack.schedule().phases()[0].agents == std::vector<int>{1, 2});
  CHECK(attack.schedule().stop() == 9);
  CHECK(attack.schedule().probability() == 0.25);
  const AnyAttack number = make_attack("constant", Schedule(1, {0}), {{"value", std::int64_t{5}}});
  CHECK(std::get<std::string>(number.params.at("value")) == "5");
}
