// SPDX-License-Identifier: Apache-2.0
// What one agent received in one round.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace garrison {

/// An array of messages and the slots of it that this agent may read, in order of sender id.
///
/// The engine passes the message array of the whole network and one row of slots (no copy); a node
/// passes its mailbox and the slots that arrived. A message that was lost has no slot.
template <class Message>
class Inbox {
 public:
  Inbox(const Message* messages, std::span<const std::uint32_t> slots) : messages_(messages), slots_(slots) {}

  std::size_t size() const { return slots_.size(); }
  const Message& operator[](std::size_t k) const { return messages_[slots_[k]]; }

 private:
  const Message* messages_;
  std::span<const std::uint32_t> slots_;
};

}  // namespace garrison
