// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/random.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace garrison;

TEST_CASE("philox gives the known answers of Random123") {
  using Counter = std::array<std::uint32_t, 4>;
  const std::uint32_t f = 0xffffffffU;
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox({f, f, f, f}, {f, f}) == Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("uniform and normal numbers have their moments") {
  const Random random(42, 0, Purpose::process);
  constexpr int kCount = 200000;
  double sum = 0.0;
  double square = 0.0;
  double normal_sum = 0.0;
  double normal_square = 0.0;
  double normal_fourth = 0.0;
  double least = 1.0;
  double most = 0.0;
  for (int t = 0; t < kCount; ++t) {
    const double u = random.uniform(t, 3);
    const double z = random.normal(t, 4);
    least = std::min(least, u);
    most = std::max(most, u);
    sum += u;
    square += u * u;
    normal_sum += z;
    normal_square += z * z;
    normal_fourth += z * z * z * z;
  }
  CHECK(least >= 0.0);
  CHECK(most < 1.0);
  CHECK(std::abs(sum / kCount - 0.5) < 0.003);
  CHECK(std::abs(square / kCount - 1.0 / 3.0) < 0.003);
  CHECK(std::abs(normal_sum / kCount) < 0.01);
  CHECK(std::abs(normal_square / kCount - 1.0) < 0.02);
  CHECK(std::abs(normal_fourth / kCount - 3.0) < 0.15);
}

TEST_CASE("a number depends on its whole address and on nothing else") {
  const Random random(7, 2, Purpose::link);
  const double value = random.uniform(5, 6, 7);
  for (int k = 0; k < 10; ++k) random.uniform(k, 1);
  CHECK(random.uniform(5, 6, 7) == value);
  CHECK(Random(7, 2, Purpose::link).uniform(5, 6, 7) == value);
  const std::vector<double> others{Random(8, 2, Purpose::link).uniform(5, 6, 7),
                                   Random(7 + (std::uint64_t{1} << 40), 2, Purpose::link).uniform(5, 6, 7),
                                   Random(7, 3, Purpose::link).uniform(5, 6, 7),
                                   Random(7, 2, Purpose::attack).uniform(5, 6, 7),
                                   Random(7, 2, Purpose::link, 1).uniform(5, 6, 7),
                                   random.uniform(6, 6, 7),
                                   random.uniform(5, 7, 7),
                                   random.uniform(5, 6, 8)};
  for (std::size_t i = 0; i < others.size(); ++i) {
    CHECK(others[i] != value);
    for (std::size_t j = 0; j < i; ++j) CHECK(others[i] != others[j]);
  }
}
