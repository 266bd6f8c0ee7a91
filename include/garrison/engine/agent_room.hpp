// SPDX-License-Identifier: Apache-2.0
// How much memory an agent's mailboxes take, known before there are any: a file may claim anything.
#pragma once

#include "garrison/certificate/online/certifier.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/engine/agent.hpp"
#include "garrison/wire/message.hpp"

namespace garrison {

/// What an agent on its own is made for. Its mailboxes hold the messages of two samples, all rounds of all
/// neighbours; those that it has are in its part of a design, the agents of the network are only claimed
/// there, and a message may have a bit for each.
inline constexpr int kMostRounds = 1000;
inline constexpr int kMostAgents = 1 << 26;
inline constexpr double kMostMail = 512.0 * 1024 * 1024;  // bytes

/// Bytes of the mailboxes, at most. Allocates one state and one message. `certifier`: null = none.
template <class F, int n>
double mail_bytes(const typename F::Gains& gains, const AgentPart& who,
                  const certificate::Certifier* certifier) {
  const Local local = local_of(who);
  const Vec<n> zero = Vec<n>::Zero(local.states);
  typename F::template State<n> state;
  typename F::template Message<n> message;
  certificate::Evidence evidence;
  F::template init<n>(local, gains, zero, state, message);
  std::size_t of_round = 0;
  for (const int sender : who.neighbours) {
    shape<F, n>(local, gains, sender, first_sample<F>(), message);
    of_round += sizeof(message) + wire::most_bytes(message, local.agents);
    if (certifier == nullptr) continue;
    certifier->shape_evidence(sender, evidence);
    of_round += sizeof(evidence) + wire::most_bytes(evidence, local.agents);
  }
  return 2.0 * F::rounds(gains) * static_cast<double>(of_round);
}

}  // namespace garrison
