// SPDX-License-Identifier: Apache-2.0
// Sensor lines, their units and limits; the newest of sufficient age.
#include "node/daemon/sensor.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <thread>

#include "folder.hpp"
#include "garrison/core/error.hpp"
#include "garrison/node/crypto.hpp"
#include "mutants.hpp"
#include "node/daemon/files.hpp"
#include "node/daemon/ring.hpp"
#include "node/daemon/service.hpp"

using namespace garrison;
using namespace garrison::node;
using namespace garrison::node::test;

TEST_CASE("a line is as many numbers as there are outputs, with a time or without") {
  CHECK(parse_line("1.5 -2e3", 2)->y == std::vector{1.5, -2000.0});
  CHECK(parse_line(" +1,2 \r\n", 2)->y == std::vector{1.0, 2.0});
  CHECK(std::isnan(parse_line("nan 1", 2)->y[0]));
  CHECK(*parse_line("@12.25 1", 1)->taken == 12'250'000);
  for (const char* bad : {"", "1", "1 2 3", "1 x", "1 inf", "@x 1 2", "@1e300 1 2", "1 @3 2", "0x10 1",
                          "1 2 @3", "@1 @2 3", "1,,2", ",1"})
    CHECK(!parse_line(bad, 2));
}

TEST_CASE("mutated lines are numbers or nothing") {
  std::mt19937_64 random(3);
  int taken = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto found = parse_line(mutated("@1700000000.25 1.5 -2.25e-3 nan", random), 3);
    taken += found ? 1 : 0;
    if (!found) continue;
    CHECK(found->y.size() == 3);
    for (const double y : found->y) CHECK(!std::isinf(y));
  }
  CHECK(taken > 500);
}

TEST_CASE("units, limits and age") {
  SensorSettings settings;
  settings.source = SensorSettings::Source::socket;
  settings.scale = {2.0, 1.0};
  settings.offset = {1.0, 0.0};
  settings.least = {-10, -10};
  settings.most = {10, 10};
  settings.max_age = 500;
  Sensor sensor(settings, 2, "node.toml");
  std::array<double, 2> y{};
  sensor.measure(1, 1000, y);
  CHECK(std::isnan(y[0]));  // nothing yet
  sensor.line("3 11", 1000);
  sensor.measure(1, 1400, y);
  CHECK(y[0] == 4.0);
  CHECK(std::isnan(y[1]));
  CHECK(sensor.counters().outside == 1);
  sensor.measure(1, 1501, y);
  CHECK(std::isnan(y[0]));  // too old
  sensor.measure(1, 999, y);
  CHECK(std::isnan(y[0]));  // of the future
  sensor.line("what", 2000);
  CHECK(sensor.counters().malformed == 1);
  settings.scale = {1.0};
  CHECK_THROWS_AS(Sensor(settings, 2, "node.toml"), InvalidInput);
}

