// SPDX-License-Identifier: Apache-2.0
// A set of agent ids that is united with others without allocating.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace garrison {

/// Subset of {0, ..., agents-1}, one bit each. `resize` allocates, nothing else does.
class AgentSet {
 public:
  AgentSet() = default;
  explicit AgentSet(int agents) { resize(agents); }

  void resize(int agents) { words_.assign((static_cast<std::size_t>(agents) + 63) / 64, 0); }
  /// Sized for no agents at all: the family keeps no such set.
  bool empty() const { return words_.empty(); }
  bool contains(int id) const { return (words_[word(id)] >> bit(id)) & 1U; }
  void insert(int id) { words_[word(id)] |= std::uint64_t{1} << bit(id); }
  void clear() {
    for (auto& w : words_) w = 0;
  }
  int size() const {
    int count = 0;
    for (const auto w : words_) count += std::popcount(w);
    return count;
  }
  /// Both sets must have been sized for the same number of agents.
  void unite(const AgentSet& other) {
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] |= other.words_[k];
  }
  bool operator==(const AgentSet&) const = default;

 private:
  static std::size_t word(int id) { return static_cast<std::size_t>(id) / 64; }
  static unsigned bit(int id) { return static_cast<unsigned>(id) % 64; }
  std::vector<std::uint64_t> words_;
};

}  // namespace garrison
