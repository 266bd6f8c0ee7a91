// SPDX-License-Identifier: Apache-2.0
// Who hears whom.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

/// (sender, receiver); in an undirected network each pair stands for both directions.
using Edge = std::pair<int, int>;

/// Extreme nontrivial eigenvalues of the Laplacian of an undirected network; both 0 for one agent.
struct LaplacianSpectrum {
  double lambda2;     ///< algebraic connectivity, > 0 exactly when connected
  double lambda_max;  ///< largest eigenvalue
};

/// In-neighbour lists of N agents. Immutable once built; every list is sorted by agent id.
/// An edge given twice counts once.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT Network {
 public:
  /// `names`: what people call the agents, one each; empty = no names. No filter reads them.
  /// @throws InvalidInput when agents < 1, an index is outside 0..agents-1, an edge is a self-loop, or names
  /// are empty, occur twice or do not fit in number.
  Network(int agents, std::span<const Edge> edges, bool directed = false,
          std::vector<std::string> names = {});

  int agents() const { return static_cast<int>(offsets_.size()) - 1; }
  bool directed() const { return directed_; }
  const std::vector<std::string>& names() const { return names_; }
  bool operator==(const Network&) const = default;
  /// The agents that `agent` hears, without itself.
  std::span<const int> neighbours(int agent) const;
  int degree(int agent) const { return static_cast<int>(neighbours(agent).size()); }
  int max_degree() const;
  /// The lists of all agents one behind the other, and where each begins (N+1 numbers).
  std::span<const int> lists() const { return lists_; }
  std::span<const int> offsets() const { return offsets_; }
  /// Each edge once: (smaller, larger) when undirected, (sender, receiver) when directed.
  std::vector<Edge> edges() const;

  /// Everybody can reach everybody (strongly connected when directed).
  bool connected() const;
  /// Refuses with "graph is not connected (lambda_2 = 0)" and the agents that are cut off.
  void require_connected() const;
  /// @throws InvalidInput when directed.
  LaplacianSpectrum laplacian_spectrum() const;

  /// Dense N x N matrices. Laplacian: in-degree on the diagonal, -1 for each neighbour.
  Matrix laplacian() const;
  /// I - step * Laplacian; step > 0.
  Matrix laplacian_weights(double step) const;
  /// w_ij = 1/(1 + max(d_i, d_j)), the rest on the diagonal: symmetric, doubly stochastic (undirected only).
  Matrix metropolis_weights() const;
  /// I - Laplacian / (1 + max degree): row-stochastic, symmetric when undirected.
  Matrix max_degree_weights() const;

  static Network ring(int agents);
  static Network path(int agents);
  /// i and j hear each other when |i - j| <= `range` (>= 1): a string with messages to the `range` nearest.
  static Network band(int agents, int range);
  static Network star(int agents);
  static Network complete(int agents);
  static Network grid(int rows, int columns);
  /// Points uniform in the unit square, an edge where the distance is below `radius` (> 0).
  /// Same seed, same network. `positions`, if given, receives the N x 2 coordinates.
  static Network random_geometric(int agents, double radius, std::uint64_t seed, Matrix* positions = nullptr);
  /// Each pair is an edge with `probability` in [0, 1], independently.
  static Network erdos_renyi(int agents, double probability, std::uint64_t seed);

 private:
  std::vector<int> offsets_;
  std::vector<int> lists_;
  bool directed_;
  std::vector<std::string> names_;
};

}  // namespace garrison
