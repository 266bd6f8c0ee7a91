// SPDX-License-Identifier: Apache-2.0
// One agent's part of a design, and the agent that a node makes of it: no design, no registry, no exception.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "garrison/core/abi.hpp"
#include "garrison/engine/agent_of.hpp"
#include "garrison/engine/agent_room.hpp"
#include "garrison/wire/design_head.hpp"

namespace garrison {

/// An agent's part of a design: who it is, its gains and its certificate.
template <class F>
struct Part {
  AgentPart who;
  typename F::Gains gains;
  std::vector<std::uint8_t> certificate = {};  ///< certificate::Plan, as bytes; empty = none

  template <class V>
  void visit(V& v) {
    v("who", who);
    v("gains", gains);
    v("certificate", certificate);
  }
};

namespace detail {
template <class F>
struct RunsAs {
  using type = F;
};
template <class F>
  requires requires { typename F::RunsAs; }
struct RunsAs<F> {
  using type = typename F::RunsAs;
};
}  // namespace detail
/// A family may name another one, F::RunsAs, that runs the gains of its design: it then costs no engine of
/// its own.
template <class F>
using RunsOf = typename detail::RunsAs<F>::type;

/// Whether this build has what the gains ask for; see Filter.
template <class F>
bool runs(const typename F::Gains& gains) noexcept {
  if constexpr (requires { F::runs(gains); })
    return F::runs(gains);
  else
    return true;
}

/// Whether gains from a file have what an agent reads: forged ones would lead out of them.
template <class F>
bool fits(const typename F::Gains& gains, const Local& local, std::span<const int> neighbours) noexcept {
  if constexpr (requires { F::fits(gains, local, neighbours); })
    return F::fits(gains, local, neighbours);
  else
    return true;
}
/// Whether plant, sensor, neighbours and gains of a part belong together.
template <class F>
bool whole(const Part<F>& part) noexcept {
  const AgentPart& who = part.who;
  const auto n = who.A.rows();
  const auto stranger = [&](int j) { return j < 0 || j >= who.agents || j == who.id; };
  if (who.id < 0 || who.id >= who.agents || n < 1 || who.A.cols() != n || who.C_transposed.rows() != n ||
      (who.B.size() != 0 && who.B.rows() != n))
    return false;
  if (std::any_of(who.neighbours.begin(), who.neighbours.end(), stranger) ||
      std::adjacent_find(who.neighbours.begin(), who.neighbours.end(), std::greater_equal<>()) !=
          who.neighbours.end())
    return false;
  return fits<F>(part.gains, local_of(who), who.neighbours);
}

/// The agent of a file that `write_part` (engine/design_file.hpp) wrote, or null. `why`: size (of
/// the file, or of what it claims: engine/agent_room.hpp), damaged, foreign (of another version, family or
/// number of states, a whole design, a certificate, which needs the whole library, or gains that need what
/// this build has not). Allocates; where memory runs out the process ends if it was compiled without
/// exceptions.
template <class F, int n>
std::unique_ptr<AgentOf<RunsOf<F>, n>> agent_of_part(std::span<const std::byte> file, Refusal& why) {
  wire::DesignHead head;
  wire::Reader reader({}, 0, true);
  why = wire::open_design(file, head, reader);
  if (why != Refusal::none) return nullptr;
  std::vector<std::uint8_t> content;
  Part<RunsOf<F>> part;
  why = Refusal::foreign;
  if (!head.part || head.filter != F::name || (n != Dynamic && head.states != n)) return nullptr;
  reader("content", content);
  if (reader.end() != Refusal::none) return nullptr;
  if (wire::from_bytes(std::as_bytes(std::span(content)), INT32_MAX, part) != Refusal::none) return nullptr;
  if (!part.certificate.empty()) return nullptr;
  if (part.who.A.rows() != head.states || !whole(part)) return nullptr;
  if (!runs<RunsOf<F>>(part.gains)) return nullptr;
  why = Refusal::size;
  if (RunsOf<F>::rounds(part.gains) > kMostRounds || part.who.agents > kMostAgents) return nullptr;
  if (mail_bytes<RunsOf<F>, n>(part.gains, part.who, nullptr) > kMostMail) return nullptr;
  why = Refusal::none;
  return std::make_unique<AgentOf<RunsOf<F>, n>>(
      std::make_shared<const typename F::Gains>(std::move(part.gains)), std::move(part.who));
}

}  // namespace garrison
