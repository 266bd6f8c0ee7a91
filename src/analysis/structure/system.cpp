// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/structure/system.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace garrison::structure {

std::string_view name_of(AgentClass c) {
  return c == AgentClass::alpha ? "alpha" : c == AgentClass::beta ? "beta" : "gamma";
}

System::System(Pattern A) : A_(std::move(A)) {
  if (A_.columns() < 1 || A_.rows() != A_.columns())
    refuse("A", std::to_string(A_.rows()) + " x " + std::to_string(A_.columns()),
           "a square pattern with at least one state");
  components_ = strong_components(A_);
  parent_ = parents(A_, components_);
  parent_count_ = static_cast<int>(std::count(parent_.begin(), parent_.end(), 1));
  parts_ = dulmage_mendelsohn(A_);
  in_union_.assign(static_cast<std::size_t>(states()), 0);
  for (const int j : parts_.hor_cols) in_union_[static_cast<std::size_t>(j)] = 1;
}

std::vector<int> System::contraction_union() const {
  std::vector<int> all = parts_.hor_cols;
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::vector<int>> System::parent_components() const {
  auto all = components_.lists();
  std::erase_if(all, [&](const std::vector<int>& c) { return !in_parent(c.front()); });
  return all;
}

void System::require(const Sensors& sensors) const {
  for (std::size_t i = 0; i < sensors.size(); ++i)
    for (const int s : sensors[i])
      if (s < 0 || s >= states())
        refuse("measured state of agent " + std::to_string(i), std::to_string(s),
               "a state in 0.." + std::to_string(states() - 1));
}

std::vector<int> System::seen_parents(const Sensors& sensors) const {
  std::vector<int> times(static_cast<std::size_t>(components_.count), 0);
  for (const auto& list : sensors) {
    std::set<int> own;
    for (const int s : list)
      if (in_parent(s)) own.insert(components_.of[static_cast<std::size_t>(s)]);
    for (const int c : own) ++times[static_cast<std::size_t>(c)];
  }
  return times;
}

namespace {

/// The matching of A continued in [A; C].
Augmenter with_sensors(const Pattern& stacked, const Matching& own) {
  Matching start = own;
  start.column_of.resize(static_cast<std::size_t>(stacked.rows()), -1);
  Augmenter search(stacked, std::move(start));
  for (int j = 0; j < stacked.columns(); ++j)
    if (search.row_of(j) < 0) search.augment(j);
  return search;
}

}  // namespace

Observability System::observability(const Sensors& sensors) const {
  require(sensors);
  Observability o;
  const auto times = seen_parents(sensors);
  o.output_connected = true;
  for (std::size_t c = 0; c < times.size(); ++c)
    o.output_connected = o.output_connected && (parent_[c] == 0 || times[c] > 0);
  const Pattern all = A_.stacked(sensors);
  o.rank_condition = with_sensors(all, parts_.matching).size() == states();
  return o;
}

std::vector<AgentClass> System::classes(const Sensors& sensors) const {
  require(sensors);
  std::vector<AgentClass> types;
  for (const auto& list : sensors) {
    const bool alpha = std::any_of(list.begin(), list.end(), [&](int s) { return in_contraction(s); });
    const bool beta = std::any_of(list.begin(), list.end(), [&](int s) { return in_parent(s); });
    types.push_back(alpha ? AgentClass::alpha : beta ? AgentClass::beta : AgentClass::gamma);
  }
  return types;
}

std::vector<char> System::necessary(const Sensors& sensors) const {
  require(sensors);
  std::vector<char> needed(sensors.size(), 0);
  if (!observability(sensors).holds()) return needed;
  const auto times = seen_parents(sensors);
  const Pattern all = A_.stacked(sensors);
  const Matching full = with_sensors(all, parts_.matching).take();
  // A matched row can be spared exactly when an unmatched row reaches it: the vertical part.
  const auto parts = dulmage_mendelsohn(all, full);
  std::vector<char> spare(static_cast<std::size_t>(all.rows()), 0);
  for (const int i : parts.ver_rows) spare[static_cast<std::size_t>(i)] = 1;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const bool only_eye = std::any_of(sensors[i].begin(), sensors[i].end(), [&](int s) {
      return in_parent(s) &&
             times[static_cast<std::size_t>(components_.of[static_cast<std::size_t>(s)])] == 1;
    });
    needed[i] = only_eye || spare[static_cast<std::size_t>(states()) + i] == 0 ? 1 : 0;
  }
  return needed;
}

