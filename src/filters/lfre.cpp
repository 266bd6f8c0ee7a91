// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/lfre.hpp"

#include "core/solvers.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/engine/filter_of.hpp"

namespace garrison {
namespace {

constexpr double kFirstPole = 0.3;
constexpr double kLastPole = 0.4;

std::vector<double> poles_for(const std::vector<double>& given, int n) {
  if (!given.empty()) {
    if (static_cast<int>(given.size()) != n)
      refuse("lfre.poles", std::to_string(given.size()) + " numbers", std::to_string(n) + ", one per state");
    return given;
  }
  std::vector<double> poles;
  for (int k = 0; k < n; ++k)
    poles.push_back(n == 1 ? kFirstPole : kFirstPole + (kLastPole - kFirstPole) * k / (n - 1));
  return poles;
}

/// Ackermann: the unique H with eig(A - H c) = poles, for an observable pair (A, c).
Vector ackermann(const Matrix& A, const Matrix& c, const std::vector<double>& poles) {
  const auto n = A.rows();
  Matrix polynomial = Matrix::Identity(n, n);
  for (const double pole : poles) polynomial *= A - pole * Matrix::Identity(n, n);
  Matrix O(n, n);
  O.row(0) = c;
  for (Eigen::Index k = 1; k < n; ++k) O.row(k) = O.row(k - 1) * A;
  return polynomial * O.partialPivLu().solve(Vector::Unit(n, n - 1));
}

}  // namespace

Lfre::Gains Lfre::design(const Params& params, const Model& model, const Network& network) {
  const int N = model.agents();
  const auto poles = poles_for(params.poles, model.states());
  Gains g;
  g.faulty = params.faulty;
  std::vector<int> distance(static_cast<std::size_t>(N), -1);
  std::vector<int> queue;
  for (int i = 0; i < N; ++i) {
    const bool source = model.outputs(i) > 0 && observable(model.A(), model.C(i).topRows(1));
    g.observer.push_back(source ? ackermann(model.A(), model.C(i).topRows(1), poles) : Vector());
    if (!source) continue;
    distance[static_cast<std::size_t>(i)] = 0;
    queue.push_back(i);
  }
  if (queue.empty())
    refuse("model", "no agent that can observe the whole state alone", "at least one",
           "lfre spreads the estimates of such sources; use the saturation filter here");
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (int j = 0; j < N; ++j) {
      const auto heard = network.neighbours(j);
      if (distance[static_cast<std::size_t>(j)] >= 0 ||
          !std::binary_search(heard.begin(), heard.end(), queue[k]))
        continue;
      distance[static_cast<std::size_t>(j)] = distance[static_cast<std::size_t>(queue[k])] + 1;
      queue.push_back(j);
    }
  for (int i = 0; i < N; ++i) {
    auto& parents = g.parents.emplace_back();
    const int own = distance[static_cast<std::size_t>(i)];
    for (const int j : network.neighbours(i)) {
      const int theirs = distance[static_cast<std::size_t>(j)];
      if (theirs >= 0 && (own < 0 || theirs < own)) parents.push_back(j);
    }
    const auto heard = network.neighbours(i);
    if (static_cast<int>(parents.size()) < 2 * g.faulty + 1) parents.assign(heard.begin(), heard.end());
  }
  return g;
}

Check Lfre::check(const Params& params, const Model& model, const Network& network) {
  Check c;
  const Gains g = design(params, model, network);
  double sources = 0.0;
  std::size_t fewest = static_cast<std::size_t>(model.agents());
  for (std::size_t i = 0; i < g.observer.size(); ++i) {
    if (g.observer[i].size() != 0)
      sources += 1.0;
    else
      fewest = std::min(fewest, g.parents[i].size());
  }
  const double needed = 2.0 * g.faulty + 1.0;
  c.conditions.push_back({"sources", sources, ">= " + text(needed), sources >= needed,
                          "agents that observe the whole state alone"});
  c.conditions.push_back({"fewest parents", static_cast<double>(fewest), ">= " + text(needed),
                          static_cast<double>(fewest) >= needed,
                          "trimming leaves at least one honest value"});
  return c;
}

template FamilyInfo family_info<Lfre>();

}  // namespace garrison
