// SPDX-License-Identifier: Apache-2.0
// What the ranks of one run tell each other. Transport only: no arithmetic that could depend on an order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace garrison::partition {

/// Who gets how much: agents that this rank sends to each peer and receives from it, peers in ascending
/// order. What is sent lies peer by peer, one record per agent; so does what is received.
struct Routes {
  std::vector<int> peers;
  std::vector<int> sends;
  std::vector<int> receives;
};

/// Ranks are numbered from 0; all of them make the same calls in the same order.
/// Threads: one at a time.
class Exchange {
 public:
  virtual ~Exchange() = default;
  virtual int rank() const = 0;
  virtual int ranks() const = 0;
  /// Before the first `begin`; again with the same routes changes nothing.
  virtual void connect(const Routes& routes) = 0;
  /// Starts to send `out` and to receive `in`: a record of `bytes` per agent of the routes. Neither may be
  /// touched before `finish`.
  virtual void begin(const std::byte* out, std::byte* in, std::size_t bytes) = 0;
  virtual void finish() = 0;
  /// Sums over all ranks, in place; exact in any order.
  virtual void sum(std::span<std::int64_t> values) = 0;
  /// Largest of all ranks, in place; exact in any order. No NaN.
  virtual void largest(std::span<double> values) = 0;
};

/// A run on one rank.
class Alone final : public Exchange {
 public:
  int rank() const override { return 0; }
  int ranks() const override { return 1; }
  void connect(const Routes&) override {}
  void begin(const std::byte*, std::byte*, std::size_t) override {}
  void finish() override {}
  void sum(std::span<std::int64_t>) override {}
  void largest(std::span<double>) override {}
};

}  // namespace garrison::partition
