// SPDX-License-Identifier: Apache-2.0
// A set of agent ids that is united with others without allocating.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace garrison {

/// Subset of {0, ..., agents-1}, one bit each. `resize` allocates, and assigning a set of another size.
/// A single pointer: most filters keep no set, and states are read at every step.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class AgentSet {
 public:
  AgentSet() = default;
  explicit AgentSet(int agents) { resize(agents); }
  AgentSet(const AgentSet& other) { *this = other; }
  AgentSet(AgentSet&&) noexcept = default;
  AgentSet& operator=(AgentSet&&) noexcept = default;
  AgentSet& operator=(const AgentSet& other) {
    if (words() != other.words()) allocate(other.words());
    if (data_ != nullptr) std::copy_n(other.data_.get(), 1 + words(), data_.get());
    return *this;
  }
  ~AgentSet() = default;

  void resize(int agents) { allocate((static_cast<std::size_t>(agents) + 63) / 64); }
  /// Sized for no agents at all: the family keeps no such set.
  bool empty() const { return data_ == nullptr; }
  bool contains(int id) const { return (data_[word(id)] >> bit(id)) & 1U; }
  void insert(int id) { data_[word(id)] |= std::uint64_t{1} << bit(id); }
  void clear() {
    for (std::size_t k = 1; k <= words(); ++k) data_[k] = 0;
  }
  int size() const {
    int count = 0;
    for (std::size_t k = 1; k <= words(); ++k)
      if (data_[k] != 0) count += std::popcount(data_[k]);  // a call where the processor may not have it
    return count;
  }
  /// Both sets must have been sized for the same number of agents.
  void unite(const AgentSet& other) {
    for (std::size_t k = 1; k <= words(); ++k) data_[k] |= other.data_[k];
  }
  /// Of 64 agents each; 0 where there is no set.
  std::size_t words() const { return data_ == nullptr ? 0 : static_cast<std::size_t>(data_[0]); }
  /// Eight agents at a time, from 8 k on, the first one in the lowest bit.
  std::uint8_t byte(int k) const {
    return static_cast<std::uint8_t>(data_[1 + static_cast<std::size_t>(k) / 8] >> (8 * (k % 8)));
  }
  /// Adds the agents of a byte to a set that has none of them.
  void set_byte(int k, std::uint8_t bits) {
    data_[1 + static_cast<std::size_t>(k) / 8] |= std::uint64_t{bits} << (8 * (k % 8));
  }
  bool operator==(const AgentSet& other) const {
    if (words() != other.words()) return false;
    std::uint64_t different = 0;  // of few words, compared at every step: a call costs more than they do
    for (std::size_t k = 1; k <= words(); ++k) different |= data_[k] ^ other.data_[k];
    return different == 0;
  }

 private:
  void allocate(std::size_t words) {
    data_ = words == 0 ? nullptr : std::make_unique<std::uint64_t[]>(1 + words);
    if (words != 0) data_[0] = words;
  }
  static std::size_t word(int id) { return 1 + static_cast<std::size_t>(id) / 64; }
  static unsigned bit(int id) { return static_cast<unsigned>(id) % 64; }

  std::unique_ptr<std::uint64_t[]> data_;  // the number of words, then the words
};

}  // namespace garrison
