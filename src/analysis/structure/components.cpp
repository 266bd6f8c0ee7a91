// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/components.hpp"

#include <algorithm>
#include <limits>
#include <memory>

namespace garrison::structure {

Components strong_components(const Pattern& links) {
  const int n = links.columns();
  if (links.rows() != n)
    refuse("pattern", std::to_string(links.rows()) + " x " + std::to_string(n), "a square one");
  Components found;
  found.of.assign(static_cast<std::size_t>(n), 0);
  // low[v]: 0 = not seen, else the least visit number reached so far. When the component of v is complete,
  // low[v] becomes kDone + its number, which no minimum takes.
  int* const low = found.of.data();
  constexpr int kDone = std::numeric_limits<int>::min();
  struct Step {
    int vertex;
    int next;  // entry of its column that is looked at; complemented once low[vertex] has been lowered
  };
  // The path of the search and the vertices that wait for their component; together never more than n. Kept
  // small, since pages of fresh memory are a good part of the cost.
  const auto path_memory = std::make_unique_for_overwrite<Step[]>(static_cast<std::size_t>(n) + 1);
  const auto waiting_memory = std::make_unique_for_overwrite<int[]>(static_cast<std::size_t>(n) + 1);
  Step* const path = path_memory.get();
  int* const waiting = waiting_memory.get();
  const int* const start = links.start();
  const int* const index = links.index();
  int visits = 0;
  int waits = 0;
  for (int root = 0; root < n; ++root) {
    if (low[root] != 0) continue;
    int depth = 0;
    low[root] = ++visits;
    path[0] = {root, start[root]};
    while (depth >= 0) {
      const int v = path[depth].vertex;
      const int next = path[depth].next;
      bool lowered = next < 0;
      int p = lowered ? ~next : next;
      const int end = start[v + 1];
      int least = low[v];
      int child = -1;
      for (; p < end; ++p) {
        const int seen = low[index[p]];
        if (seen == 0) {
          child = index[p];
          break;
        }
        // A finished vertex is negative; as unsigned it is larger than every visit number.
        if (static_cast<unsigned>(seen) < static_cast<unsigned>(least)) {
          least = seen;
          lowered = true;
        }
      }
      low[v] = least;
      if (child >= 0) {
        path[depth].next = lowered ? ~p : p;  // looked at again after the child, whose low is known then
        low[child] = ++visits;
        path[++depth] = {child, start[child]};
        continue;
      }
      --depth;
      if (lowered) {
        waiting[waits++] = v;
        continue;
      }
      // v is the root of its component: its members wait behind the last vertex seen before v. (A waiting
      // member has low >= that of v; earlier ones are below.)
      const int mark = kDone + found.count++;
      while (waits > 0 && low[waiting[waits - 1]] >= least) low[waiting[--waits]] = mark;
      low[v] = mark;
    }
  }
  for (int v = 0; v < n; ++v) low[v] -= kDone;
  return found;
}

std::vector<char> parents(const Pattern& links, const Components& components) {
  std::vector<char> parent(static_cast<std::size_t>(components.count), 1);
  const int* of = components.of.data();
  for (int j = 0; j < links.columns(); ++j)
    for (const int i : links.column(j))
      if (of[i] != of[j]) parent[static_cast<std::size_t>(of[j])] = 0;
  return parent;
}

std::vector<std::vector<int>> Components::lists() const {
  std::vector<int> place(static_cast<std::size_t>(count), -1);
  std::vector<std::vector<int>> all;
  for (std::size_t v = 0; v < of.size(); ++v) {
    int& at = place[static_cast<std::size_t>(of[v])];
    if (at < 0) {
      at = static_cast<int>(all.size());
      all.emplace_back();
    }
    all[static_cast<std::size_t>(at)].push_back(static_cast<int>(v));
  }
  return all;
}

}  // namespace garrison::structure
