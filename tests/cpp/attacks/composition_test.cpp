// SPDX-License-Identifier: Apache-2.0
// Attacks in a list act in its order, on what the one before left.
#include <doctest/doctest.h>

#include "garrison/attacks/registry.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

const Model kModel(Matrix::Ones(1, 1), std::vector<Matrix>(3, Matrix::Ones(1, 1)));

/// Measurements that the filter received, [trial][time 1..6][agent], when every true one is 1.
Bulk<double> received(const std::vector<Attack>& attacks, int trials = 1, std::uint64_t seed = 1) {
  RunOptions o;
  o.attacks = attacks;
  o.trials = trials;
  o.seed = seed;
  return replay(kModel, Network::path(3), *make_filter("scalar_gain", {}), Matrix::Ones(6, 3), Matrix(), o)
      .measurements;
}

}  // namespace

TEST_CASE("the order of a list matters") {
  const Schedule one(2, {1});
  const auto a = received({bias(one, 5.0), scale(one, 2.0)});
  const auto b = received({scale(one, 2.0), bias(one, 5.0)});
  CHECK(a[0 * 3 + 1] == 1.0);  // before the start
  CHECK(a[1 * 3 + 1] == 12.0);
  CHECK(b[1 * 3 + 1] == 7.0);
  for (std::size_t t = 0; t < 6; ++t) {
    CHECK(a[t * 3] == 1.0);
    CHECK(a[t * 3 + 2] == 1.0);
  }
  CHECK(std::isnan(received({denial(one), bias(one, 5.0)})[1 * 3 + 1]));
  CHECK(received({denial(one), constant(one, 4.0)})[1 * 3 + 1] == 4.0);
}

TEST_CASE("phases hand over and stop") {
  const Schedule moving(std::vector<Schedule::Phase>{{2, {0}}, {4, {1, 2}}}, 6);
  const auto y = received({ramp(moving, 1.0)});
  CHECK(y == Bulk<double>{1, 1, 1, 2, 1, 1, 3, 1, 1, 1, 2, 2, 1, 3, 3, 1, 1, 1});
}

TEST_CASE("equal recipes in one list and trials of one run have chances of their own") {
  const Schedule one(1, {0, 1});
  const Attack noise = random_noise(one, "normal", 1.0, true);
  const auto once = received({noise});
  CHECK(received({noise}) == once);
  CHECK(received({noise}, 1, 2) != once);
  CHECK(received({noise, noise}) != once);
  CHECK(once[0] != once[1]);  // agents differ
  CHECK(once[0] != once[3]);  // times differ
  const auto trials = received({noise}, 2);
  CHECK(Bulk<double>(trials.begin(), trials.begin() + 18) == once);
  CHECK(Bulk<double>(trials.begin() + 18, trials.end()) != once);
}

TEST_CASE("an attack on an agent without outputs or beyond the network") {
  const Model relay(Matrix::Ones(1, 1), {Matrix::Ones(1, 1), Matrix(0, 1), Matrix::Ones(2, 1)});
  RunOptions o;
  o.attacks = {bias(Schedule(1, {1, 2}), 5.0)};
  const auto filter = make_filter("scalar_gain", {});
  const auto record = replay(relay, Network::path(3), *filter, Matrix::Ones(1, 3), Matrix(), o);
  CHECK(record.measurements == Bulk<double>{1.0, 6.0, 6.0});
  o.attacks = {bias(Schedule(1, {3}), 5.0)};
  CHECK_THROWS_WITH_AS(replay(relay, Network::path(3), *filter, Matrix::Ones(1, 3), Matrix(), o),
                       doctest::Contains("ids in 0..2"), InvalidInput);
}
