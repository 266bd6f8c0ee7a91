// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/params.hpp"

#include <doctest/doctest.h>

using namespace garrison;

namespace {

struct Oven {
  double heat = 200.0;
  double door = kNaN;
  int trays = 2;
  bool fan = false;
  std::string mode = "bake";
  std::vector<double> timers;

  static auto fields() {
    return std::make_tuple(
        field(&Oven::heat, {.name = "heat", .least = 0.0, .most = 300.0, .open = true}),
        field(&Oven::door, {.name = "door", .doc = "width", .required = true, .least = 0.0}),
        field(&Oven::trays, {.name = "trays", .least = 1}), field(&Oven::fan, {.name = "fan"}),
        field(&Oven::mode, {.name = "mode", .choices = {"bake", "grill"}}),
        field(&Oven::timers, {.name = "timers", .least = -1.0, .most = 1.0}));
  }
};

Oven parse(ParamMap given) {
  given.insert({"door", 0.5});
  return parse_params<Oven>("oven", given);
}

}  // namespace

TEST_CASE("parameters come from names and values, the rest are defaults") {
  const Oven oven = parse({{"heat", std::int64_t{180}},  // a whole number where a number is asked
                           {"trays", 3.0},               // a number that is whole
                           {"fan", true},
                           {"timers", std::vector<double>{0.5, -1.0}}});
  CHECK(oven.heat == 180.0);
  CHECK(oven.trays == 3);
  CHECK(oven.fan);
  CHECK(oven.mode == "bake");
  const ParamMap back = values(oven);
  CHECK(back.size() == 6);
  CHECK(std::get<std::int64_t>(back.at("trays")) == 3);
  CHECK(values(parse_params<Oven>("oven", back)) == back);
  const auto infos = describe<Oven>();
  CHECK(std::get<double>(infos[0].initial) == 200.0);
  CHECK(std::get<std::int64_t>(infos[2].initial) == 2);
}

TEST_CASE("a wrong value is refused with which, got and expected") {
  const auto says = [](const ParamMap& given, const char* words) {
    CHECK_THROWS_WITH_AS(parse(given), doctest::Contains(words), InvalidInput);
  };
  says({{"heat", 0.0}}, "oven.heat: got 0, expected a number > 0 and <= 300");
  says({{"heat", 301.0}}, "oven.heat: got 301");
  says({{"heat", kNaN}}, "oven.heat: got nan");
  says({{"trays", std::int64_t{0}}}, "oven.trays: got 0, expected a whole number >= 1");
  says({{"trays", 2.5}}, "oven.trays: got 2.5, expected a whole number");
  says({{"trays", 1e300}}, "expected a whole number");
  says({{"fan", 1.0}}, "oven.fan: got 1, expected true or false");
  says({{"mode", std::string("fry")}}, "oven.mode: got \"fry\", expected one of: bake, grill");
  says({{"mode", 3.0}}, "expected a string");
  says({{"timers", std::vector<double>{0.0, 2.0}}}, "oven.timers: got [0, 2]");
  says({{"timers", std::vector<double>{kNaN}}}, "oven.timers: got [nan]");
  CHECK_THROWS_WITH_AS(parse_params<Oven>("oven", {}), doctest::Contains("oven.door: got no value"),
                       InvalidInput);
}

TEST_CASE("a required parameter is given, whatever stands in its place before") {
  struct Kettle {
    int cups = 1;
    static auto fields() {
      return std::make_tuple(field(&Kettle::cups, {.name = "cups", .required = true, .least = 1}));
    }
  };
  CHECK(parse_params<Kettle>("kettle", {{"cups", 3.0}}).cups == 3);
  CHECK_THROWS_WITH_AS(parse_params<Kettle>("kettle", {}), doctest::Contains("kettle.cups: got no value"),
                       InvalidInput);
}

TEST_CASE("an unknown name is refused with the nearest one") {
  CHECK_THROWS_WITH_AS(parse({{"haet", 1.0}}), doctest::Contains("did you mean \"heat\"?"), InvalidInput);
  CHECK_THROWS_WITH_AS(parse({{"temperature_of_the_room", 1.0}}),
                       doctest::Contains("one of: heat, door, trays, fan, mode, timers"), InvalidInput);
  const std::vector<std::string> known{"threshold", "rounds"};
  CHECK(nearest_name("rouns", known) == "rounds");
  CHECK(nearest_name("rnu", std::vector<std::string>{"init", "run"}) ==
        "run");  // exchanged letters are one slip
  CHECK(nearest_name("factor", std::vector<std::string>{"start", "stop"}).empty());
  CHECK(nearest_name("zzzzzzzzzzzzzzzzzzzzz", known).empty());
  CHECK(nearest_name("", known).empty());
}

TEST_CASE("numbers in messages read back the same") {
  for (const double v : {0.1, 1.0, 1e300, -2.5e-7, 1.0 / 3.0, 123456789.125}) CHECK(std::stod(text(v)) == v);
  CHECK(text(1.0) == "1");
  CHECK(text(kNaN) == "nan");
}
