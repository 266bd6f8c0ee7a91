// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/strong_subgraph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "garrison/analysis/structure/components.hpp"

namespace garrison::structure {
namespace {

using Edge = std::pair<int, int>;

struct Arc {
  int from, to;
  double weight;
  int id;
};

/// Chu-Liu/Edmonds: cheapest arc into every vertex; cycles are contracted, their arcs repriced, and opened
/// again where the arborescence of the smaller graph enters. One level per contraction, at most `vertices`.
std::vector<int> edmonds(int vertices, const std::vector<Arc>& arcs, int root) {
  const auto V = static_cast<std::size_t>(vertices);
  std::vector<int> best(V, -1);  // cheapest arc into each vertex
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    const Arc& arc = arcs[a];
    if (arc.to == root || arc.from == arc.to) continue;
    int& now = best[static_cast<std::size_t>(arc.to)];
    if (now < 0 || arc.weight < arcs[static_cast<std::size_t>(now)].weight) now = static_cast<int>(a);
  }
  for (int v = 0; v < vertices; ++v)
    if (v != root && best[static_cast<std::size_t>(v)] < 0) return {};
  std::vector<int> color(V, -1);
  std::vector<int> group(V, -1);
  int groups = 0;
  bool cycle = false;
  for (int v = 0; v < vertices; ++v) {
    int u = v;
    while (u != root && color[static_cast<std::size_t>(u)] < 0) {
      color[static_cast<std::size_t>(u)] = v;
      u = arcs[static_cast<std::size_t>(best[static_cast<std::size_t>(u)])].from;
    }
    if (u == root || color[static_cast<std::size_t>(u)] != v || group[static_cast<std::size_t>(u)] >= 0)
      continue;
    cycle = true;
    for (int w = u; group[static_cast<std::size_t>(w)] < 0;
         w = arcs[static_cast<std::size_t>(best[static_cast<std::size_t>(w)])].from)
      group[static_cast<std::size_t>(w)] = groups;
    ++groups;
  }
  std::vector<int> chosen;
  if (!cycle) {
    for (int v = 0; v < vertices; ++v)
      if (v != root) chosen.push_back(arcs[static_cast<std::size_t>(best[static_cast<std::size_t>(v)])].id);
    return chosen;
  }
  const int cycles = groups;
  for (int& g : group)
    if (g < 0) g = groups++;
  std::vector<Arc> smaller;
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    const Arc& arc = arcs[a];
    const int from = group[static_cast<std::size_t>(arc.from)];
    const int to = group[static_cast<std::size_t>(arc.to)];
    if (from == to || arc.to == root) continue;
    const double paid =
        to < cycles ? arcs[static_cast<std::size_t>(best[static_cast<std::size_t>(arc.to)])].weight : 0.0;
    smaller.push_back({from, to, arc.weight - paid, static_cast<int>(a)});
  }
  const auto inner = edmonds(groups, smaller, group[static_cast<std::size_t>(root)]);
  if (inner.empty()) return {};
  std::vector<char> entered(V, 0);
  for (const int a : inner) {
    const Arc& arc = arcs[static_cast<std::size_t>(a)];
    chosen.push_back(arc.id);
    entered[static_cast<std::size_t>(arc.to)] = 1;
  }
  for (int v = 0; v < vertices; ++v)
    if (group[static_cast<std::size_t>(v)] < cycles && entered[static_cast<std::size_t>(v)] == 0)
      chosen.push_back(arcs[static_cast<std::size_t>(best[static_cast<std::size_t>(v)])].id);
  return chosen;
}

bool strong(int agents, std::span<const Edge> edges, const std::vector<char>& state) {
  std::vector<Edge> kept;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (state[e] != 0) kept.push_back(edges[e]);
  return strong_components(Pattern(agents, agents, kept)).count == 1;
}

