// SPDX-License-Identifier: Apache-2.0
// The numbers of a few agents, side by side.
#pragma once

#include <algorithm>
#include <array>
#include <memory>

#include "garrison/core/aligned.hpp"
#include "garrison/filters/partial_sharing/covariance.hpp"

namespace garrison::partial_sharing {

/// Agents of a group: the doubles of a cache line, and of the widest register.
inline constexpr int kGroup = 8;

/// Entry by entry, each with a lane per agent; matrices symmetric or lower triangular and packed, the others
/// row by row. An agent on its own has a group of one and seven idle lanes, whose numbers are zeros; so are
/// the rows that an agent has not.
template <int n>
struct Group {
  static constexpr int kLanes = n == Dynamic ? 1 : kGroup;

  /// `room`: `size` doubles on a cache line, and `predictions`: room for those of all lanes, agent by agent.
  /// A group of one has its own.
  Group(int states, int most_outputs, double* room = nullptr, double* predictions = nullptr)
      : m(states),
        q(most_outputs),
        G(0),
        K(G + packed(m)),
        C(K + q * m),
        W(C + q * m),
        y(W + packed(q)),
        z(y + q),
        P(z + m),
        scratch(P + packed(m)),
        own_(room == nullptr ? size(m, q) + static_cast<std::size_t>(2 * m) : 0),
        room_(room == nullptr ? own_.data() : room),
        x(predictions == nullptr ? room_ + size(m, q) : predictions) {}
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

  /// Number `k` of an array, e.g. (C, r * m + k), in all lanes.
  double* at(int array, int k = 0) { return room_ + static_cast<std::ptrdiff_t>(array + k) * kLanes; }
  double& at(int array, int k, int lane) { return at(array, k)[lane]; }
  /// Prediction of the next sample of one agent.
  double* prediction(int lane) const { return x + static_cast<std::ptrdiff_t>(lane) * m; }

  /// Of a group of one: m numbers for whoever updates it.
  double* room_for_one() { return x + m; }

  /// Few outputs at a known dimension work on the stack.
  static constexpr bool on_stack(int m, int q) { return n != Dynamic && q <= m; }
  /// Doubles of a group.
  static std::size_t size(int m, int q) {
    const int kept = 2 * packed(m) + 2 * q * m + packed(q) + q + m;
    const int scratch = Recursion<n, 1>::scratch(m) + q * Recursion<n, 1>::scratch_per_row(m) + 4 * m + q;
    return static_cast<std::size_t>((kept + (on_stack(m, q) ? 0 : scratch)) * kLanes);
  }

  const int m;
  const int q;  ///< most outputs of an agent
  // What frozen agents need is in one piece, and so is what all others need.
  const int G;  ///< once frozen: gamma times the filtered covariance
  const int K;  ///< once frozen: gain of the whitened innovations, row by row of measurements
  const int C;  ///< H_i
  const int W;  ///< inverse of the Cholesky factor of R_i
  const int y;  ///< measurements, then innovations; NaN: missing
  const int z;  ///< estimate
  const int P;  ///< P(k+1)
  const int scratch;

 private:
  Aligned<double> own_;  // of a group of one
  double* room_;

 public:
  double* x;  ///< predictions of the next sample, agent by agent
  int agents = 1;
  std::array<int, kLanes> outputs{};  ///< of each agent; set by whoever makes a group of several
  std::array<bool, kLanes> frozen{};
  bool started = false;
};

}  // namespace garrison::partial_sharing
