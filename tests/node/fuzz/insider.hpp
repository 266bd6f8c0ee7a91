// SPDX-License-Identifier: Apache-2.0
// A node, and a neighbour with keys who sends it anything.
#pragma once

#include <string>
#include <vector>

#include "garrison/node/node.hpp"
#include "hostile.hpp"

namespace garrison::node::test {

class Insider final : World {
 public:
  Insider();

  /// Seals these bytes and gives them to the node: whether it took them. Its estimate stays finite.
  bool says(Bytes plain);
  /// Gives it a datagram as it is.
  Fate shows(Bytes datagram);

  std::vector<std::string> genuine();  ///< plaintexts
  std::vector<std::string> sealed();   ///< datagrams; never given to the node

 private:
  void send(int neighbour, Bytes datagram) noexcept override;
  void measure(std::int64_t, std::span<double> y) noexcept override { std::fill(y.begin(), y.end(), 0.5); }
  void journal(const Entry&) noexcept override {}
  void ended(const Sample&) noexcept override {}
  Octets message(int round);

  Seeded random_;
  KeyPair own_keys_, other_keys_;
  Prologue prologue_{};
  Instant now_{0, 5'000'000};
  Schedule schedule_;
  std::unique_ptr<Agent> agent_, other_;
  std::unique_ptr<Peer> peer_;
  std::unique_ptr<Node> node_;
  std::vector<Octets> arrived_;  ///< at the neighbour, of the handshake
};

}  // namespace garrison::node::test
