// SPDX-License-Identifier: Apache-2.0
#include "garrison/kernel/chances.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace garrison;

TEST_CASE("many events at once are those of one after the other, for any count and probability") {
  const Random random(0x123456789abcdefULL, 77, Purpose::link);
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<std::uint32_t> address;
    for (std::size_t e = 0; e < count; ++e)
      address.push_back(static_cast<std::uint32_t>(e * 0x9E3779B1U + count));
    for (const double probability : {0.0, 0x1.0p-53, 0.1, 0.3, 0.5, 1.0 - 0x1.0p-53, 1.0})
      for (const std::int64_t time : {std::int64_t{0}, std::int64_t{41}, std::int64_t{0x1ffffffff}}) {
        std::vector<std::uint8_t> out(count + 1, 7);
        happen(random, time, address.data(), 5, probability, count, out.data());
        for (std::size_t e = 0; e < count; ++e)
          CHECK((out[e] != 0) == (random.uniform(time, address[e], 5) < probability));
        CHECK(out[count] == 7);                   // nothing is written behind the end
        std::vector<std::uint8_t> narrow(count);  // as on a machine without wide registers
        const auto limit = static_cast<std::uint64_t>(std::ceil(std::ldexp(probability, 53)));
        detail::run_two<detail::Happen>(&random, time, address.data(), 5U, limit, count, narrow.data());
        CHECK(std::equal(narrow.begin(), narrow.end(), out.begin()));
      }
  }
}
