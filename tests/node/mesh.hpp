// SPDX-License-Identifier: Apache-2.0
// Processes on a ring, each of which sends to the four nearest, over one of three transports: what rounds
// cost on each.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "garrison/node/peer.hpp"
#include "node/daemon/service.hpp"
#include "node/daemon/udp.hpp"

namespace garrison::node::test {

/// What is agreed on before the processes part: ports, sessions, keys.
struct MeshPlan {
  int nodes = 0;
  std::vector<int> ports;                                 ///< two per node
  std::vector<std::vector<std::unique_ptr<Peer>>> peers;  ///< [own][other], with open sessions
  std::vector<std::array<char, 41>> open, secret;         ///< of CURVE

  static std::unique_ptr<MeshPlan> of(int nodes);
  /// Whom a node sends to and hears: two on either side.
  std::vector<int> neighbours(int own) const;
};

class Mesh {
 public:
  enum class Kind { raw, sealed, curve };
  static constexpr std::size_t kBytes = 61;

  static const std::vector<Kind>& kinds();  ///< that were built
  static const char* word(Kind kind);
  static std::unique_ptr<Mesh> of(Kind kind, MeshPlan& plan, int own);

  virtual ~Mesh() = default;
  virtual bool open() = 0;
  /// A message of this round to all neighbours.
  virtual void send(int round) = 0;
  /// Waits for one; its round, or -1 when nothing came for seconds.
  virtual int receive() = 0;
};

/// ZeroMQ with CURVE, where libzmq was there at the build; else false, nothing and null.
bool curve_is_built();
void add_curve_keys(MeshPlan& plan);
std::unique_ptr<Mesh> curve_mesh(MeshPlan& plan, int own);
/// Milliseconds without a message after which a process gives up.
inline constexpr int kPatienceMs = 10'000;

}  // namespace garrison::node::test
