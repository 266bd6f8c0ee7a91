// SPDX-License-Identifier: Apache-2.0
// One sample of the structural filter: estimates (3)-(4). Included by filter.hpp.
#pragma once

#include "garrison/filters/structural/filter.hpp"

namespace garrison {

template <int n>
double Structural::dot(const Gains& g, int id, const Vec<n>& x, int nn) noexcept {
  const double* c = row(g, id, nn);
  double sum = 0.0;
  for (int k = 0; k < nn; ++k) sum += c[k] * x[k];
  return sum;
}

inline double Structural::reaction(const Gains& g, int id, int nn) noexcept {
  const Heard& own = g.heard[static_cast<std::size_t>(g.offsets[static_cast<std::size_t>(id)])];
  const double* c = row(g, id, nn);
  double sum = 0.0;
  for (int k = 0; k < nn; ++k) sum += c[k] * g.columns[static_cast<std::size_t>(own.first + k)];
  return sum;
}

template <int n>
void Structural::receive(const Local& l, const Gains& g, State<n>& s,
                         const Inbox<Message<n>>& inbox) noexcept {
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  const std::size_t count = s.left_out.size();
  int* const senders = s.senders.data();
  int* const missing = s.missing.data();
  std::size_t gone = 0;
  if (inbox.size() + 1 == count) {
    for (std::size_t k = 0; k + 1 < count; ++k) senders[k] = static_cast<int>(k + 1);
  } else {
    // Without branches: chance decides who is missing, which no processor can foresee.
    std::size_t at = 0;
    for (std::size_t e = 1; e < count; ++e) {
      const bool here = at < inbox.size() && inbox.sender(at) == heard[e].id;
      senders[at] = missing[gone] = static_cast<int>(e);
      at += here ? 1U : 0U;
      gone += here ? 0U : 1U;
    }
  }
  s.gone = static_cast<int>(gone);
}

template <int n>
Structural::Seen Structural::predict(const Local& l, const Gains& g, State<n>& s,
                                     const Inbox<Message<n>>& inbox, Message<n>& m) noexcept {
  const int nn = dimension<n>(l);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  Seen seen;
  seen.measurements = l.outputs == 0 || !std::isnan(s.y);
  for (int k = 0; k < s.gone; ++k) {
    const Heard& j = heard[s.missing[static_cast<std::size_t>(k)]];
    seen.estimates = seen.estimates && j.weight == 0.0;
    seen.measurements = seen.measurements && !expects(g, j);
  }
  int rest = s.rest;
  structural::Sums<n> sums(m.numbers.data());
  double* const mean = sums.data();
  for (int k = 0; k < nn; ++k) mean[k] = 0.0;
  for (std::size_t at = 0; at < inbox.size(); ++at) {
    const Heard& j = heard[s.senders[at]];
    const auto& letter = inbox[at];
    rest = std::max(rest, letter.rest);  // what is off there is off here from now on
    if (!letter.measured && expects(g, j)) seen.measurements = false;
    for (int k = 0; k < nn; ++k) mean[k] += j.weight * letter.numbers[k];
  }
  s.rest = rest;
  s.own = own_weight(heard, s);
  for (int k = 0; k < nn; ++k) mean[k] += s.own * s.x[k];
  for (int i = 0; i < nn; ++i) {
    double next = 0.0;
    for (int k = 0; k < nn; ++k) next += l.A[static_cast<std::ptrdiff_t>(k) * nn + i] * mean[k];
    s.prior[i] = next;
  }
  return seen;
}

inline double Structural::own_weight(const Heard* heard, const Memory& s) noexcept {
  double own = heard->weight;
  for (int k = 0; k < s.gone; ++k) own += heard[s.missing[static_cast<std::size_t>(k)]].weight;
  return own;
}

template <int n>
bool Structural::update(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                        bool used, bool carried) noexcept {
  bool out = false;
  if (g.isolate)
    out = use_trusted(l, g, s, inbox, used, carried);
  else
    use_all(l, g, s, inbox);
  if (carried) run_spread<UpdateSpread, n>(l, g, s);
  return !out;
}

template <int n>
void Structural::use_all(const Local& l, const Gains& g, State<n>& s,
                         const Inbox<Message<n>>& inbox) noexcept {
  const int nn = dimension<n>(l);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  int* const missing = s.missing.data();
  int gone = s.gone;
  structural::Sums<n> sums(s.x.data());
  double* const x = sums.data();
  for (int k = 0; k < nn; ++k) x[k] = s.prior[k];
  if (std::isnan(s.y)) {
    missing[gone++] = 0;
  } else {
    add_scaled<n>(s.innovation, g.columns.data() + heard->first, x, nn);
  }
  for (std::size_t at = 0; at < inbox.size(); ++at) {
    const int e = s.senders[at];
    const Heard& j = heard[e];
    const auto& letter = inbox[at];
    if (j.first < 0) continue;
    if (!letter.measured) {
      missing[gone++] = e;
      continue;
    }
    const double innovation = letter.numbers[nn] - dot(g, j.id, s.prior, nn);
    add_scaled<n>(innovation, g.columns.data() + j.first, x, nn);
  }
  s.gone = gone;
  if constexpr (n != Dynamic)
    for (int k = 0; k < nn; ++k) s.x[k] = x[k];
}

inline void Structural::pass(const Local& l, const Gains& g, Memory& s, bool whole) noexcept {
  if (s.start > 0) --s.start;
  if (!whole) {
    double ratio = 1.0;
    const auto usual = s.usual();
    for (std::size_t k = 0; k < usual.size(); ++k)
      if (usual[k] > 0.0) ratio = std::max(ratio, s.P[k * (usual.size() + 1)] / usual[k]);
    const double more = ratio > 1.0 ? std::ceil(0.5 * std::log(ratio) * s.pace) : 0.0;
    const double most = std::min<double>(structural::kMostRest, std::max(1, g.recover) + more);
    s.rest = std::max(s.rest, static_cast<int>(most));
    return;
  }
  if (s.rest > 0 && --s.rest == 0) settle(l, g, s);
}

}  // namespace garrison
