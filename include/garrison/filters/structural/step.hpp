// SPDX-License-Identifier: Apache-2.0
// One sample of the structural filter: estimates (3)-(4), and the bound of their error. Included by
// filter.hpp.
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

inline void Structural::begin(const Gains& g, Memory& s, double factor) noexcept {
  if (!carries(g)) return;
  const double most = largest_usual(s);
  const auto usual = s.usual();
  std::fill(s.P.begin(), s.P.end(), 0.0);
  for (std::size_t k = 0; k < usual.size(); ++k)
    s.P[k * (usual.size() + 1)] = factor * (usual[k] > 0.0 ? usual[k] : most);
}

inline void Structural::settle(const Local& l, const Gains& g, Memory& s) noexcept {
  if (carries(g)) std::copy_n(stationary(g, l.id, l.states), s.P.size(), s.P.data());
}

inline std::vector<double> Structural::fixed(const Local& l, const Gains& g) {
  const int nn = l.states;
  const std::size_t size = structural::entries(nn);
  std::vector<double> all;
  all.reserve(2 * size + static_cast<std::size_t>(nn));
  all.resize(2 * size, 0.0);
  for (int k = 0; k < nn; ++k) all[static_cast<std::size_t>(k) * (static_cast<std::size_t>(nn) + 1)] = 1.0;
  const auto id = static_cast<std::size_t>(l.id);
  for (int at = g.offsets[id]; at < g.offsets[id + 1]; ++at) {
    const Heard& j = g.heard[static_cast<std::size_t>(at)];
    if (!expects(g, j)) continue;
    const double* column = g.columns.data() + j.first;
    structural::add_outer<1, Dynamic>(row(g, j.id, nn), column, -1.0, nn, all.data());
    structural::add_outer<1, Dynamic>(column, column, g.noise[static_cast<std::size_t>(j.id)], nn,
                                      all.data() + size);
  }
  for (int k = 0; k < nn; ++k) all.push_back(usual_variance(l, g, k));
  return all;
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
void Structural::mix_spreads(const Local& l, const Gains& g, Memory& s,
                             const Inbox<Message<n>>& inbox) noexcept {
  const int nn = dimension<n>(l);
  double* const memory = s.work.data() + 2 * structural::entries(nn);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  structural::Sums<n == Dynamic ? Dynamic : n * (n + 1) / 2> sums(memory);
  double* const lower = sums.data();
  std::fill_n(lower, structural::packed(nn), 0.0);
  for (std::size_t at = 0; at < inbox.size(); ++at)
    structural::add_packed<n>(inbox[at].covariance.data(), heard[s.senders[at]].weight, nn, lower);
  if constexpr (n != Dynamic) std::copy_n(lower, structural::packed(nn), memory);
}

template <int B, int n>
GARRISON_INLINE void Structural::predict_spread(const Local& l, const Gains& g, Memory& s) noexcept {
  const int nn = dimension<n>(l);
  const std::size_t size = structural::entries(nn);
  double* prior = s.work.data();
  double* mean = prior + size;
  double* half = mean + size;
  structural::unpack<n>(half, nn, mean);
  const double own = s.own;
  for (std::size_t k = 0; k < size; ++k) mean[k] += own * s.P[k];
  std::copy_n(g.process.data(), size, prior);
  structural::add_congruence<B, n>(l.A, mean, nn, half, prior);
}

template <int n>
bool Structural::update(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                        bool used, bool carried) noexcept {
  bool out = false;
  if (g.isolate)
    out = use_trusted(l, g, s, inbox, used, carried);
  else
    use_all(l, g, s, inbox);
  if (!carried) return !out;
  constexpr int like = spread_dimension(n);
  run_widest_of<UpdateSpread<like>, like>(&l, &g, static_cast<Memory*>(&s));
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
    const double* column = g.columns.data() + heard->first;
    for (int k = 0; k < nn; ++k) x[k] += column[k] * s.innovation;
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
    const double* column = g.columns.data() + j.first;
    const double innovation = letter.numbers[nn] - dot(g, j.id, s.prior, nn);
    for (int k = 0; k < nn; ++k) x[k] += column[k] * innovation;
  }
  s.gone = gone;
  if constexpr (n != Dynamic)
    for (int k = 0; k < nn; ++k) s.x[k] = x[k];
}

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
    const double* column = g.columns.data() + heard[e].first;
    for (int k = 0; k < nn; ++k) x[k] += column[k] * innovation;
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

template <int B, int n>
GARRISON_INLINE void Structural::update_spread(const Local& l, const Gains& g, Memory& s) noexcept {
  const int nn = dimension<n>(l);
  const std::size_t size = structural::entries(nn);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  double* prior = s.work.data();
  double* G = prior + size;
  double* half = G + size;
  std::copy_n(s.fixed.data(), size, G);
  std::copy_n(s.fixed.data() + size, size, s.P.data());
  for (int k = 0; k < s.gone; ++k) {
    const Heard& j = heard[s.missing[static_cast<std::size_t>(k)]];
    if (!expects(g, j)) continue;
    const double* column = g.columns.data() + j.first;
    structural::add_outer<B, n>(row(g, j.id, nn), column, 1.0, nn, G);
    structural::add_outer<B, n>(column, column, -g.noise[static_cast<std::size_t>(j.id)], nn, s.P.data());
  }
  structural::add_congruence<B, n>(G, prior, nn, half, s.P.data());
  // Messages of a liar may have made it anything.
  if (!structural::is_covariance<B, n>(s.P.data(), largest_usual(s), kMostVariance, nn))
    begin(g, s, kMostVariance);
}

template <int n>
bool Structural::surprising(const Gains& g, const Heard& j, const double* prior, double innovation,
                            int nn) noexcept {
  const double variance =
      structural::quadratic<n>(prior, row(g, j.id, nn), nn) + g.noise[static_cast<std::size_t>(j.id)];
  return variance > 0.0 && std::abs(innovation) >= g.sample_level * std::sqrt(variance);
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