std::vector<std::vector<int>> System::substitutes(const Sensors& sensors) const {
  require(sensors);
  const auto times = seen_parents(sensors);
  const Pattern all = A_.stacked(sensors);
  const Augmenter base = with_sensors(all, parts_.matching);
  std::vector<std::vector<int>> found(sensors.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    Augmenter search = base;
    const auto row = static_cast<int>(static_cast<std::size_t>(states()) + i);
    search.remove_row(row);
    // Which states restore the rank: all, those that the one unmatched column reaches, or none.
    std::vector<char> rank_ok(static_cast<std::size_t>(states()), 0);
    std::vector<int> left;
    for (int j = 0; j < states(); ++j)
      if (search.row_of(j) < 0 && !search.augment(j)) left.push_back(j);
    if (left.empty()) rank_ok.assign(rank_ok.size(), 1);
    if (left.size() == 1)
      for (const int j : reachable_columns(all, search.matching(), left))
        rank_ok[static_cast<std::size_t>(j)] = 1;
    // Which restore the connection: all, those of the one parent component nobody else sees, or none.
    std::set<int> own;
    for (const int s : sensors[i]) own.insert(components_.of[static_cast<std::size_t>(s)]);
    int blind = -1;
    int blind_count = 0;
    for (int c = 0; c < components_.count; ++c) {
      if (parent_[static_cast<std::size_t>(c)] == 0) continue;
      if (times[static_cast<std::size_t>(c)] - (own.contains(c) ? 1 : 0) > 0) continue;
      blind = c;
      ++blind_count;
    }
    if (blind_count > 1) continue;
    for (int s = 0; s < states(); ++s) {
      const bool itself = sensors[i].size() == 1 && sensors[i].front() == s;
      const bool seen = blind_count == 0 || components_.of[static_cast<std::size_t>(s)] == blind;
      if (!itself && seen && rank_ok[static_cast<std::size_t>(s)] != 0) found[i].push_back(s);
    }
  }
  return found;
}

std::map<int, std::vector<int>> System::contraction_of_measured(const Sensors& sensors) const {
  std::map<int, std::vector<int>> all;
  const auto types = classes(sensors);
  std::vector<int> alpha;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (types[i] == AgentClass::alpha) {
      if (sensors[i].size() != 1) return {};
      alpha.push_back(sensors[i].front());
    }
  if (static_cast<int>(alpha.size()) != states() - parts_.structural_rank()) return {};
  if (alpha.empty() || !observability(sensors).rank_condition) return {};
  // The rank condition makes the other columns match completely, so exactly these states stay unmatched.
  const Matching matching = maximum_matching(A_, alpha);
  for (const int u : alpha) {
    auto set = reachable_columns(A_, matching, std::span(&u, 1));
    std::sort(set.begin(), set.end());
    all.emplace(u, std::move(set));
  }
  return all;
}

std::vector<int> System::class_candidates(std::span<const int> measured, std::size_t agent,
                                          AgentClass as) const {
  if (agent >= measured.size())
    refuse("agent", std::to_string(agent), "an agent below " + std::to_string(measured.size()));
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (measured[i] >= states())
      refuse("measured state of agent " + std::to_string(i), std::to_string(measured[i]),
             "a state in 0.." + std::to_string(states() - 1) + ", or -1 for none");
  const int own = measured[agent];
  if (own < 0 || as == AgentClass::gamma) return {};
  std::vector<int> found;
  if (as == AgentClass::beta) {
    for (int s = 0; s < states(); ++s)
      if (components_.of[static_cast<std::size_t>(s)] == components_.of[static_cast<std::size_t>(own)])
        found.push_back(s);
  } else {
    std::vector<int> last;
    for (const int s : measured)
      if (s >= 0 && s != own) last.push_back(s);
    last.push_back(own);
    const Matching matching = maximum_matching(A_, last);
    if (matching.row_of[static_cast<std::size_t>(own)] >= 0) return {};
    found = reachable_columns(A_, matching, std::span(&own, 1));
    std::sort(found.begin(), found.end());
  }
  std::erase(found, own);
  return found;
}

Observability distributed_observability(const Pattern& A, const Sensors& sensors, const MatrixRef& W,
                                        const MatrixRef& U) {
  const auto N = static_cast<int>(sensors.size());
  for (const auto& [name, M] : {std::pair<const char*, const MatrixRef&>{"W", W}, {"U", U}})
    if (M.rows() != N || M.cols() != N)
      refuse(name, std::to_string(M.rows()) + " x " + std::to_string(M.cols()),
             std::to_string(N) + " x " + std::to_string(N) + ", because there are as many agents");
  const int n = A.columns();
  const Pattern mixing = Pattern::of(W);
  std::vector<int> start{0};
  std::vector<int> index;
  for (int b = 0; b < N; ++b)
    for (int j = 0; j < n; ++j) {
      for (const int a : mixing.column(b))
        for (const int i : A.column(j)) index.push_back(a * n + i);
      start.push_back(static_cast<int>(index.size()));
    }
  Sensors rows;
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < n; ++k) {
      // Row k of block i: everything that is measured together with state k.
      std::set<int> row;
      for (int j = 0; j < N; ++j) {
        const auto& c = sensors[static_cast<std::size_t>(j)];
        if (U(i, j) == 0.0 || std::find(c.begin(), c.end(), k) == c.end()) continue;
        for (const int s : c) row.insert(i * n + s);
      }
      if (!row.empty()) rows.emplace_back(row.begin(), row.end());
    }
  return System(Pattern(N * n, std::move(start), std::move(index))).observability(rows);
}

}  // namespace garrison::structure
