// SPDX-License-Identifier: Apache-2.0
// Where an agent keeps the certificate's part of messages that wait for their round.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/certificate/online/certifier.hpp"

namespace garrison {

/// Room for one Evidence per place of a mailbox, borrowed from their neighbour's stack: where messages are
/// fused soon after they came, the same few stay in the cache. Nothing is allocated after construction.
/// Threads: one at a time.
class EvidenceShelf {
 public:
  /// Place p is of neighbour p modulo their number; `places` is a multiple of that.
  EvidenceShelf(const certificate::Certifier& certifier, std::span<const int> neighbours, std::size_t places)
      : room_(places), lent_(places, kNothing), next_(places), first_(neighbours.size(), kNothing) {
    for (std::size_t p = 0; p < places; ++p) {
      const std::size_t neighbour = p % neighbours.size();
      certifier.shape_evidence(neighbours[neighbour], room_[p]);
      give_back(static_cast<std::uint32_t>(p), neighbour);
    }
  }
  /// Room for the message that is read into this place, until `take`; the same if it is asked for again.
  certificate::Evidence& open(std::size_t place, std::size_t neighbour) noexcept {
    if (lent_[place] == kNothing) {
      lent_[place] = first_[neighbour];
      first_[neighbour] = next_[lent_[place]];
    }
    return room_[lent_[place]];
  }
  /// Nothing is said in this place.
  void leave(std::size_t place, std::size_t neighbour) noexcept {
    if (lent_[place] != kNothing) give_back(lent_[place], neighbour);
    lent_[place] = kNothing;
  }
  bool has(std::size_t place) const noexcept { return lent_[place] != kNothing; }
  /// The message in this place, which was opened; its room may be lent again with the next `open`.
  const certificate::Evidence& take(std::size_t place, std::size_t neighbour) noexcept {
    const std::uint32_t lent = lent_[place];
    give_back(lent, neighbour);
    lent_[place] = kNothing;
    return room_[lent];
  }

 private:
  static constexpr std::uint32_t kNothing = UINT32_MAX;
  void give_back(std::uint32_t room, std::size_t neighbour) noexcept {
    next_[room] = first_[neighbour];
    first_[neighbour] = room;
  }

  std::vector<certificate::Evidence> room_;
  std::vector<std::uint32_t> lent_;   // to each place
  std::vector<std::uint32_t> next_;   // free room, a chain per neighbour
  std::vector<std::uint32_t> first_;  // of each chain
};

}  // namespace garrison
