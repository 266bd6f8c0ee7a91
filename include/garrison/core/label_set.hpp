// SPDX-License-Identifier: Apache-2.0
// Sets of ids as messages carry them where networks are large: few members, or all but a few.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace garrison {

/// A finite set of ids, or the complement of one, as a sorted list in memory that is sized once. Its size
/// does not depend on the number of vehicles: N vehicles hold three such sets each, which would be N^2 bits.
/// Operations that need more room than there is change nothing and return false.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class LabelSet {
 public:
  LabelSet() = default;
  explicit LabelSet(int capacity)
      : data_(std::make_unique<int[]>(kHead + static_cast<std::size_t>(capacity))) {
    data_[0] = capacity;
    clear();
  }
  LabelSet(const LabelSet& other) { *this = other; }
  LabelSet(LabelSet&&) noexcept = default;
  LabelSet& operator=(LabelSet&&) noexcept = default;
  /// Allocates only when the capacities differ.
  LabelSet& operator=(const LabelSet& other) {
    if (this == &other) return *this;
    if (other.data_ == nullptr) {
      data_ = nullptr;
      return *this;
    }
    if (data_ == nullptr || data_[0] != other.data_[0])
      data_ = std::make_unique<int[]>(kHead + static_cast<std::size_t>(other.data_[0]));
    std::copy_n(other.data_.get(), kHead + static_cast<std::size_t>(other.data_[1]), data_.get());
    return *this;
  }
  ~LabelSet() = default;

  void clear() {
    data_[1] = 0;
    data_[2] = 0;
  }
  int capacity() const { return data_ == nullptr ? 0 : data_[0]; }
  /// Starts to fill the set from elsewhere: so many ids follow with `place`, in ascending order.
  void start(int listed, bool complement) {
    if (data_ == nullptr) return;
    data_[1] = listed;
    data_[2] = complement ? 1 : 0;
  }
  void place(int k, int id) { begin()[k] = id; }
  /// Everything is a member except the listed ids.
  bool complement() const { return data_ != nullptr && data_[2] != 0; }
  /// The members, or those that are not, in ascending order.
  std::span<const int> listed() const { return {begin(), static_cast<std::size_t>(count())}; }
  /// Number of members; of a complement: the number of ids that are not members.
  int count() const { return data_ == nullptr ? 0 : data_[1]; }
  bool contains(int id) const { return std::binary_search(begin(), end(), id) != complement(); }

  bool insert(int id) {
    int* const at = std::lower_bound(begin(), end(), id);
    const bool listed = at != end() && *at == id;
    if (listed != complement()) return true;
    if (complement()) {
      std::copy(at + 1, end(), at);
      --data_[1];
      return true;
    }
    if (data_[1] == data_[0]) return false;
    std::copy_backward(at, end(), end() + 1);
    *at = id;
    ++data_[1];
    return true;
  }

  bool unite(const LabelSet& other) {
    if (*this == other) return true;
    if (other.complement()) return unite_all_but(other.listed());
    if (complement()) {  // V \ E united with F is V \ (E \ F)
      keep([&](int id) { return !other.contains(id); });
      return true;
    }
    for (const int id : other.listed())
      if (!insert(id)) return false;
    return true;
  }

  /// Unites with V \ E, E given as a sorted list.
  bool unite_all_but(std::span<const int> excluded) {
    if (complement()) {  // V \ E1 united with V \ E2 is V \ (E1 and E2)
      keep([&](int id) { return std::binary_search(excluded.begin(), excluded.end(), id); });
      return true;
    }
    // F united with V \ E is V \ (E \ F).
    if (excluded.size() > static_cast<std::size_t>(std::min(data_[0], 2 * kMost))) return false;
    int stray[2 * kMost];
    int many = 0;
    for (const int id : excluded)
      if (!contains(id)) stray[many++] = id;
    std::copy_n(stray, many, begin());
    data_[1] = many;
    data_[2] = 1;
    return true;
  }

  /// Becomes everything but the members of `a` and `b`, both finite.
  bool become_all_but(const LabelSet& a, const LabelSet& b) {
    if (a.count() + b.count() > data_[0]) return false;
    data_[1] = static_cast<int>(std::set_union(a.begin(), a.end(), b.begin(), b.end(), begin()) - begin());
    data_[2] = 1;
    return true;
  }

  bool operator==(const LabelSet& other) const {
    return count() == other.count() && complement() == other.complement() &&
           std::equal(begin(), end(), other.begin());
  }

  /// Most ids that a set of attacked or suspected sensors may hold.
  static constexpr int kMost = 320;

 private:
  template <class Wanted>
  void keep(const Wanted& wanted) {
    data_[1] = static_cast<int>(std::copy_if(begin(), end(), begin(), wanted) - begin());
  }
  static constexpr std::size_t kHead = 3;  // capacity, number listed, complement
  int* begin() const { return data_ == nullptr ? nullptr : data_.get() + kHead; }
  int* end() const { return begin() + count(); }

  std::unique_ptr<int[]> data_;
};

}  // namespace garrison
