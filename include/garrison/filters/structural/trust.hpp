// SPDX-License-Identifier: Apache-2.0
// Whose measurements the structural filter uses with `isolate`: who is left out, and who is taken back.
// Included by filter.hpp.
#pragma once

#include "garrison/filters/structural/filter.hpp"

namespace garrison {

template <int n>
bool Structural::use_trusted(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                             bool used, bool carried) noexcept {
  const int nn = dimension<n>(l);
  const std::size_t size = structural::entries(nn);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  double* prior = s.work.data();
  double* more = prior + size;
  structural::Sums<n> sums(s.x.data());
  double* const x = sums.data();
  for (int k = 0; k < nn; ++k) x[k] = s.prior[k];
  if (carried) std::fill_n(more, size, 0.0);
  Doubts doubts{carried};
  const auto use = [&](int e, double innovation) {
    doubts.heeded = true;
    add_scaled<n>(innovation, g.columns.data() + heard[e].first, x, nn);
    take_back(l, g, s, e, carried);
  };
  const auto miss = [&](int e) { s.missing[static_cast<std::size_t>(s.gone++)] = e; };
  if (used) {
    use(0, s.innovation);
  } else {
    if (!std::isnan(s.y)) leave(l, g, s, 0, true, doubts);
    miss(0);
  }
  for (std::size_t at = 0; at < inbox.size(); ++at) {
    const int e = s.senders[at];
    const Heard& j = heard[e];
    const auto& letter = inbox[at];
    if (j.first < 0) continue;
    if (!letter.measured) {
      if (letter.withheld) leave(l, g, s, e, false, doubts);
      miss(e);
      continue;
    }
    const double innovation = letter.numbers[nn] - dot(g, j.id, s.prior, nn);
    if (carried && s.start == 0 && surprising<n>(g, j, prior, innovation, nn)) {
      leave(l, g, s, e, true, doubts);
      miss(e);
    } else {
      use(e, innovation);
    }
  }
  if constexpr (n != Dynamic) std::copy_n(x, nn, s.x.data());
  if (!carried) return doubts.out;
  if (doubts.out && !doubts.heeded) doubts.growth = std::max(doubts.growth, kNobody);
  for (std::size_t k = 0; k < size; ++k) prior[k] = doubts.growth * (prior[k] + more[k]);
  return doubts.out;
}

inline void Structural::leave(const Local& l, const Gains& g, Memory& s, int e, bool by_level,
                              Doubts& doubts) noexcept {
  const int nn = l.states;
  const Heard& j = g.heard[static_cast<std::size_t>(g.offsets[static_cast<std::size_t>(l.id)] + e)];
  const double* prior = s.work.data();
  double* more = s.work.data() + structural::entries(nn);
  char& before = s.left_out[static_cast<std::size_t>(e)];
  doubts.out = true;
  const bool used_before = before != Trust::out && before != Trust::out_again;
  const bool again = before != Trust::trusted && before != Trust::out;
  const auto id = static_cast<std::size_t>(j.id);
  const double* c = row(g, j.id, nn);
  const double spread = doubts.carried ? structural::quadratic<Dynamic>(prior, c, nn) + g.noise[id] : 0.0;
  const double usual = kLost * g.innovation_std[id];
  const bool lost = spread > usual * usual;
  if (doubts.carried)
    doubts.growth = std::max(doubts.growth, again ? kHaste : lost ? g.haste[id] : g.doubt[id]);
  if (by_level && used_before && doubts.carried) {
    // That a measurement was over its level says of an honest sensor that the estimate is off.
    if (spread > 0.0) structural::add_seen_outer(prior, c, g.surprise / spread, nn, more);
  }
  before = again ? Trust::out_again : Trust::out;
}

inline void Structural::take_back(const Local& l, const Gains& g, Memory& s, int e, bool carried) noexcept {
  char& trust = s.left_out[static_cast<std::size_t>(e)];
  if (trust == Trust::out) {
    const Heard& j = g.heard[static_cast<std::size_t>(g.offsets[static_cast<std::size_t>(l.id)] + e)];
    const auto id = static_cast<std::size_t>(j.id);
    const double* c = row(g, j.id, l.states);
    const double usual = kBlind * g.innovation_std[id];
    const bool far =
        carried && structural::quadratic<Dynamic>(s.work.data(), c, l.states) + g.noise[id] > usual * usual;
    trust = far ? Trust::followed : Trust::trusted;
  } else if (trust == Trust::out_again) {
    trust = Trust::returning;
  } else if (trust == Trust::returning && s.rest == 0) {
    trust = Trust::trusted;
  }
}

template <int n>
bool Structural::surprising(const Gains& g, const Heard& j, const double* prior, double innovation,
                            int nn) noexcept {
  const double variance =
      structural::quadratic<n>(prior, row(g, j.id, nn), nn) + g.noise[static_cast<std::size_t>(j.id)];
  return variance > 0.0 && std::abs(innovation) >= g.sample_level * std::sqrt(variance);
}

}  // namespace garrison
