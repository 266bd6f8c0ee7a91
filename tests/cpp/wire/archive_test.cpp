// SPDX-License-Identifier: Apache-2.0
// Shapes that no writer makes: what a reader does must not grow with what is only claimed. Optimising
// compilers drop the loop over nothing, builds for sanitizers do not.
#include "garrison/wire/archive.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace garrison;

TEST_CASE("a row-major matrix of four billion empty columns costs nothing to read, a thousand times") {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  constexpr std::uint32_t kRows = 0, kColumns = 0xffffffff;
  std::vector<std::byte> bytes(8);
  wire::store(bytes.data(), kRows);
  wire::store(bytes.data() + 4, kColumns);
  RowMajor matrix;
  for (int k = 0; k < 1000; ++k) REQUIRE(wire::from_bytes(bytes, 1, matrix) == Refusal::none);
  CHECK(matrix.cols() == std::int64_t{kColumns});
}
