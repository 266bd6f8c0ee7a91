// SPDX-License-Identifier: Apache-2.0
// The numbers of a few agents, side by side.
#pragma once

#include <algorithm>
#include <array>
#include <memory>

#include "garrison/filters/partial_sharing/covariance.hpp"
#include "garrison/kernel/aligned.hpp"

namespace garrison::partial_sharing {

/// Agents of a group: the doubles of a cache line, and of the widest register.
inline constexpr int kGroup = 8;

/// Entry by entry, each with a lane per agent; matrices symmetric or lower triangular and packed, the others
/// row by row. An agent on its own has a group of one and seven idle lanes, whose numbers are zeros; so are
/// the rows that an agent has not.
template <int n>
struct Group {
  static constexpr int kLanes = n == Dynamic ? 1 : kGroup;

  /// Memory of a group, in pieces of what is read together. For a whole network every piece is one array.
  enum Piece { kSample, kSensors, kGains, kCovariances, kPieces };
  using Room = std::array<double*, kPieces>;

  /// `room`: `size` doubles of every piece on cache lines, and `predictions`: room for those of all lanes,
  /// agent by agent. A group of one has its own.
  Group(int states, int most_outputs, const Room& room, double* predictions)
      : m(states), q(most_outputs), x(predictions) {
    place(room);
  }
  Group(int states, int most_outputs) : m(states), q(most_outputs) {
    std::size_t sum = 0;
    for (int piece = 0; piece < kPieces; ++piece) sum += size(m, q, Piece(piece));
    own_.resize(sum + static_cast<std::size_t>(2 * m));
    Room room;
    x = own_.data();
    for (int piece = 0; piece < kPieces; ++piece) {
      room[static_cast<std::size_t>(piece)] = x;
      x += size(m, q, Piece(piece));
    }
    place(room);
  }
  Group(Group&&) = default;
  Group& operator=(Group&&) = delete;

  /// Number `k` of an array, e.g. (C, r * m + k), of one agent.
  static double& at(double* array, int k, int lane) {
    return array[static_cast<std::ptrdiff_t>(k) * kLanes + lane];
  }
  /// Prediction of the next sample of one agent.
  double* prediction(int lane) const { return x + static_cast<std::ptrdiff_t>(lane) * m; }

  /// Of a group of one: m numbers for whoever updates it.
  double* room_for_one() { return x + m; }

  /// Few outputs at a known dimension work on the stack.
  static constexpr bool on_stack(int m, int q) { return n != Dynamic && q <= m; }
  /// Doubles of a piece.
  static std::size_t size(int m, int q, Piece piece) {
    const int scratch = Recursion<n, 1>::scratch(m) + q * Recursion<n, 1>::scratch_per_row(m) + 4 * m + 2 * q;
    const int sizes[kPieces] = {q + m, q * m + packed(q), packed(m) + q * m,
                                packed(m) + (on_stack(m, q) ? 0 : scratch)};
    return static_cast<std::size_t>(sizes[piece] * kLanes);
  }

  void read_own_sensors() {
    C = own_sensors_;
    W = C + static_cast<std::ptrdiff_t>(q * m) * kLanes;
  }
  /// Makes C and W those of another group, which are the same numbers.
  void read_sensors_of(const Group& other) {
    C = other.C;
    W = other.W;
  }
  /// Makes G and K those of another group, if both are at rest with the same numbers.
  void read_gains_of(const Group& other) {
    const std::size_t count = size(m, q, kGains);
    if (G == other.G || moving() || other.moving() || !std::equal(G, G + count, other.G)) return;
    G = other.G;
    K = other.K;
  }
  void read_own_gains() {
    G = own_gains_;
    K = G + static_cast<std::ptrdiff_t>(packed(m)) * kLanes;
  }

  /// Whether some gains still change.
  bool moving() const { return (frozen & all(agents)) != all(agents); }
  bool is_frozen(int lane) const { return (frozen >> lane & 1U) != 0; }
  void set_frozen(int lane, bool is) {
    const unsigned bit = 1U << lane;
    frozen = is ? frozen | bit : frozen & ~bit;
  }
  /// A bit for each of so many lanes.
  static unsigned all(int lanes) { return (1U << lanes) - 1U; }

  const int m;
  const int q;  ///< most outputs of an agent
  double* y;    ///< measurements, then innovations; NaN: missing
  double* z;    ///< estimate
  double* C;    ///< H_i
  double* W;    ///< inverse of the Cholesky factor of R_i
  double* G;    ///< once frozen: gamma times the filtered covariance; where gains never freeze: P(k)
  double* K;    ///< once frozen: gain of the innovations, row by row of measurements
  double* P;    ///< P(k+1)
  double* scratch;
  double* x;  ///< predictions of the next sample, agent by agent
  int agents = 1;
  std::array<int, std::size_t{kLanes}> outputs{};  ///< of each agent; set by whoever makes a group of several
  bool even = false;                               ///< every lane is an agent with q outputs
  unsigned frozen = 0;                             ///< a bit per lane
  bool started = false;
  bool follows = false;  ///< gains never freeze, and may follow a plant that changes

 private:
  void place(const Room& room) {
    const auto lanes = [](int count) { return static_cast<std::ptrdiff_t>(count) * kLanes; };
    y = room[kSample];
    z = y + lanes(q);
    own_sensors_ = room[kSensors];
    read_own_sensors();
    own_gains_ = room[kGains];
    read_own_gains();
    P = room[kCovariances];
    scratch = P + lanes(packed(m));
  }

  Aligned<double> own_;  // of a group of one
  double* own_sensors_ = nullptr;
  double* own_gains_ = nullptr;
};

}  // namespace garrison::partial_sharing