TEST_CASE("a table has a row a sample, from the first sample on") {
  const Folder folder;
  const std::string table = "1,2\n3,nan\n";
  replace_file(folder / "y.csv", text_bytes(table));
  SensorSettings settings;
  settings.source = SensorSettings::Source::file;
  settings.path = folder / "y.csv";
  const Sensor sensor(settings, 2, "node.toml");
  std::array<double, 2> y{};
  sensor.measure(2, 0, y);
  CHECK(y[0] == 3.0);
  CHECK(std::isnan(y[1]));
  for (const std::int64_t none : {std::int64_t{0}, std::int64_t{3}, INT64_MAX, INT64_MIN}) {
    sensor.measure(none, 0, y);
    CHECK(std::isnan(y[0]));
  }
  CHECK(sensor.counters().taken == 1);  // a row that a sample came to
  CHECK_THROWS_WITH_AS(Sensor(settings, 3, "node.toml"), doctest::Contains("line 1"), InvalidInput);
  const std::string zeros("1,2\n\0\x1b[1m\n", 11);
  replace_file(folder / "y.csv", text_bytes(zeros));
  CHECK_THROWS_WITH_AS(Sensor(settings, 2, "node.toml"),
                       doctest::Contains(R"(line 2: got "\x00\x1b[1m", expected)"), InvalidInput);
}

TEST_CASE("the machine itself: load, clock, temperature and traffic") {
  SensorSettings settings;
  settings.source = SensorSettings::Source::procfs;
  settings.read = {"load", "clock", "net:lo", "temp:zone999"};
  settings.max_age = INT64_MAX / 2;
  Sensor sensor(settings, 4, "node.toml");
  std::array<double, 4> y{};
  sensor.tick(0);
  sensor.measure(1, garrison::node::now().wall, y);
  CHECK(y[0] >= 0.0);
  CHECK(std::isfinite(y[1]));
  CHECK(std::isnan(y[2]));  // a rate needs two readings
  CHECK(std::isnan(y[3]));  // there is no such zone
  sensor.tick(50'000);      // not yet
  CHECK(sensor.counters().taken == 1);
  sensor.tick(1'000'000);
  sensor.measure(1, garrison::node::now().wall, y);
  CHECK(sensor.counters().taken == 2);
  CHECK(y[2] >= 0.0);
  CHECK_THROWS_WITH_AS(Sensor(settings, 3, "node.toml"), doctest::Contains("4 names"), InvalidInput);
  for (const char* bad : {"", "lod", "temp:zone", "temp:zone1/../2", "net:", "net:..", "net:a/b"})
    CHECK_THROWS_WITH_AS(Machine("[sensor].read", {bad}), doctest::Contains("expected \"load\""),
                         InvalidInput);
}

TEST_CASE("lines of a command, which is started again when it ends") {
  SensorSettings settings;
  settings.source = SensorSettings::Source::lines;
  settings.command = "echo 1.25; echo nonsense; echo 2.5";
  settings.max_age = INT64_MAX / 2;
  Sensor sensor(settings, 1, "node.toml");
  sensor.tick(0);
  for (int k = 0; k < 500 && sensor.descriptor() >= 0; ++k) {
    sensor.readable(1);
    ::usleep(10'000);
  }
  CHECK(sensor.counters().taken == 2);
  CHECK(sensor.counters().malformed == 1);
  CHECK(sensor.descriptor() < 0);
  sensor.tick(10);  // not yet
  CHECK(sensor.descriptor() < 0);
  sensor.tick(2'000'000);
  CHECK(sensor.counters().restarts == 1);
  CHECK(sensor.descriptor() >= 0);
}

TEST_CASE("ring: records come out as they went in, whole or not at all") {
  Ring ring(1 << 12);
  std::thread writer([&] {
    std::vector<std::byte> record(600);
    for (std::uint32_t k = 0; k < 20000;) {
      const std::size_t size = 4 + k % 500;
      wire::store(record.data(), k);
      std::fill(record.begin() + 4, record.begin() + static_cast<std::ptrdiff_t>(size),
                static_cast<std::byte>(k));
      if (ring.put(static_cast<std::uint8_t>(k),
                   {Bytes(record).first(4), Bytes(record).subspan(4, size - 4)}))
        ++k;
      else
        std::this_thread::yield();
    }
  });
  std::vector<std::byte> room;
  std::uint32_t next = 0;
  bool right = true;
  while (next < 20000) {
    const bool found = ring.take(room, [&](std::uint8_t kind, Bytes content) {
      right &= kind == static_cast<std::uint8_t>(next) && content.size() == 4 + next % 500 &&
               wire::load<std::uint32_t>(content.data()) == next &&
               std::all_of(content.begin() + 4, content.end(),
                           [&](std::byte b) { return b == static_cast<std::byte>(next); });
      ++next;
    });
    if (!found) std::this_thread::yield();
  }
  writer.join();
  CHECK(right);
}
