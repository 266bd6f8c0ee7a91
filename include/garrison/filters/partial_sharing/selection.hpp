// SPDX-License-Identifier: Apache-2.0
// Which entries of its estimate every agent shares, and when.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::partial_sharing {

/// Index lists of the shared entries at k = 0; after every sample all of them move on by `shift`
/// (right-circular shift: entry a goes to a + shift mod m). The list of k = 0 is used at k = 0.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class GARRISON_EXPORT Selection {
 public:
  Selection() = default;
  /// `start`: N x m of zeros and ones, s_i(0) in row i; `shift` is tau, any whole number.
  /// @throws InvalidInput when an entry is neither 0 nor 1
  Selection(const MatrixRef& start, std::int64_t shift);
  /// Every agent starts with its own random subset ("uncoordinated"), or all with the entries 0, 1, .. .
  /// `shared`: l_i per agent, 1..m. `ids`: which agents of a larger network these are, ascending; empty = the
  /// first ones. @throws InvalidInput when some l_i is not
  static Selection random(int states, std::span<const int> shared, std::int64_t shift, std::uint64_t seed,
                          std::span<const int> ids = {});
  static Selection coordinated(int states, std::span<const int> shared, std::int64_t shift);

  int agents() const { return static_cast<int>(first_.size()) - 1; }
  int states() const { return states_; }
  /// tau mod m
  int shift() const { return shift_; }
  /// Entries of agent i at k = 0, sorted; k samples later entry a has become (a + offset(k)) mod m.
  std::span<const int> entries(int agent) const {
    const auto i = static_cast<std::size_t>(agent);
    const auto begin = static_cast<std::size_t>(first_[i]);
    return std::span(entries_).subspan(begin, static_cast<std::size_t>(first_[i + 1]) - begin);
  }
  int shared(int agent) const { return static_cast<int>(entries(agent).size()); }
  int offset(std::int64_t k) const {
    const auto rest = static_cast<int>(((k % period_) + period_) % period_);
    return rest * shift_ % states_;
  }

  /// m / gcd(m, tau mod m); 1 when tau mod m = 0.
  int period() const { return period_; }
  /// s(k), N x m.
  Matrix at(std::int64_t k) const;
  /// s(k) of all agents one behind the other, N m numbers.
  Vector stacked(std::int64_t k) const;
  /// Share of the samples in which each entry is sent, N x m. One with 0 is never sent
  /// (docs/filters/partial_sharing.md#m9).
  Matrix frequency() const;
  /// Time mean of s(k) s(k)' over one period, N m x N m: the exact second moment on this cycle.
  Matrix moments_cycle() const;
  /// E{s s'} when every agent draws its own uniform subset, N m x N m: the exact second moment over random
  /// starts.
  Matrix moments_uniform() const;

  /// Of a design file: it is one of so many agents and states.
  bool fits(int agents, int states) const noexcept {
    if (states_ != states || first_.size() != static_cast<std::size_t>(agents) + 1) return false;
    if (shift_ >= states || period_ != states / std::gcd(states, shift_)) return false;
    if (first_.front() != 0 || first_.back() != entries_.size() ||
        !std::is_sorted(first_.begin(), first_.end()))
      return false;
    for (int i = 0; i < agents; ++i) {
      const auto own = entries(i);
      if (std::adjacent_find(own.begin(), own.end(), std::greater_equal<>()) != own.end()) return false;
      if (!own.empty() && (own.front() < 0 || own.back() >= states)) return false;
    }
    return true;
  }

  template <class V>
  void visit(V& v) {
    v("entries", entries_);
    v("first", first_);
    v.range("states", states_, 1, 65535);
    v.range("shift", shift_, 0, 65535);
    v.range("period", period_, 1, 65535);
  }

 private:
  std::vector<int> entries_;
  std::vector<std::uint64_t> first_{0};  // of one width on every machine: it travels in design files
  int states_ = 0;
  int shift_ = 0;
  int period_ = 1;
};

}  // namespace garrison::partial_sharing
