// SPDX-License-Identifier: Apache-2.0
// One neighbour: its handshakes, its sessions and what was seen of them. No socket, no clock, no source of
// random numbers, no memory from the heap.
#pragma once

#include "garrison/node/fate.hpp"
#include "garrison/node/frame.hpp"
#include "garrison/node/noise.hpp"
#include "garrison/node/window.hpp"

namespace garrison::node {

/// What both ends must agree on before any key is made: nodes of another design, schedule or run cannot link
/// up.
using Prologue = std::array<std::byte, 64>;

/// Threads: one at a time.
class Peer {
 public:
  static constexpr Micros kRetry = 250'000;        ///< between initiations while there is no session
  static constexpr Micros kRetryLive = 1'000'000;  ///< while there is one, but silent
  static constexpr Micros kSilence = 1'500'000;    ///< after which a session is doubted
  static constexpr Micros kAlive = 500'000;        ///< something is sent at least this often
  static constexpr Micros kPrevious = 2'000'000;  ///< of silence, after which the session before is forgotten
  static constexpr Micros kSessionTime = 3'600'000'000;
  static constexpr std::uint64_t kSessionFrames = std::uint64_t{1} << 40;

  /// `own`: our exchange keys; `theirs`: the neighbour's. `boot`: how often this node has started.
  Peer(int own_id, int id, const KeyPair& own, const Key& theirs, const Prologue& prologue,
       std::uint64_t boot);

  int id() const noexcept { return id_; }
  /// Whether frames can be sealed.
  bool up() const noexcept { return current_.live; }
  /// Steady time of the last genuine frame; 0 = never.
  Micros heard() const noexcept { return heard_; }
  std::uint64_t boot_of_peer() const noexcept { return their_boot_; }

  /// Whether something is due: an initiation or, on a silent link, a sign of life. It is then in `out`.
  bool tick(Instant now, Random& random, Datagram& out) noexcept;

  struct Received {
    Fate fate = Fate::size;
    std::size_t plain = 0;  ///< taken: bytes of the inner header and what follows it
  };
  /// `plain` has room for kMostDatagram. `reply.size` is not 0 when something has to be sent back.
  Received receive(Bytes datagram, Instant now, Random& random, std::byte* plain, Datagram& reply) noexcept;

  /// Inner header and body as a datagram; only while up(). Returns its size.
  std::size_t seal_frame(Bytes plain, Micros steady, std::byte* out) noexcept;

 private:
  struct Session {
    Key sending{};
    Key receiving{};
    std::uint64_t sent = 0;
    Window window;
    std::uint32_t ours = 0;  ///< the index by which they name it
    std::uint32_t theirs = 0;
    Micros since = 0;
    Micros heard = 0;  ///< last genuine frame in it; its begin before the first one
    bool live = false;
    bool started_here = false;
  };

  void initiate(Instant now, Random& random, Datagram& out) noexcept;
  Fate initiation(Bytes in, Instant now, Random& random, Datagram& reply) noexcept;
  Fate response(Bytes in, Micros steady, Datagram& reply) noexcept;
  Received data(Bytes in, Micros steady, std::byte* plain) noexcept;
  void alive(Micros steady, Datagram& out) noexcept;
  void use(const Session& next, Micros steady) noexcept;
  void keep_previous(Micros steady) noexcept;
  void put_mac(std::byte* at, std::size_t before) const noexcept;
  bool mac_fits(Bytes in) const noexcept;

  int own_id_;
  int id_;
  KeyPair own_;
  Key theirs_;
  Key door_{};  ///< key of the handshakes' MAC: a flood of strangers ends before any work on curves
  Prologue prologue_;
  std::uint64_t boot_;

  Handshake handshake_;
  bool waiting_ = false;  ///< for a response to `handshake_`
  std::uint32_t index_ = 0;
  Micros asked_ = 0;
  Session current_;
  Session next_;  ///< of a handshake we answered; used once they use it
  Session previous_;
  Micros previous_until_ = 0;

  Micros retry_at_ = 0;
  Micros heard_ = 0;
  Micros spoken_ = 0;
  Micros old_stamp_from_ = 0;
  std::int64_t last_stamp_ = INT64_MIN;
  std::uint64_t their_boot_ = 0;
};

}  // namespace garrison::node
