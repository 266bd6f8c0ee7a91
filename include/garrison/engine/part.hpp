// SPDX-License-Identifier: Apache-2.0
// One agent's part of a design, and the agent that a node makes of it: no design, no registry, no exception.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "garrison/core/abi.hpp"
#include "garrison/engine/agent_of.hpp"
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

/// The agent of a file that `write_part` (engine/design_file.hpp) wrote, or null. `why`: size, damaged,
/// foreign (of another version, family or number of states, a whole design, a certificate, which needs the
/// whole library, or gains that need what this build has not). Allocates; where memory runs out the process
/// ends if it was compiled without exceptions.
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
  if (part.who.A.rows() != head.states || part.who.C_transposed.rows() != head.states) return nullptr;
  if (!runs<RunsOf<F>>(part.gains)) return nullptr;
  why = Refusal::none;
  return std::make_unique<AgentOf<RunsOf<F>, n>>(
      std::make_shared<const typename F::Gains>(std::move(part.gains)), std::move(part.who));
}

}  // namespace garrison
