// SPDX-License-Identifier: Apache-2.0
#include "partition/cut.hpp"

#include <algorithm>

namespace garrison::partition {

Cast::Cast(const Region& region) : ids(region.ids), own(region.ids.size(), 0) {
  std::sort(ids.begin(), ids.end());
  for (int place = 0; place < region.own; ++place)
    own[static_cast<std::size_t>(name_of(region.ids[static_cast<std::size_t>(place)]))] = 1;
}

int Cast::name_of(int id) const {
  return static_cast<int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

Rdkf::Gains cut(const Rdkf::Gains& all, const Cast& cast) {
  Rdkf::Gains g = all;
  g.agents.assign(cast.ids.size(), {});
  for (std::size_t k = 0; k < cast.ids.size(); ++k) {
    const rdkf::AgentGains& from = all.agents[static_cast<std::size_t>(cast.ids[k])];
    if (cast.own[k] == 0) {
      g.agents[k].J = from.J;
      continue;
    }
    g.agents[k] = from;
    for (int& id : g.agents[k].heard) id = cast.name_of(id);
  }
  return g;
}

PartialSharing::Gains cut(const PartialSharing::Gains& all, const Cast& cast) {
  PartialSharing::Gains g{all.gamma, {}, {}, {}, all.Q, all.P0, all.given, all.freeze};
  Matrix start = Matrix::Zero(cast.size(), all.selection.states());
  g.W.resize(cast.ids.size());
  g.steady.resize(all.steady.empty() ? 0 : cast.ids.size());
  for (std::size_t k = 0; k < cast.ids.size(); ++k) {
    const auto id = static_cast<std::size_t>(cast.ids[k]);
    for (const int a : all.selection.entries(cast.ids[k])) start(static_cast<Eigen::Index>(k), a) = 1.0;
    if (cast.own[k] == 0) continue;
    g.W[k] = all.W[id];
    if (!g.steady.empty()) g.steady[k] = all.steady[id];
  }
  g.selection = {start, all.selection.shift()};
  return g;
}

namespace {

/// `count` numbers of each agent.
std::vector<double> rows_of(const std::vector<double>& all, const Cast& cast, std::size_t count) {
  std::vector<double> rows;
  if (all.empty()) return rows;
  for (const int id : cast.ids) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(count) * id;
    rows.insert(rows.end(), first, first + static_cast<std::ptrdiff_t>(count));
  }
  return rows;
}

}  // namespace

Structural::Gains cut(const Structural::Gains& all, const Cast& cast) {
  const std::size_t N = all.has_sensor.size();
  const std::size_t n = all.rows.size() / N;
  Structural::Gains g = all;
  g.rows = rows_of(all.rows, cast, n);
  g.std = rows_of(all.std, cast, 1);
  g.innovation_std = rows_of(all.innovation_std, cast, 1);
  g.precision = rows_of(all.precision, cast, all.precision.size() / N);
  g.covariance = rows_of(all.covariance, cast, n * n);
  g.noise = rows_of(all.noise, cast, 1);
  g.doubt = rows_of(all.doubt, cast, 1);
  g.has_sensor.clear();
  g.offsets.assign(1, 0);
  g.heard.clear();
  g.columns.clear();
  for (std::size_t k = 0; k < cast.ids.size(); ++k) {
    const auto id = static_cast<std::size_t>(cast.ids[k]);
    g.has_sensor.push_back(all.has_sensor[id]);
    for (int e = all.offsets[id]; e < all.offsets[id + 1] && cast.own[k] != 0; ++e) {
      Structural::Heard heard = all.heard[static_cast<std::size_t>(e)];
      heard.id = cast.name_of(heard.id);
      if (heard.first >= 0) {
        const auto column = all.columns.begin() + heard.first;
        heard.first = static_cast<int>(g.columns.size());
        g.columns.insert(g.columns.end(), column, column + static_cast<std::ptrdiff_t>(n));
      }
      g.heard.push_back(heard);
    }
    g.offsets.push_back(static_cast<int>(g.heard.size()));
  }
  return g;
}

}  // namespace garrison::partition
