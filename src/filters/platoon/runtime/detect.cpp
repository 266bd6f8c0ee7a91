// SPDX-License-Identifier: Apache-2.0
// Algorithm 2 with the corrected (28), and the stronger tests of docs/filters/platoon.md#s-tests.
#include <algorithm>
#include <cmath>

#include "garrison/filters/platoon/view.hpp"

namespace garrison::platoon {
namespace {

/// The changes that one step makes to the sets of one vehicle.
class Detection {
 public:
  Detection(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept
      : id_(l.id), g_(shared.setting), o_(shared.options), view_(view), s_(s), sets_(s.sets) {}

  /// (27): sensors i-1 and i contradict each other.
  void neighbour_ahead() noexcept {
    const int own = g_.range;
    if (id_ == 0 || !view_[own].measured || !view_[own - 1].measured) return;
    if (sets_.attacked.contains(id_) || sets_.attacked.contains(id_ - 1)) return;
    if (!contradict(g_, 1, view_[own - 1].y, s_.y)) return;
    if (sets_.free.contains(id_)) return accuse(id_ - 1);
    if (sets_.free.contains(id_ - 1)) return accuse(id_);
    suspect(id_ - 1);
    if (!o_.cover) suspect(id_);
  }

  /// (28): the vehicle's own measurement is further from its prediction than any honest one can be.
  void own_innovation() noexcept {
    s_.innovation = kNaN;
    s_.level = innovation_level(g_, s_.foreseen.norm);
    bool fired = s_.impossible;
    if (s_.has_y) {
      s_.innovation = length(s_.y[0] - s_.prediction[0], s_.y[1] - s_.prediction[1]);
      fired = exceeds(s_.innovation, s_.level, length(s_.y) + length(s_.prediction.data()));
    }
    if (!fired || sets_.attacked.contains(id_)) return;
    if (!sets_.free.contains(id_)) return accuse(id_);
    if (s_.impossible) s_.trouble |= kFreeImpossible;
  }

  /// S6: (28) for what the neighbours measure.
  void other_innovations() noexcept {
    for (int p = 0; p < view_.size(); ++p) {
      if (p == g_.range || !view_[p].measured || known(view_.id_of(p))) continue;
      const double* y = view_[p].y;
      const double norm = length(y[0] - s_.prediction[0], y[1] - s_.prediction[1]);
      if (exceeds(norm, innovation_level(g_, s_.foreseen.norm, std::abs(p - g_.range)),
                  length(y) + length(s_.prediction.data())))
        accuse(view_.id_of(p));
    }
  }

  /// S4: all pairs in the window, and what at most b attackers leave possible.
  void all_pairs() noexcept {
    Suspicions& fired = *s_.suspicions;
    for (int p = 0; p < view_.size(); ++p) {
      for (int q = p + 1; q < view_.size() && view_[p].measured; ++q) {
        if (!view_[q].measured) continue;
        if (contradict(g_, q - p, view_[p].y, view_[q].y)) fired.fire(p, q);
      }
    }
    if (!fired.any()) return;
    std::uint64_t attacked = 0;
    std::uint64_t free = 0;
    int outside = sets_.attacked.count();
    for (int p = 0; p < view_.size(); ++p) {
      if (!view_.exists(p)) continue;
      if (sets_.attacked.contains(view_.id_of(p))) {
        attacked |= std::uint64_t{1} << p;
        --outside;
      } else if (sets_.free.contains(view_.id_of(p))) {
        free |= std::uint64_t{1} << p;
      }
    }
    const auto found = fired.conclude(attacked, free, g_.attacked - outside);
    if (found.contradiction) {
      s_.trouble |= kNoCover;
      return;
    }
    for (int p = 0; p < view_.size(); ++p) {
      if (!view_.exists(p)) continue;
      if ((found.attacked >> p & 1U) != 0) accuse(view_.id_of(p));
      if ((found.free >> p & 1U) != 0) clear(view_.id_of(p));
    }
  }

  /// (29) and lines 21-26: who must be free when all b attackers are accounted for.
  void settle() noexcept {
    if (!s_.changed) return;
    s_.changed = false;
    const int count = o_.cover ? least_cover() : least_in_runs();
    if (count > g_.attacked) s_.trouble |= kTooManyRuns;
    if (count == g_.attacked) {
      const auto suspects = std::span<const int>(room_, static_cast<std::size_t>(many_));
      // Everybody but the accused and the suspects; only those that are not free already stay excluded.
      if (!clear_all_but(suspects)) s_.trouble |= kNoRoom;
    }
    const int proved = sets_.attacked.count();
    if (proved == g_.attacked && !sets_.free.become_all_but(sets_.attacked, sets_.attacked))
      s_.trouble |= kNoRoom;
    if (proved > g_.attacked) s_.trouble |= kTooMany;
    for (const int id : sets_.attacked.listed())
      if (sets_.free.contains(id)) s_.trouble |= kBothSets;
  }

 private:
  bool known(int id) const noexcept { return sets_.attacked.contains(id) || sets_.free.contains(id); }
  void accuse(int id) noexcept { note(sets_.attacked, id); }
  void suspect(int id) noexcept { note(sets_.suspected, id); }
  void clear(int id) noexcept { note(sets_.free, id); }
  void note(LabelSet& set, int id) noexcept {
    if (set.contains(id)) return;
    s_.changed = true;
    if (!set.insert(id)) s_.trouble |= kNoRoom;
  }

  /// Left side of (29); leaves the accused and the suspects in room_.
  int least_in_runs() noexcept {
    const auto a = sets_.attacked.listed();
    const auto s = sets_.suspected.listed();
    many_ = static_cast<int>(std::set_union(a.begin(), a.end(), s.begin(), s.end(), room_) - room_);
    return count_runs({room_, static_cast<std::size_t>(many_)});
  }

  /// The exact count: proved sensors, and the least cover of the pairs that they do not explain. A pair with
  /// a free sensor accuses the other one first. Leaves the accused and the open pairs' sensors in room_.
  int least_cover() noexcept {
    for (const int e : sets_.suspected.listed()) {
      if (sets_.attacked.contains(e) || sets_.attacked.contains(e + 1)) continue;
      const bool first = sets_.free.contains(e);
      if (first && !sets_.free.contains(e + 1)) accuse(e + 1);
      if (!first && sets_.free.contains(e + 1)) accuse(e);
    }
    s_.changed = false;
    int open = 0;
    for (const int e : sets_.suspected.listed())
      if (!sets_.attacked.contains(e) && !sets_.attacked.contains(e + 1)) room_[open++] = e;
    const int count = sets_.attacked.count() + path_cover({room_, static_cast<std::size_t>(open)});
    // From pairs to sensors, from behind so that nothing is overwritten before it is read.
    many_ = 0;
    int* const sensors = room_ + open;
    for (int k = 0; k < open; ++k) {
      if (many_ == 0 || sensors[many_ - 1] != room_[k]) sensors[many_++] = room_[k];
      sensors[many_++] = room_[k] + 1;
    }
    std::copy_n(sensors, many_, room_);
    const auto a = sets_.attacked.listed();
    std::copy(a.begin(), a.end(), room_ + many_);
    many_ += static_cast<int>(a.size());
    std::sort(room_, room_ + many_);
    return count;
  }

  bool clear_all_but(std::span<const int> sorted) noexcept { return sets_.free.unite_all_but(sorted); }

  int id_;
  const Setting& g_;
  const Options& o_;
  const View& view_;
  VehicleState& s_;
  Sets& sets_;
  int many_ = 0;
  int room_[4 * LabelSet::kMost];
};

}  // namespace

void detect(const Local& l, const Shared& shared, const View& view, VehicleState& s) noexcept {
  Detection detection(l, shared, view, s);
  detection.neighbour_ahead();
  if (shared.options.pairs) detection.all_pairs();
  detection.own_innovation();
  if (shared.options.neighbours) detection.other_innovations();
  detection.settle();
}

}  // namespace garrison::platoon
