// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/substitution.hpp"

#include <algorithm>
#include <cmath>

namespace garrison::structure {
namespace {

Sensors sensors_of(std::span<const int> measured) {
  Sensors all;
  for (const int s : measured) all.push_back(s < 0 ? std::vector<int>{} : std::vector{s});
  return all;
}

void require_cost(const MatrixRef& cost, Eigen::Index agents, Eigen::Index states) {
  if (cost.cols() != states || (agents >= 0 && cost.rows() != agents))
    refuse("cost", std::to_string(cost.rows()) + " x " + std::to_string(cost.cols()),
           "one row per agent and " + amount(states, "column") + ", one per state");
  if (!(cost.array() >= 0.0).all())
    refuse("cost", "a negative number or nan", "numbers >= 0 (inf = impossible)");
}

}  // namespace

Mitigation mitigate(const System& system, std::span<const int> measured, std::span<const AgentClass> types,
                    std::span<const int> alarms, Choice choice, const MatrixRef& cost) {
  const auto N = static_cast<int>(measured.size());
  if (static_cast<int>(types.size()) != N)
    refuse("types", amount(types.size(), "agent"), std::to_string(N) + ", as in measured");
  if (cost.size() != 0) require_cost(cost, N, system.states());
  (void)system.classes(sensors_of(measured));  // refuses states out of range
  Mitigation m;
  m.measured.assign(measured.begin(), measured.end());
  std::vector<char> taken(static_cast<std::size_t>(system.states()), 0);
  for (const int s : measured)
    if (s >= 0) taken[static_cast<std::size_t>(s)] = 1;
  for (const int agent : alarms) {
    if (agent < 0 || agent >= N)
      refuse("alarms", std::to_string(agent), "an agent in 0.." + std::to_string(N - 1));
    const auto i = static_cast<std::size_t>(agent);
    const int before = m.measured[i];
    if (before < 0) continue;  // given up already
    std::vector<int> candidates;
    if (choice == Choice::by_class) {
      candidates = system.class_candidates(m.measured, i, types[i]);
    } else {
      const Sensors now = sensors_of(m.measured);
      Sensors without = now;
      without[i].clear();
      if (!system.observability(without).holds()) candidates = system.substitutes(now)[i];
    }
    int after = -1;
    double least = kInfinity;
    for (const int s : candidates) {
      const double price = choice == Choice::exact && cost.size() != 0 ? cost(agent, s) : 0.0;
      if (taken[static_cast<std::size_t>(s)] != 0 || !(price < least)) continue;
      after = s;
      least = price;
    }
    m.measured[i] = after;  // a state that was given up stays taken
    if (after >= 0) taken[static_cast<std::size_t>(after)] = 1;
    m.log.push_back({agent, types[i], before, after});
  }
  return m;
}

std::vector<int> cheapest_assignment(const MatrixRef& cost) {
  const auto rows = static_cast<int>(cost.rows());
  const auto columns = static_cast<int>(cost.cols());
  if (rows > columns) return {};
  // Row and column prices u, v; row_at[c] = row matched to column c. Column `columns` holds the row to
  // insert.
  std::vector<double> u(static_cast<std::size_t>(rows), 0.0);
  std::vector<double> v(static_cast<std::size_t>(columns) + 1, 0.0);
  std::vector<int> row_at(static_cast<std::size_t>(columns) + 1, -1);
  for (int r = 0; r < rows; ++r) {
    std::vector<double> distance(static_cast<std::size_t>(columns) + 1, kInfinity);
    std::vector<int> from(static_cast<std::size_t>(columns) + 1, -1);
    std::vector<char> done(static_cast<std::size_t>(columns) + 1, 0);
    int c = columns;
    row_at[static_cast<std::size_t>(c)] = r;
    while (row_at[static_cast<std::size_t>(c)] >= 0) {
      done[static_cast<std::size_t>(c)] = 1;
      const int at = row_at[static_cast<std::size_t>(c)];
      double least = kInfinity;
      int next = -1;
      for (int k = 0; k < columns; ++k) {
        const auto kk = static_cast<std::size_t>(k);
        if (done[kk] != 0) continue;
        const double reduced = cost(at, k) - u[static_cast<std::size_t>(at)] - v[kk];
        if (reduced < distance[kk]) {
          distance[kk] = reduced;
          from[kk] = c;
        }
        if (distance[kk] < least) {
          least = distance[kk];
          next = k;
        }
      }
      if (next < 0) return {};
      for (int k = 0; k <= columns; ++k) {
        const auto kk = static_cast<std::size_t>(k);
        if (done[kk] != 0) {
          u[static_cast<std::size_t>(row_at[kk])] += least;
          v[kk] -= least;
        } else {
          distance[kk] -= least;
        }
      }
      c = next;
    }
    while (c != columns) {
      const int before = from[static_cast<std::size_t>(c)];
      row_at[static_cast<std::size_t>(c)] = row_at[static_cast<std::size_t>(before)];
      c = before;
    }
  }
  std::vector<int> column(static_cast<std::size_t>(rows), -1);
  for (int k = 0; k < columns; ++k)
    if (row_at[static_cast<std::size_t>(k)] >= 0)
      column[static_cast<std::size_t>(row_at[static_cast<std::size_t>(k)])] = k;
  return column;
}

Picks cheapest_per_class(const MatrixRef& cost, std::span<const std::vector<int>> classes) {
  require_cost(cost, -1, cost.cols());
  const auto agents = cost.rows();
  const auto groups = static_cast<Eigen::Index>(classes.size());
  Matrix price(groups, agents);
  std::vector<std::vector<int>> cheapest(classes.size());
  for (std::size_t g = 0; g < classes.size(); ++g)
    for (Eigen::Index a = 0; a < agents; ++a) {
      int best = -1;
      for (const int s : classes[g]) {
        if (s < 0 || s >= cost.cols())
          refuse("classes[" + std::to_string(g) + "]", "state " + std::to_string(s),
                 "0.." + std::to_string(cost.cols() - 1));
        if (best < 0 || cost(a, s) < cost(a, best)) best = s;
      }
      cheapest[g].push_back(best);
      price(static_cast<Eigen::Index>(g), a) = best < 0 ? kInfinity : cost(a, best);
    }
  Picks p;
  const auto agent = cheapest_assignment(price);
  if (agent.size() != classes.size()) return p;
  p.exists = true;
  p.cost = 0.0;
  for (std::size_t g = 0; g < classes.size(); ++g) {
    const auto a = static_cast<std::size_t>(agent[g]);
    p.cost += price(static_cast<Eigen::Index>(g), agent[g]);
    p.picks.push_back({agent[g], cheapest[g][a], static_cast<int>(g)});
  }
  std::sort(p.picks.begin(), p.picks.end(), [](const Pick& a, const Pick& b) { return a.agent < b.agent; });
  return p;
}

Picks cheapest_rank_sensors(const Pattern& A, const MatrixRef& cost) {
  require_cost(cost, -1, A.columns());
  const Eigen::Index n = A.columns();
  Matrix price = Matrix::Constant(n, A.rows() + cost.rows(), kInfinity);
  for (int j = 0; j < n; ++j)
    for (const int i : A.column(j)) price(j, i) = 0.0;
  price.rightCols(cost.rows()) = cost.transpose();
  Picks p;
  const auto row = cheapest_assignment(price);
  if (static_cast<Eigen::Index>(row.size()) != n) return p;
  p.exists = true;
  p.cost = 0.0;
  for (int j = 0; j < n; ++j) {
    const int agent = row[static_cast<std::size_t>(j)] - A.rows();
    if (agent < 0) continue;
    p.cost += cost(agent, j);
    p.picks.push_back({agent, j, -1});
  }
  std::sort(p.picks.begin(), p.picks.end(), [](const Pick& a, const Pick& b) { return a.agent < b.agent; });
  return p;
}

}  // namespace garrison::structure
