// SPDX-License-Identifier: Apache-2.0
// What one agent does at its start, with its inbox and when it reports. Included by filter.hpp.
#pragma once

#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison {

template <int n>
void PartialSharing::use_sensor(const Local& l, const Gains& g, const Matrix* told, Eigen::Index first,
                                State<n>& s) noexcept {
  partial_sharing::Group<n>& group = *s.group;
  const double* const own = g.W[static_cast<std::size_t>(l.id)].data();
  for (int k = 0; k < l.outputs * group.m; ++k) group.at(group.C, k, s.lane) = l.C[k];
  for (int r = 0; r < l.outputs; ++r)
    for (int c = 0; c <= r; ++c)
      group.at(group.W, packed(r, c), s.lane) =
          told != nullptr ? (*told)(first + r, c) : own[static_cast<std::ptrdiff_t>(r) * l.outputs + c];
}

template <int n>
void PartialSharing::init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
  const int nn = dimension<n>(l);
  const int q = l.outputs;
  if (!s.group) s.group = std::make_shared<partial_sharing::Group<n>>(nn, q);
  partial_sharing::Group<n>& group = *s.group;
  const auto fill = [&](double* array, int first, int count, const auto& value) {
    for (int k = 0; k < count; ++k) group.at(array, first + k, s.lane) = value(k);
  };
  const auto id = static_cast<std::size_t>(l.id);
  fill(group.z, 0, nn, [&](int k) { return x0[k]; });
  use_sensor<n>(l, g, nullptr, 0, s);
  fill(group.y, 0, q, [](int) { return kNaN; });
  const bool steady = !g.steady.empty();
  const double* const P = steady ? g.steady[id].P.data() : g.P0.data();
  for (int i = 0; i < nn; ++i) fill(group.P, packed(i), i + 1, [&](int k) { return P[i * nn + k]; });
  if (steady) {
    const Steady& limit = g.steady[id];
    for (int i = 0; i < nn; ++i)
      fill(group.G, packed(i), i + 1, [&](int k) { return limit.G[static_cast<std::size_t>(i * nn + k)]; });
    fill(group.K, 0, q * nn, [&](int k) { return limit.K[static_cast<std::size_t>(k)]; });
  }
  group.set_frozen(s.lane, steady);
  group.started = false;
  group.follows = !g.freeze;
  if (g.given)
    std::copy_n(x0.data(), nn, group.prediction(s.lane));
  else
    multiply<n>(l.A, x0.data(), group.prediction(s.lane), nn);
  if constexpr (n == Dynamic) {
    m.value.assign(static_cast<std::size_t>(nn), 0.0);
    m.entry.assign(static_cast<std::size_t>(nn), 0);
  }
  m.count = g.selection.shared(l.id);
}

template <int n>
void PartialSharing::disagreement(const State<n>& s, const Inbox<Message<n>>& inbox, double* u) noexcept {
  const double* const x = s.group->prediction(s.lane);
  std::fill_n(u, s.group->m, 0.0);
  for (std::size_t j = 0; j < inbox.size(); ++j) {
    const Message<n>& heard = inbox[j];
    for (int k = 0; k < heard.count; ++k) {
      const auto a = heard.entry[static_cast<std::size_t>(k)];
      const double difference = heard.value[static_cast<std::size_t>(k)] - x[a];
      if (std::abs(difference) < kHuge) u[a] += difference;
    }
  }
}

template <int n>
void PartialSharing::fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                          Message<n>&) noexcept {
  double* const u = s.group->room_for_one();
  disagreement<n>(s, inbox, u);
  partial_sharing::Outcome unused;
  partial_sharing::update(common(l, g), *s.group, u, s.group->x, unused);
}

template <int n>
void PartialSharing::rejoin(const Local& l, const Gains&, const Inbox<Message<n>>& inbox, std::int64_t,
                            State<n>& s) noexcept {
  const int nn = dimension<n>(l);
  partial_sharing::Group<n>& group = *s.group;
  double* const next = group.prediction(s.lane);
  for (int a = 0; a < nn; ++a) {
    double& z = group.at(group.z, a, s.lane);
    if (!(std::abs(z) < kHuge)) z = 0.0;
    const double heard = median_of(inbox.size(), [&](std::size_t j) {
      for (int k = 0; k < inbox[j].count; ++k)
        if (inbox[j].entry[static_cast<std::size_t>(k)] == a)
          return inbox[j].value[static_cast<std::size_t>(k)];
      return kNaN;  // not shared at this sample
    });
    if (!std::isnan(heard)) z = heard;
  }
  for (int i = 0; i < nn; ++i) {
    next[i] = 0.0;
    for (int k = 0; k < nn; ++k)
      next[i] += l.A[static_cast<std::ptrdiff_t>(k) * nn + i] * group.at(group.z, k, s.lane);
  }
}

template <int n>
Report PartialSharing::report(const Local& l, const Gains&, const State<n>& s) noexcept {
  Report report;
  report.verdict = Verdict::not_tested;  // before the first sample, too
  partial_sharing::Group<n>& group = *s.group;
  if (!group.started) return report;
  double largest = 0.0;
  int used = 0;
  for (int r = 0; r < l.outputs; ++r) {
    double e = 0.0;
    for (int c = 0; c <= r; ++c) {
      const double innovation = group.at(group.y, c, s.lane);
      if (!std::isnan(innovation)) e += group.at(group.W, packed(r, c), s.lane) * innovation;
    }
    largest = std::max(largest, std::abs(e));
    used += std::isnan(group.at(group.y, r, s.lane)) ? 0 : 1;
  }
  if (used == 0) report.verdict = Verdict::silent;
  if (used > 0) report.statistic = largest;
  return report;
}

}  // namespace garrison
