// SPDX-License-Identifier: Apache-2.0
// Sums of matrices in blocks: the bits of one number after the other, for any number of states and any
// register.
#include "garrison/filters/structural/spread.hpp"

#include <doctest/doctest.h>

#include <random>
#include <vector>

#include "garrison/kernel/isa.hpp"

using namespace garrison;
using Numbers = std::vector<double>;

namespace {

struct Blocks {
  template <int B>
  GARRISON_INLINE static void run(const Numbers* L, const Numbers* S, int n, Numbers* out) noexcept {
    Numbers half(out->size());
    structural::add_congruence<B, Dynamic>(L->data(), S->data(), n, half.data(), out->data());
    structural::add_outer<B, Dynamic>(L->data(), S->data(), 0.3, n, out->data());
  }
};
struct Covariance {
  template <int B>
  GARRISON_INLINE static void run(const Numbers* S, int n, bool* is) noexcept {
    *is = structural::is_covariance<B, Dynamic>(S->data(), 1.0, 1e16, n);
  }
};

/// out + L S L' + 0.3 a b', a and b the first columns of L and S; matrices column by column.
Numbers by_hand(const Numbers& L, const Numbers& S, int n, Numbers out) {
  const auto at = [n](int i, int j) { return static_cast<std::size_t>(i * n + j); };
  Numbers half(out.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      half[at(i, j)] = L[at(0, i)] * S[at(0, j)];
      for (int k = 1; k < n; ++k) half[at(i, j)] += L[at(k, i)] * S[at(k, j)];
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) out[at(i, j)] += half[at(i, k)] * L[at(k, j)];
      out[at(i, j)] += 0.3 * L[at(0, i)] * S[at(0, j)];
    }
  return out;
}

}  // namespace

TEST_CASE("sums of matrices in blocks have the bits of one number after the other") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int n = 1; n <= 19; ++n) {
    Numbers L(static_cast<std::size_t>(n * n));
    Numbers S = L;
    Numbers start = L;
    for (auto* numbers : {&L, &S, &start})
      for (double& x : *numbers) x = normal(random);
    const Numbers expected = by_hand(L, S, n, start);
    Numbers wide = start;
    run_widest<Blocks, const Numbers*, const Numbers*>(&L, &S, n, &wide);
    CHECK(wide == expected);
    Numbers narrow = start;
    detail::run_two<Blocks, const Numbers*, const Numbers*>(&L, &S, n, &narrow);
    CHECK(narrow == expected);
  }
}

TEST_CASE("one entry that no covariance has is found wherever it is") {
  for (int n = 1; n <= 19; ++n) {
    const auto size = static_cast<std::size_t>(n);
    Numbers S(size * size);
    for (std::size_t k = 0; k < size; ++k) S[k * (size + 1)] = 1.0;
    bool is = false;
    run_widest<Covariance, const Numbers*>(&S, n, &is);
    CHECK(is);
    for (double& entry : S) {
      const double before = entry;
      entry = 1.1e16;
      run_widest<Covariance, const Numbers*>(&S, n, &is);
      CHECK_FALSE(is);
      entry = before;
    }
  }
}
