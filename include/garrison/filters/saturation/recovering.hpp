// SPDX-License-Identifier: Apache-2.0
// The steps of an agent that a message was lost behind (theorem L, docs/certificates.md). Included by
// filter.hpp.
#pragma once

#include "garrison/certificate/relay.hpp"
#include "garrison/filters/saturation/filter.hpp"

namespace garrison {

template <int n>
void Saturation::relay_update(const Local& l, const Gains& g, State<n>& s, const double* estimate,
                              const double* prediction) noexcept {
  s.loss->bound = g.table.losses.growth * s.loss->bound + g.table.losses.noise +
                  distance(estimate, prediction, dimension<n>(l));
}

template <int n>
void Saturation::say(const State<n>& s, Message<n>& m) noexcept {
  if (s.intact)
    m.loss.say_whole();
  else
    m.loss.say(*s.loss, s.t);
}

template <int n>
bool Saturation::gap(const Inbox<Message<n>>& inbox) noexcept {
  bool found = !inbox.complete();
  for (std::size_t k = 0; k < inbox.size(); ++k) found = found || !inbox[k].loss.whole();
  return found;
}

template <int n>
void Saturation::relay(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int round,
                       double omega) noexcept {
  saturation::LossRecord& r = *s.loss;
  const certificate::Recovery& excess = g.table.losses.excess;
  const int nn = dimension<n>(l);
  const double whole = g.table.whole(s.t, round);
  if (s.intact) {  // up to here
    r.state = excess.rebase({}, s.t - 1);
    r.bound = whole;
    r.before = round > 0 ? g.table.whole(s.t, round - 1) : kInfinity;
  }
  certificate::RelayedBound bound;
  bound.add(omega * (1.0 - g.alpha * static_cast<double>(inbox.size())),
            distance(s.x.data(), r.old.data(), nn), r.bound);
  bool unknown = !(r.state.x < kInfinity);
  for (std::size_t k = 0; k < inbox.size(); ++k) {
    const Message<n>& m = inbox[k];
    const double away = distance(s.x.data(), m.x.data(), nn);
    if (m.loss.whole()) {
      bound.add(omega * g.alpha, away, whole);
      continue;
    }
    const certificate::LossState other = m.loss.state(s.t);
    unknown = unknown || m.loss.lost() || !(other.x < kInfinity);
    r.state = excess.merge(r.state, other, s.t - 1);
    bound.add(omega * g.alpha, away, m.loss.bound());
  }
  if (omega != 1.0) bound.add(omega - 1.0, kInfinity, r.before);
  r.before = r.bound;
  r.bound = bound.value();
  // What is not known is as good as lost: then the relayed bound is a new start.
  r.lost = r.lost || unknown || !inbox.complete();
  if (r.lost && round + 1 == g.rounds) start_anew(l, g, s);
}

template <int n>
void Saturation::relay_median(const Local& l, const Gains& g, State<n>& s,
                              const Inbox<Message<n>>& inbox) noexcept {
  saturation::LossRecord& r = *s.loss;
  for (std::size_t k = 0; k < inbox.size(); ++k) {
    const Message<n>& m = inbox[k];
    const double bound = m.loss.whole() ? g.table.whole(s.t, g.rounds - 1) : m.loss.bound();
    r.bound = std::min(r.bound, distance(s.x.data(), m.x.data(), dimension<n>(l)) + bound);
  }
  r.lost = true;
  start_anew(l, g, s);
}

}  // namespace garrison
