// SPDX-License-Identifier: Apache-2.0
// Statements of a run: our own ones, at the end of every batch, and those of all others, next to each other.
// No memory from the heap after construction.
#pragma once

#include <vector>

#include "garrison/node/statement.hpp"

namespace garrison::node {

/// Threads: one at a time.
class Authors {
 public:
  struct Setup {
    int own = 0;
    SigningKey key{};
    std::uint64_t boot = 0;
    Key run{};
    std::vector<Key> open;        ///< public signing keys by id; zero = nobody has this id
    std::vector<int> neighbours;  ///< whose bodies we see, ascending
    int rounds = 1;
    int batch = 10;  ///< samples that a statement is about, at most; the same on all nodes
  };
  explicit Authors(Setup setup);

  /// A body that goes to all neighbours. True when it is the first one of another batch: the one before is
  /// then in `out`, signed.
  bool said(std::int64_t sample, int round, Bytes body, Statement& out) noexcept;
  /// A body that a neighbour sent.
  void heard(int neighbour, std::int64_t sample, int round, Bytes body) noexcept;

  enum class News { refused, known, fresh, contradiction };
  /// A statement of anybody. fresh and contradiction: others should see it, too. contradiction: with `other`,
  /// for the first time of this sender and start.
  News take(const Statement& statement, Statement& other) noexcept;

  const Key& run() const noexcept { return setup_.run; }
  std::int64_t taken() const noexcept { return taken_; }  ///< genuine ones of others
  std::int64_t contradictions() const noexcept { return contradictions_; }
  /// Statements of neighbours about something else than what they sent to us.
  std::int64_t disowned() const noexcept { return disowned_; }

 private:
  static constexpr std::size_t kKept = 8;  ///< statements of each sender
  struct Leaf {
    std::int64_t sample = -1;
    Key digest{};
  };
  struct Book {
    std::array<Statement, kKept> kept{};
    std::size_t count = 0;
    std::optional<std::uint64_t> convicted = {};  ///< boot that a contradiction was reported of
  };
  Leaf& leaf(std::size_t neighbour, std::int64_t sample, int round) noexcept;
  std::size_t neighbour_of(int id) const noexcept;
  void compare(const Statement& statement) noexcept;

  Setup setup_;
  Statement open_;  ///< our batch that is under way; count 0 = none
  std::vector<Leaf> leaves_;
  std::vector<Book> books_;
  std::int64_t taken_ = 0;
  std::int64_t contradictions_ = 0;
  std::int64_t disowned_ = 0;
};

}  // namespace garrison::node
