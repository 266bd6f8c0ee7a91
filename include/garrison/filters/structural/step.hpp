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

template <int n>
void Structural::begin(const Local& l, const Gains& g, State<n>& s, double factor) noexcept {
  if (!carries(g)) return;
  const int nn = dimension<n>(l);
  const double* settled = stationary(g, l.id, nn);
  const std::size_t next = static_cast<std::size_t>(nn) + 1;
  double most = 0.0;
  for (std::size_t k = 0; k < s.P.size(); k += next) most = std::max(most, settled[k]);
  std::fill(s.P.begin(), s.P.end(), 0.0);
  for (std::size_t k = 0; k < s.P.size(); k += next) s.P[k] = factor * (settled[k] > 0.0 ? settled[k] : most);
}

template <int n>
bool Structural::sound(const Local& l, const Gains& g, const State<n>& s) noexcept {
  const int nn = dimension<n>(l);
  const double* settled = stationary(g, l.id, nn);
  const auto at = [nn](int i, int k) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(nn) + static_cast<std::size_t>(k);
  };
  double most = 0.0;
  for (int i = 0; i < nn; ++i) most = std::max(most, settled[at(i, i)]);
  bool all = true;
  for (int i = 0; i < nn; ++i)
    for (int k = 0; k <= i; ++k) {
      const double size = s.P[at(i, i)] * s.P[at(k, k)];
      const double slack = 1e-9 * (size + most * most);
      all &= s.P[at(i, i)] >= -1e-9 * most && s.P[at(i, i)] <= kMostVariance * most;
      all &= s.P[at(i, k)] * s.P[at(i, k)] <= size + slack;
    }
  return all;
}

template <int n>
void Structural::settle(const Local& l, const Gains& g, State<n>& s) noexcept {
  if (carries(g)) std::copy_n(stationary(g, l.id, dimension<n>(l)), s.P.size(), s.P.data());
}

template <int n>
Structural::Seen Structural::predict(const Local& l, const Gains& g, State<n>& s,
                                     const Inbox<Message<n>>& inbox, Message<n>& m) noexcept {
  const int nn = dimension<n>(l);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  const Heard* end = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id) + 1];
  Seen seen;
  seen.measurements = l.outputs == 0 || !std::isnan(s.y);
  double own = heard->weight;
  int rest = s.rest;
  structural::Sums<n> sums(m.numbers.data());
  double* const mean = sums.data();
  for (int k = 0; k < nn; ++k) mean[k] = 0.0;
  std::size_t at = 0;
  for (const Heard* j = heard + 1; j != end; ++j) {
    if (at >= inbox.size() || inbox.sender(at) != j->id) {
      own += j->weight;
      seen.estimates = seen.estimates && j->weight == 0.0;
      seen.measurements = seen.measurements && !expects(g, *j);
      continue;
    }
    const auto& letter = inbox[at++];
    rest = std::max(rest, letter.rest);  // what is off there is off here from now on
    if (!letter.measured && expects(g, *j)) seen.measurements = false;
    for (int k = 0; k < nn; ++k) mean[k] += j->weight * letter.numbers[k];
  }
  s.rest = rest;
  for (int k = 0; k < nn; ++k) mean[k] += own * s.x[k];
  for (int i = 0; i < nn; ++i) {
    double next = 0.0;
    for (int k = 0; k < nn; ++k) next += l.A[static_cast<std::ptrdiff_t>(k) * nn + i] * mean[k];
    s.prior[i] = next;
  }
  return seen;
}

template <int n>
void Structural::predict_spread(const Local& l, const Gains& g, State<n>& s,
                                const Inbox<Message<n>>& inbox) noexcept {
  const int nn = dimension<n>(l);
  const std::size_t size = structural::entries(nn);
  double* prior = s.work.data();
  double* mean = prior + size;
  double* half = mean + size;
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  const Heard* end = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id) + 1];
  double own = heard->weight;
  structural::Sums<n == Dynamic ? Dynamic : n * (n + 1) / 2> sums(half);
  double* const lower = sums.data();
  std::fill_n(lower, structural::packed(nn), 0.0);
  std::size_t at = 0;
  for (const Heard* j = heard + 1; j != end; ++j) {
    if (at >= inbox.size() || inbox.sender(at) != j->id)
      own += j->weight;
    else
      structural::add_packed<n>(inbox[at++].covariance.data(), j->weight, nn, lower);
  }
  structural::unpack<n>(lower, nn, mean);
  for (std::size_t k = 0; k < size; ++k) mean[k] += own * s.P[k];
  std::copy_n(g.process.data(), size, prior);
  structural::add_congruence<n>(l.A, 1, nn, mean, nn, half, prior);
}

