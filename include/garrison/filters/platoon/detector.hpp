// SPDX-License-Identifier: Apache-2.0
// The tests of Algorithm 2 and how its sets are counted.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "garrison/filters/platoon/setting.hpp"

namespace garrison::platoon {

/// Tests compare with a guard of this size relative to the measurements: without noise the threshold of (27)
/// is exactly 0, and rounding alone would fire it.
inline constexpr double kGuard = 1e-12;

inline bool exceeds(double norm, double level, double size) noexcept {
  return norm > level + kGuard * (1.0 + size);
}

/// sqrt(x^2 + y^2) by operations that round alike everywhere, which std::hypot does not.
inline double length(double x, double y) noexcept { return std::sqrt(x * x + y * y); }
inline double length(const double* y) noexcept { return length(y[0], y[1]); }

/// (27): whether y_{i|j} = a and y_{i|k} = b of two sensors `distance` places apart contradict each other: in
/// length by more than 3 mu for neighbours, or in an entry where separate bounds are known.
inline bool contradict(const Setting& s, int distance, const double* a, const double* b) noexcept {
  const Bound level = absolute_noise(s) * 2.0 + relative_noise(s) * distance;
  const double size = length(a) + length(b);
  const double off[2] = {a[0] - b[0], a[1] - b[1]};
  return exceeds(length(off), level.norm, size) || exceeds(std::abs(off[0]), level.position, size) ||
         exceeds(std::abs(off[1]), level.velocity, size);
}

/// g_i of (28), against ||y_ii - xbar_i||, from the bound E on the error of xbar_i: the print has A
/// xhat_i(t-1) in place of xbar_i(t) and so forgets the control input, which accuses clean sensors.
/// `distance` > 0: of y_{i|j}, the measurement of a neighbour at that distance (not in the paper).
inline double innovation_level(const Setting& s, double E, int distance = 0) noexcept {
  return E + reached_noise(s, distance).norm;
}

/// Maximal runs of successive labels in a sorted list.
GARRISON_EXPORT std::vector<std::vector<int>> runs(std::span<const int> sorted);
/// Left side of (29): one attacked sensor makes at most three suspects, so each maximal run of the sorted
/// list has at least ceil(length / 3). (A cut into shorter runs would count too many.)
GARRISON_EXPORT int count_runs(std::span<const int> sorted) noexcept;

/// Pairs (j, k) that fired in the window of one vehicle, and what follows from the knowledge that at most
/// `budget` of the sensors in it are attacked: every attacked set covers all pairs.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class GARRISON_EXPORT Suspicions {
 public:
  /// `size` <= 63 sensors, numbered 0..size-1.
  explicit Suspicions(int size = 0) : size_(size) {}
  void fire(int j, int k) noexcept {
    edges_[static_cast<std::size_t>(j)] |= bit(k);
    edges_[static_cast<std::size_t>(k)] |= bit(j);
    touched_ |= bit(j) | bit(k);
  }
  bool any() const noexcept { return touched_ != 0; }
  std::uint64_t touched() const noexcept { return touched_; }

  struct Verdicts {
    std::uint64_t attacked = 0;  ///< in every cover
    std::uint64_t free = 0;      ///< in no cover
    bool contradiction = false;  ///< no cover exists: more are attacked than assumed
  };
  /// `attacked`, `free`: what is known already. `budget` >= 0: most attacked sensors of the window.
  template <class V>
  void visit(V& v) {
    v.range("size", size_, 0, 2 * kMostRange + 1);
    v("touched", touched_);
    v("edges", edges_);
  }
  Verdicts conclude(std::uint64_t attacked, std::uint64_t free, int budget) const noexcept;

 private:
  static std::uint64_t bit(int k) noexcept { return std::uint64_t{1} << k; }
  /// A cover of all pairs exists that adds at most `budget` of the sensors outside `in` and `out` to `in`.
  bool coverable(std::uint64_t in, std::uint64_t out, int budget) const noexcept;

  int size_;
  std::uint64_t touched_ = 0;
  std::array<std::uint64_t, 2 * kMostRange + 1> edges_{};
};

/// Least number of vertices of a path that cover the edges (e, e+1), e in the sorted list: greedy, exact.
int path_cover(std::span<const int> edges) noexcept;

}  // namespace garrison::platoon