/// Branch and bound: dear edges first are dropped or kept.
class Search {
 public:
  Search(int agents, std::span<const Edge> edges, std::span<const double> weights, long long nodes)
      : agents_(agents), edges_(edges), weights_(weights), nodes_(nodes), state_(edges.size(), 1) {
    order_.resize(edges.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) {
      return weights[static_cast<std::size_t>(a)] > weights[static_cast<std::size_t>(b)];
    });
  }
  double best = kInfinity;
  std::vector<char> chosen;
  bool finished() const { return nodes_ > 0; }

  /// state 1 = open, 2 = kept, 0 = dropped.
  void run(std::size_t at) {
    if (--nodes_ <= 0 || bound() >= best) return;
    if (at == order_.size()) {
      best = bound();
      chosen = state_;
      return;
    }
    char& s = state_[static_cast<std::size_t>(order_[at])];
    s = 0;
    if (strong(agents_, edges_, state_)) run(at + 1);
    s = 2;
    run(at + 1);
    s = 1;
  }

  /// What is kept, and the cheapest open edge into (or out of) every vertex that has none yet.
  double bound() const {
    const auto V = static_cast<std::size_t>(agents_);
    std::vector<double> into(V, kInfinity);
    std::vector<double> out(V, kInfinity);
    double kept = 0.0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (state_[e] == 0) continue;
      const double price = state_[e] == 2 ? 0.0 : weights_[e];
      if (state_[e] == 2) kept += weights_[e];
      auto& a = into[static_cast<std::size_t>(edges_[e].second)];
      auto& b = out[static_cast<std::size_t>(edges_[e].first)];
      a = std::min(a, price);
      b = std::min(b, price);
    }
    return kept + std::max(std::accumulate(into.begin(), into.end(), 0.0),
                           std::accumulate(out.begin(), out.end(), 0.0));
  }

 private:
  int agents_;
  std::span<const Edge> edges_;
  std::span<const double> weights_;
  long long nodes_;
  std::vector<char> state_;
  std::vector<int> order_;
};

std::vector<Edge> reversed(std::span<const Edge> edges) {
  std::vector<Edge> all;
  for (const auto& [from, to] : edges) all.emplace_back(to, from);
  return all;
}

}  // namespace

std::vector<int> cheapest_arborescence(int agents, std::span<const Edge> edges,
                                       std::span<const double> weights, int root) {
  std::vector<Arc> arcs;
  for (std::size_t e = 0; e < edges.size(); ++e)
    arcs.push_back({edges[e].first, edges[e].second, weights[e], static_cast<int>(e)});
  auto chosen = edmonds(agents, arcs, root);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

StrongSubgraph cheapest_strong_subgraph(int agents, std::span<const Edge> edges,
                                        std::span<const double> weights, long long max_nodes) {
  if (agents < 1) refuse("agents", std::to_string(agents), "at least 1");
  if (weights.size() != edges.size())
    refuse("weights", std::to_string(weights.size()), std::to_string(edges.size()) + ", one per edge");
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (!(weights[e] >= 0.0) || !std::isfinite(weights[e]))
      refuse("weights[" + std::to_string(e) + "]", text(weights[e]), "a finite number >= 0");
  StrongSubgraph found;
  if (strong_components(Pattern(agents, agents, edges)).count != 1) return found;
  found.exists = true;
  if (agents == 1) {
    found.cost = found.lower_bound = 0.0;
    found.exact = true;
    return found;
  }
  const auto backwards = reversed(edges);
  Search search(agents, edges, weights, max_nodes);
  double trees = 0.0;  // an optimal network contains an arborescence out of and one into every root
  for (int root = 0; root < agents; ++root) {
    std::vector<char> state(edges.size(), 0);
    for (const auto& given : {std::span<const Edge>(edges), std::span<const Edge>(backwards)}) {
      double tree = 0.0;
      for (const int e : cheapest_arborescence(agents, given, weights, root)) {
        state[static_cast<std::size_t>(e)] = 2;
        tree += weights[static_cast<std::size_t>(e)];
      }
      trees = std::max(trees, tree);
    }
    double cost = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) cost += state[e] != 0 ? weights[e] : 0.0;
    if (cost < search.best) {
      search.best = cost;
      search.chosen = state;
    }
  }
  found.lower_bound = std::max(trees, search.bound());
  search.run(0);
  found.exact = search.finished();
  found.cost = search.best;
  if (found.exact) found.lower_bound = found.cost;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (search.chosen[e] != 0) found.edges.push_back(static_cast<int>(e));
  return found;
}

}  // namespace garrison::structure
