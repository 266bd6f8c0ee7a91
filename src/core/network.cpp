// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/network.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace garrison {
namespace {

/// Marks all agents reachable from agent 0 along the given lists; returns how many.
int reach(std::span<const int> offsets, std::span<const int> lists, std::vector<char>& seen) {
  std::vector<int> stack{0};
  seen.assign(offsets.size() - 1, 0);
  seen[0] = 1;
  int count = 1;
  while (!stack.empty()) {
    const auto i = static_cast<std::size_t>(stack.back());
    stack.pop_back();
    for (int k = offsets[i]; k < offsets[i + 1]; ++k) {
      const int j = lists[static_cast<std::size_t>(k)];
      if (seen[static_cast<std::size_t>(j)]) continue;
      seen[static_cast<std::size_t>(j)] = 1;
      ++count;
      stack.push_back(j);
    }
  }
  return count;
}

/// Sorted lists of senders per receiver from (receiver, sender) pairs, duplicates removed.
void build_lists(int agents, std::vector<Edge> pairs, std::vector<int>& offsets, std::vector<int>& lists) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  offsets.assign(static_cast<std::size_t>(agents) + 1, 0);
  lists.clear();
  lists.reserve(pairs.size());
  for (const auto& [receiver, sender] : pairs) {
    ++offsets[static_cast<std::size_t>(receiver) + 1];
    lists.push_back(sender);
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
}

/// Room for a dense N x N matrix.
void require_square(const Network& network) {
  const double N = network.agents();
  require_memory("network", amount(network.agents(), "agent"), 8.0 * N * N);
}

}  // namespace

Network::Network(int agents, std::span<const Edge> edges, bool directed, std::vector<std::string> names)
    : directed_(directed), names_(std::move(names)) {
  if (agents < 1) refuse("agents", std::to_string(agents), "at least 1");
  require_memory("agents", std::to_string(agents), 4.0 * agents);
  std::vector<Edge> pairs;
  pairs.reserve(edges.size() * (directed ? 1 : 2));
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto [from, to] = edges[k];
    const std::string which = "edges[" + std::to_string(k) + "]";
    const std::string got = "(" + std::to_string(from) + ", " + std::to_string(to) + ")";
    if (from < 0 || to < 0 || from >= agents || to >= agents)
      refuse(which, got, "indices in 0.." + std::to_string(agents - 1), "agents are numbered from 0");
    if (from == to)
      refuse(which, got + ", a self-loop", "two different agents", "an agent always knows itself");
    pairs.emplace_back(to, from);
    if (!directed) pairs.emplace_back(from, to);
  }
  build_lists(agents, std::move(pairs), offsets_, lists_);
  require_names("names", names_, static_cast<std::size_t>(agents), "agent");
}

std::span<const int> Network::neighbours(int agent) const {
  const auto i = static_cast<std::size_t>(agent);
  return std::span(lists_).subspan(static_cast<std::size_t>(offsets_[i]),
                                   static_cast<std::size_t>(offsets_[i + 1] - offsets_[i]));
}

int Network::max_degree() const {
  int largest = 0;
  for (int i = 0; i < agents(); ++i) largest = std::max(largest, degree(i));
  return largest;
}

std::vector<Edge> Network::edges() const {
  std::vector<Edge> all;
  for (int i = 0; i < agents(); ++i)
    for (const int j : neighbours(i))
      if (directed_ || j < i) all.emplace_back(j, i);
  std::sort(all.begin(), all.end());
  return all;
}

bool Network::connected() const {
  std::vector<char> seen;
  if (reach(offsets_, lists_, seen) != agents()) return false;
  if (!directed_) return true;
  std::vector<Edge> reversed;
  for (int i = 0; i < agents(); ++i)
    for (const int j : neighbours(i)) reversed.emplace_back(j, i);
  std::vector<int> offsets;
  std::vector<int> lists;
  build_lists(agents(), std::move(reversed), offsets, lists);
  return reach(offsets, lists, seen) == agents();
}

void Network::require_connected() const {
  if (connected()) return;
  std::vector<char> seen;
  reach(offsets_, lists_, seen);
  std::string cut;
  int shown = 0;
  for (int i = 0; i < agents() && shown < 5; ++i)
    if (!seen[static_cast<std::size_t>(i)]) cut += (shown++ ? ", " : "") + std::to_string(i);
  refuse("network", "a graph that is not connected (lambda_2 = 0)", "a connected one",
         shown ? "no path joins agent 0 and agent(s) " + cut
               : "some agents hear agent 0 but cannot be heard by it");
}

Matrix Network::laplacian() const {
  require_square(*this);
  Matrix lap = Matrix::Zero(agents(), agents());
  for (int i = 0; i < agents(); ++i) {
    lap(i, i) = degree(i);
    for (const int j : neighbours(i)) lap(i, j) = -1.0;
  }
  return lap;
}

Matrix Network::laplacian_weights(double step) const {
  if (!(step > 0.0) || !std::isfinite(step)) refuse("step", text(step), "a finite number > 0");
  return Matrix::Identity(agents(), agents()) - step * laplacian();
}

Matrix Network::metropolis_weights() const {
  require_square(*this);
  if (directed_) refuse("network", "a directed one", "an undirected one", "use max_degree_weights");
  Matrix w = Matrix::Zero(agents(), agents());
  for (int i = 0; i < agents(); ++i) {
    for (const int j : neighbours(i)) w(i, j) = 1.0 / (1.0 + std::max(degree(i), degree(j)));
    w(i, i) = 1.0 - w.row(i).sum();
  }
  return w;
}

Matrix Network::max_degree_weights() const { return laplacian_weights(1.0 / (1.0 + max_degree())); }

}  // namespace garrison
