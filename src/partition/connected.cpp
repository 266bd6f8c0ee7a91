// SPDX-License-Identifier: Apache-2.0
#include "partition/connected.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "partition/ghost_numbers.hpp"

namespace garrison::partition {
namespace {

/// Own agents that hear each other, directly or through own agents: a number for each place.
std::vector<std::int32_t> pieces_of(const Region& r) {
  std::vector<std::int32_t> piece(static_cast<std::size_t>(r.own), -1);
  std::vector<std::int32_t> stack;
  for (std::int32_t start = 0, next = 0; start < r.own; ++start) {
    if (piece[static_cast<std::size_t>(start)] >= 0) continue;
    stack.push_back(start);
    piece[static_cast<std::size_t>(start)] = next;
    while (!stack.empty()) {
      const auto k = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      for (std::size_t e = r.first[k]; e < r.first[k + 1]; ++e) {
        const std::int32_t j = r.heard[e];
        if (j >= r.own || piece[static_cast<std::size_t>(j)] >= 0) continue;
        piece[static_cast<std::size_t>(j)] = next;
        stack.push_back(j);
      }
    }
    ++next;
  }
  return piece;
}

/// The least public id that each piece can reach, once no rank finds a lesser one.
std::vector<std::int32_t> reached(const Region& r, Exchange& exchange,
                                  const std::vector<std::int32_t>& piece) {
  std::vector<std::int32_t> least(static_cast<std::size_t>(1 + *std::max_element(piece.begin(), piece.end())),
                                  r.agents);
  const auto take = [&](int place, std::int32_t id) {
    std::int32_t& known = least[static_cast<std::size_t>(piece[static_cast<std::size_t>(place)])];
    if (id >= known) return std::int64_t{0};
    known = id;
    return std::int64_t{1};
  };
  for (int place = 0; place < r.own; ++place) take(place, r.ids[static_cast<std::size_t>(place)]);
  std::vector<std::int32_t> here(static_cast<std::size_t>(r.places()));
  GhostNumbers<std::int32_t> ghosts(r, exchange);
  for (std::int64_t changes[] = {1}; changes[0] > 0; exchange.sum(changes)) {
    for (const std::int32_t place : r.packed)
      here[static_cast<std::size_t>(place)] =
          least[static_cast<std::size_t>(piece[static_cast<std::size_t>(place)])];
    ghosts.fetch(here);
    changes[0] = 0;
    for (int place = r.interior; place < r.own; ++place)
      for (std::size_t e = r.first[static_cast<std::size_t>(place)];
           e < r.first[static_cast<std::size_t>(place) + 1]; ++e)
        if (r.heard[e] >= r.own) changes[0] += take(place, here[static_cast<std::size_t>(r.heard[e])]);
  }
  return least;
}

}  // namespace

void require_connected(const Region& region, Exchange& exchange) {
  const auto piece = pieces_of(region);
  const auto least = reached(region, exchange, piece);
  std::int64_t cut[] = {0};
  double first[] = {-static_cast<double>(region.agents)};  // of those that are cut off, negative
  for (int place = 0; place < region.own; ++place) {
    const auto k = static_cast<std::size_t>(place);
    if (least[static_cast<std::size_t>(piece[k])] == 0) continue;
    ++cut[0];
    first[0] = std::max(first[0], -static_cast<double>(region.ids[k]));
  }
  exchange.sum(cut);
  exchange.largest(first);
  if (cut[0] == 0) return;
  refuse("network", "a graph that is not connected (lambda_2 = 0)", "a connected one",
         "no path joins agent 0 and agent " + std::to_string(static_cast<int>(-first[0])) +
             (cut[0] > 1 ? ", nor " + std::to_string(cut[0] - 1) + " more" : ""));
}

}  // namespace garrison::partition
