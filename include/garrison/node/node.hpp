// SPDX-License-Identifier: Apache-2.0
// A whole node without input or output: its links and its core. Datagrams and the time go in, datagrams and
// reports come out; the daemon and the simulation run this same class.
#pragma once

#include <vector>

#include "garrison/node/authors.hpp"
#include "garrison/node/core.hpp"
#include "garrison/node/peer.hpp"

namespace garrison::node {

/// What a node asks of the world around it. Nothing here may call it back.
/// Threads: one at a time.
class World {
 public:
  virtual ~World() = default;
  virtual void send(int neighbour, Bytes datagram) noexcept = 0;
  virtual void measure(std::int64_t sample, std::span<double> y) noexcept = 0;
  virtual void journal(const Entry& entry) noexcept = 0;
  virtual void ended(const Sample& sample) noexcept = 0;
  /// Somebody has signed both.
  virtual void contradiction(const Statement&, const Statement&) noexcept {}
};

/// A neighbour as the roster has it.
struct Neighbour {
  int id = 0;
  Key key{};            ///< X25519
  bool listens = true;  ///< our messages go there; whom we hear is the agent's to say
};

/// Changes frames before they are sealed: a liar who has keys. For simulations and tests of a network.
/// Threads: one at a time.
class Tamper {
 public:
  virtual ~Tamper() = default;
  /// `plain`: inner header and body of `size` bytes, with room for more; returns the new size.
  virtual std::size_t operator()(int neighbour, Room plain, std::size_t size) noexcept = 0;
};

struct LinkView {
  int id = 0;
  bool up = false;
  bool absent = false;
  Micros age = -1;  ///< since the last genuine frame; -1 = never
  Micros skew = 0;  ///< its clock less ours, and the delay of the link, from the last frames both ways
  Micros delay = 0;
  bool timed = false;
};

/// Threads: one at a time.
class Node final : private Outlet {
 public:
  /// Keeps references to agent, world and random.
  Node(Agent& agent, const Schedule& schedule, const KeyPair& own, std::vector<Neighbour> neighbours,
       const Prologue& prologue, std::uint64_t boot, World& world, Random& random);

  Core& core() noexcept { return core_; }
  const Core& core() const noexcept { return core_; }
  void tick(Instant now) noexcept;
  Fate receive(Bytes datagram, Instant now) noexcept;
  void tamper_with(Tamper& tamper) noexcept { tamper_ = &tamper; }
  /// Signs what is sent, and passes statements on. Keeps a reference.
  void sign_with(Authors& authors) noexcept { authors_ = &authors; }
  /// Wall time of the next tick.
  Micros due() const noexcept;

  std::size_t links() const noexcept { return links_.size(); }
  LinkView link(std::size_t k, Instant now) const noexcept;
  const Fates& fates(std::size_t k) const noexcept { return links_[k].fates; }
  /// Of datagrams that name no neighbour.
  const Fates& outside() const noexcept { return outside_; }

 private:
  struct Link {
    Peer peer;
    bool listens;
    Fates fates;
    std::vector<std::byte> parts = {};  ///< of a body that comes in fragments
    Inner building = {};
    std::size_t filled = 0;
    std::int32_t echo = Inner::kNoEcho;
    LinkView view = {};
  };

  void measure(std::int64_t sample, std::span<double> y) noexcept override { world_.measure(sample, y); }
  void broadcast(std::int64_t sample, int round, Bytes body) noexcept override;
  void answer(int neighbour, std::int64_t sample, int round, Bytes body) noexcept override;
  void want(int neighbour, std::int64_t sample, int round) noexcept override;
  void journal(const Entry& entry) noexcept override { world_.journal(entry); }
  void ended(const Sample& sample) noexcept override;

  Link* link_of(int id) noexcept;
  void send_body(Link& link, std::int64_t sample, int round, Bytes body) noexcept;
  void send_frame(Link& link, Inner inner, Bytes rest) noexcept;
  Fate frame(Link& link, Bytes plain, Instant now) noexcept;
  Fate message(Link& link, const Inner& inner, Bytes part, Instant now) noexcept;
  Fate body(Link& link, const Inner& inner, Bytes body, Instant now) noexcept;
  Fate statement(Link& link, const Inner& inner, Bytes rest) noexcept;
  void spread(const Statement& statement, std::int64_t sample, int hops, int but) noexcept;
  void time_link(Link& link, const Inner& inner, Instant now) noexcept;

  Schedule schedule_;
  World& world_;
  Random& random_;
  Tamper* tamper_ = nullptr;
  Authors* authors_ = nullptr;
  int checks_left_ = 0;      ///< of signatures, until the next sample ends
  std::vector<Link> links_;  ///< ascending ids
  std::array<std::byte, kMostDatagram> plain_{};
  Datagram out_;
  Instant now_;
  Fates outside_;
  Core core_;
};

}  // namespace garrison::node