template <int n>
bool Structural::update(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                        bool used, bool carried) noexcept {
  const int nn = dimension<n>(l);
  const std::size_t size = structural::entries(nn);
  const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
  const Heard* end = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id) + 1];
  double* prior = s.work.data();
  double* G = prior + size;
  double* more = G + size;
  if (carried) {
    std::fill_n(G, 2 * size, 0.0);
    for (int k = 0; k < nn; ++k) G[static_cast<std::ptrdiff_t>(k) * (nn + 1)] = 1.0;
    std::fill(s.P.begin(), s.P.end(), 0.0);
  }
  structural::Sums<n> sums(s.x.data());
  double* const x = sums.data();
  for (int k = 0; k < nn; ++k) x[k] = s.prior[k];
  const auto use = [&](const Heard& j, double innovation) {
    const double* column = g.columns.data() + j.first;
    for (int k = 0; k < nn; ++k) x[k] += column[k] * innovation;
    if (!carried) return;
    structural::add_outer<n>(column, row(g, j.id, nn), -1.0, nn, G);
    structural::add_outer<n>(column, column, g.noise[static_cast<std::size_t>(j.id)], nn, s.P.data());
  };
  // That a measurement was over its level says of an honest sensor that the estimate is off.
  bool out = false;
  double growth = 1.0;
  const auto leave = [&](const Heard& j, bool by_level) {
    char& before = s.left_out[static_cast<std::size_t>(&j - heard)];
    out = true;
    if (carried) growth = std::max(growth, g.doubt[static_cast<std::size_t>(j.id)]);
    if (by_level && !before && carried) {
      const double* c = row(g, j.id, nn);
      const double spread = structural::quadratic<n>(prior, c, nn) + g.noise[static_cast<std::size_t>(j.id)];
      if (spread > 0.0) structural::add_seen_outer<n>(prior, c, g.surprise / spread, nn, more);
    }
    before = 1;
  };
  const auto keep = [&](const Heard& j) {
    if (g.isolate) s.left_out[static_cast<std::size_t>(&j - heard)] = 0;
  };
  const bool measured = !std::isnan(s.y);
  if (used) {
    use(*heard, s.innovation);
    keep(*heard);
  } else if (measured) {
    leave(*heard, true);
  }
  std::size_t at = 0;
  for (const Heard* j = heard + 1; j != end; ++j) {
    if (at >= inbox.size() || inbox.sender(at) != j->id) continue;
    const auto& letter = inbox[at++];
    if (j->first < 0) continue;
    if (!letter.measured) {
      if (letter.withheld && g.isolate) leave(*j, false);
      continue;
    }
    const double innovation = letter.numbers[nn] - dot(g, j->id, s.prior, nn);
    if (g.isolate && carried && s.start == 0 && surprising<n>(g, *j, prior, innovation, nn)) {
      leave(*j, true);
    } else {
      use(*j, innovation);
      keep(*j);
    }
  }
  if constexpr (n != Dynamic) std::copy_n(x, nn, s.x.data());
  if (!carried) return !out;
  for (std::size_t k = 0; k < size; ++k) prior[k] = growth * (prior[k] + more[k]);
  structural::add_congruence<n>(G, nn, 1, prior, nn, more, s.P.data());
  if (!sound(l, g, s)) begin(l, g, s, kMostVariance);
  return !out;
}

template <int n>
bool Structural::surprising(const Gains& g, const Heard& j, const double* prior, double innovation,
                            int nn) noexcept {
  const double variance =
      structural::quadratic<n>(prior, row(g, j.id, nn), nn) + g.noise[static_cast<std::size_t>(j.id)];
  return variance > 0.0 && std::abs(innovation) >= g.sample_level * std::sqrt(variance);
}

template <int n>
void Structural::pass(const Local& l, const Gains& g, State<n>& s, bool whole) noexcept {
  if (s.start > 0) --s.start;
  const int nn = dimension<n>(l);
  if (!whole) {
    double ratio = 1.0;
    const double* settled = carries(g) ? stationary(g, l.id, nn) : nullptr;
    for (int k = 0; k < nn && settled != nullptr; ++k) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(k) * (nn + 1);
      if (settled[at] > 0.0) ratio = std::max(ratio, s.P[static_cast<std::size_t>(at)] / settled[at]);
    }
    const double more =
        g.rho > 0.0 && g.rho < 1.0 ? std::ceil(-0.5 * std::log(ratio) / std::log(g.rho)) : 0.0;
    const double most = std::min<double>(kMostRest, std::max(1, g.recover) + more);
    s.rest = std::max(s.rest, static_cast<int>(most));
    return;
  }
  if (s.rest > 0 && --s.rest == 0) settle(l, g, s);
}

}  // namespace garrison
