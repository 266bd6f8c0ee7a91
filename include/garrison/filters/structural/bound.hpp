// SPDX-License-Identifier: Apache-2.0
// The bound P_i of the structural filter's error: where it starts, and what a sample makes of it. Included by
// filter.hpp.
#pragma once

#include "garrison/filters/structural/filter.hpp"

namespace garrison {

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

}  // namespace garrison
