// SPDX-License-Identifier: Apache-2.0
// Named and random networks.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "garrison/core/network.hpp"
#include "garrison/core/random.hpp"

namespace garrison {
namespace {

/// Refuses more agents or edges than fit into memory before any of them is made.
void require_room(const std::string& which, double agents, double edges) {
  constexpr double agent_bytes = 8.0;
  constexpr double edge_bytes = 40.0;  // as a pair, sorted in both directions, and in the lists
  require_memory(which, text(agents) + " agents with " + text(edges) + " edges",
                 agent_bytes * agents + edge_bytes * edges);
}

double pairs_of(int agents) { return 0.5 * agents * (agents - 1.0); }

}  // namespace

Network Network::ring(int agents) {
  require_room("agents", agents, agents);
  std::vector<Edge> edges;
  for (int i = 0; i + 1 < agents; ++i) edges.emplace_back(i, i + 1);
  if (agents > 2) edges.emplace_back(agents - 1, 0);
  return {agents, edges};
}

Network Network::path(int agents) {
  require_room("agents", agents, agents);
  std::vector<Edge> edges;
  for (int i = 0; i + 1 < agents; ++i) edges.emplace_back(i, i + 1);
  return {agents, edges};
}

Network Network::band(int agents, int range) {
  if (range < 1) refuse("range", std::to_string(range), "at least 1");
  require_room("agents", agents, std::min(pairs_of(agents), static_cast<double>(agents) * range));
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i)
    for (int j = i + 1; j < agents && j - i <= range; ++j) edges.emplace_back(i, j);
  return {agents, edges};
}

Network Network::star(int agents) {
  require_room("agents", agents, agents);
  std::vector<Edge> edges;
  for (int i = 1; i < agents; ++i) edges.emplace_back(0, i);
  return {agents, edges};
}

Network Network::complete(int agents) {
  require_room("agents", agents, pairs_of(agents));
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i)
    for (int j = i + 1; j < agents; ++j) edges.emplace_back(i, j);
  return {agents, edges};
}

Network Network::grid(int rows, int columns) {
  if (rows < 1) refuse("rows", std::to_string(rows), "at least 1");
  if (columns < 1) refuse("columns", std::to_string(columns), "at least 1");
  const double all = static_cast<double>(rows) * columns;
  if (all > std::numeric_limits<int>::max())
    refuse("rows x columns", text(all), "at most " + std::to_string(std::numeric_limits<int>::max()));
  require_room("rows x columns", all, 2.0 * all);
  std::vector<Edge> edges;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int i = r * columns + c;
      if (c + 1 < columns) edges.emplace_back(i, i + 1);
      if (r + 1 < rows) edges.emplace_back(i, i + columns);
    }
  return {rows * columns, edges};
}

Network Network::random_geometric(int agents, double radius, std::uint64_t seed, Matrix* positions) {
  if (agents < 1) refuse("agents", std::to_string(agents), "at least 1");
  if (!(radius > 0.0) || !std::isfinite(radius)) refuse("radius", text(radius), "a finite number > 0");
  constexpr double pi = 3.141592653589793;
  require_room("agents", agents, pairs_of(agents) * std::min(1.0, pi * radius * radius));
  const Random random(seed, 0, Purpose::position);
  Matrix points(agents, 2);
  for (int i = 0; i < agents; ++i)
    for (int k = 0; k < 2; ++k)
      points(i, k) = random.uniform(0, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k));

  // Cells no smaller than the radius: neighbours are in the 3 x 3 cells around a point.
  const int side = static_cast<int>(std::clamp(1.0 / radius, 1.0, 1.0 + std::sqrt(agents)));
  const auto cell = [side](double coordinate) {
    return std::min(static_cast<int>(coordinate * side), side - 1);
  };
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i) {
    const int cx = cell(points(i, 0));
    const int cy = cell(points(i, 1));
    for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, side - 1); ++x)
      for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, side - 1); ++y)
        for (const int j : cells[static_cast<std::size_t>(x * side + y)])
          if ((points.row(i) - points.row(j)).squaredNorm() < radius * radius) edges.emplace_back(j, i);
    cells[static_cast<std::size_t>(cx * side + cy)].push_back(i);
  }
  if (positions != nullptr) *positions = std::move(points);
  return {agents, edges};
}

Network Network::erdos_renyi(int agents, double probability, std::uint64_t seed) {
  if (!(probability >= 0.0 && probability <= 1.0))
    refuse("probability", text(probability), "a number in [0, 1]");
  require_room("agents", agents, probability * pairs_of(agents));
  constexpr double most_draws = 1e11;  // minutes
  if (pairs_of(agents) > most_draws)
    refuse("agents", std::to_string(agents), "at most 447214: chance decides on every pair");
  const Random random(seed, 0, Purpose::graph);
  std::vector<Edge> edges;
  for (int i = 0; i < agents; ++i)
    for (int j = i + 1; j < agents; ++j)
      if (random.uniform(i, static_cast<std::uint32_t>(j)) < probability) edges.emplace_back(i, j);
  return {agents, edges};
}

}  // namespace garrison
