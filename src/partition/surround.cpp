// SPDX-License-Identifier: Apache-2.0
#include "partition/surround.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>

namespace garrison::partition {
namespace {

std::size_t at(std::int64_t place) { return static_cast<std::size_t>(place); }

/// Adds the ghosts ring by ring; returns the lists of own agents and of all rings but the last, in public
/// ids.
std::vector<Neighbours> add_rings(Region& r, Neighbours own, const Lists& lists,
                                  std::span<const std::int32_t> owner, int rank, int depth) {
  std::vector<char> known(at(r.agents), 0);
  r.rings.assign(1, r.own);
  std::vector<Neighbours> all;
  all.push_back(std::move(own));
  for (int h = 1; h <= depth; ++h) {
    std::vector<int> ring;
    for (const int j : all.back().lists)
      if (owner[at(j)] != rank && !std::exchange(known[at(j)], char{1})) ring.push_back(j);
    std::sort(ring.begin(), ring.end(),
              [&](int a, int b) { return std::pair(owner[at(a)], a) < std::pair(owner[at(b)], b); });
    r.ids.insert(r.ids.end(), ring.begin(), ring.end());
    r.rings.push_back(r.places());
    if (h < depth) all.push_back(ring.empty() ? Neighbours() : lists(ring));
  }
  return all;
}

/// Lists in places.
void add_lists(Region& r, const std::vector<Neighbours>& all) {
  std::int64_t links = 0;
  for (const Neighbours& one : all) links += static_cast<std::int64_t>(one.lists.size());
  if (links > std::numeric_limits<std::int32_t>::max())
    refuse("partition", amount(links, "link") + " on one rank", "fewer than 2^31", "use more ranks");
  std::unordered_map<int, std::int32_t> ghosts;
  for (int place = r.own; place < r.places(); ++place) ghosts.emplace(r.ids[at(place)], place);
  const auto place_of = [&](int id) {
    const auto ghost = ghosts.find(id);
    if (ghost != ghosts.end()) return ghost->second;
    const auto own = std::lower_bound(r.sorted.begin(), r.sorted.end(), id,
                                      [&](int place, int wanted) { return r.ids[at(place)] < wanted; });
    return static_cast<std::int32_t>(*own);
  };
  r.first.assign(1, 0);
  r.heard.reserve(at(links));
  for (const Neighbours& one : all)
    for (std::size_t k = 0; k + 1 < one.offsets.size(); ++k) {
      for (const int j : one.of(k)) r.heard.push_back(place_of(j));
      r.first.push_back(r.heard.size());
    }
}

/// Neighbours of every place, as far as they are here: listed ones hear them, the outermost are heard by
/// them.
class Around {
 public:
  explicit Around(const Region& r) : r_(r), first_(at(r.places() - r.listed()) + 1, 0) {
    each_outer([&](std::size_t outer, int) { ++first_[outer + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    by_.resize(first_.back());
    std::vector<std::size_t> next = first_;
    each_outer([&](std::size_t outer, int place) { by_[next[outer]++] = place; });
  }
  std::span<const std::int32_t> of(int place) const {
    const bool listed = place < r_.listed();
    const auto k = at(listed ? place : place - r_.listed());
    const auto& first = listed ? r_.first : first_;
    return std::span(listed ? r_.heard : by_).subspan(first[k], first[k + 1] - first[k]);
  }

 private:
  template <class Action>
  void each_outer(const Action& action) const {
    for (int place = 0; place < r_.listed(); ++place)
      for (std::size_t e = r_.first[at(place)]; e < r_.first[at(place) + 1]; ++e)
        if (r_.heard[e] >= r_.listed()) action(at(r_.heard[e] - r_.listed()), place);
  }
  const Region& r_;
  std::vector<std::size_t> first_;
  std::vector<std::int32_t> by_;  // who hears each place of the outermost ring
};

/// Own agents within depth() hops of the places `from`, in ascending order of public ids.
std::vector<std::int32_t> own_near(const Region& r, const Around& around, std::vector<std::int32_t> from,
                                   int peer, std::vector<int>& seen) {
  std::vector<std::int32_t> found;
  std::vector<std::int32_t> next;
  for (const std::int32_t place : from) seen[at(place)] = peer;
  for (int hop = 0; hop < r.depth(); ++hop) {
    next.clear();
    for (const std::int32_t place : from)
      for (const std::int32_t other : around.of(place)) {
        if (std::exchange(seen[at(other)], peer) == peer) continue;
        next.push_back(other);
        if (other < r.own) found.push_back(other);
      }
    from.swap(next);
  }
  std::sort(found.begin(), found.end(),
            [&](std::int32_t a, std::int32_t b) { return r.ids[at(a)] < r.ids[at(b)]; });
  return found;
}

/// A path of depth() hops from an own agent to one of a peer has all of its links here, so both ranks find
/// the same agents.
void add_routes(Region& r, std::span<const std::int32_t> owner) {
  r.arrival.resize(at(r.ghosts()));
  std::iota(r.arrival.begin(), r.arrival.end(), r.own);
  const auto owner_of = [&](std::int32_t place) { return owner[at(r.ids[at(place)])]; };
  std::sort(r.arrival.begin(), r.arrival.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(owner_of(a), r.ids[at(a)]) < std::pair(owner_of(b), r.ids[at(b)]);
  });
  const Around around(r);
  std::vector<int> seen(r.ids.size(), -1);
  for (auto begin = r.arrival.begin(); begin != r.arrival.end();) {
    const int peer = owner_of(*begin);
    const auto end =
        std::find_if(begin, r.arrival.end(), [&](std::int32_t p) { return owner_of(p) != peer; });
    const auto sent = own_near(r, around, {begin, end}, peer, seen);
    r.routes.peers.push_back(peer);
    r.routes.sends.push_back(static_cast<int>(sent.size()));
    r.routes.receives.push_back(static_cast<int>(end - begin));
    r.packed.insert(r.packed.end(), sent.begin(), sent.end());
    begin = end;
  }
}

}  // namespace

void surround(Region& r, Neighbours neighbours, const Lists& lists, std::span<const std::int32_t> owner,
              int rank, int depth) {
  add_lists(r, add_rings(r, std::move(neighbours), lists, owner, rank, depth));
  add_routes(r, owner);
}

}  // namespace garrison::partition
