// SPDX-License-Identifier: Apache-2.0
// What one agent received in one round.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace garrison {

/// An array of messages and the slots of it that this agent may read, in order of sender id; all are of the
/// present sample and round, finite and well formed.
///
/// The engine passes the message array of the whole network and one row of slots (no copy); a node
/// passes its mailbox and the slots that arrived. A message that was lost has no slot.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
template <class Message>
class Inbox {
 public:
  /// `senders`: public id behind each slot; `due`: neighbours that this agent has at this sample.
  Inbox(const Message* messages, std::span<const std::uint32_t> slots, const int* senders, int due)
      : messages_(messages), slots_(slots), senders_(senders), due_(due) {}

  std::size_t size() const { return slots_.size(); }
  const Message& operator[](std::size_t k) const { return messages_[slots_[k]]; }
  int sender(std::size_t k) const { return senders_[k]; }
  /// Messages that should be here.
  int due() const { return due_; }
  bool complete() const { return slots_.size() == static_cast<std::size_t>(due_); }

 private:
  const Message* messages_;
  std::span<const std::uint32_t> slots_;
  const int* senders_;
  int due_;
};

/// The middle of `count` values, NaN aside (of an even number: the mean of the two middle ones); NaN of none.
/// Reads each of them `count` times and needs no room.
template <class Value>
double median_of(std::size_t count, const Value& value) noexcept {
  std::size_t present = 0;
  for (std::size_t k = 0; k < count; ++k) present += value(k) == value(k) ? 1U : 0U;
  double sum = 0.0;
  int found = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (value(k) != value(k)) continue;
    std::size_t below = 0;
    for (std::size_t j = 0; j < count; ++j)
      below += value(j) < value(k) || (value(j) == value(k) && j < k) ? 1U : 0U;
    if (below != present / 2 && below != (present - 1) / 2) continue;
    sum += value(k);
    ++found;
  }
  return found == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / found;
}

}  // namespace garrison
