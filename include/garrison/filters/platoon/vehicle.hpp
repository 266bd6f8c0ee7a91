// SPDX-License-Identifier: Apache-2.0
// What one vehicle remembers, what it sends (6), and the settings that all share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "garrison/core/filter.hpp"
#include "garrison/core/label_set.hpp"
#include "garrison/filters/platoon/detector.hpp"
#include "garrison/filters/platoon/formation.hpp"
#include "garrison/filters/platoon/setting.hpp"

namespace garrison::platoon {

enum class BoundKind : std::uint8_t { safe, tight, printed };

/// Which variants run; the defaults are the paper with its errors mended.
struct Options {
  bool detector = true;
  BoundKind bound = BoundKind::safe;
  bool tie_by_bound = false;    ///< (13), equally near sources: the smaller error bound wins
  bool cover = false;           ///< S5 of docs/filters/platoon.md: flood pairs and count (29) exactly
  bool pairs = false;           ///< S4: all pairs within range
  bool neighbours = false;      ///< S6: (28) for every neighbour
  bool median = false;          ///< S3: the median where its bound is smaller
  bool accuse_missing = false;  ///< a missing (NaN) absolute measurement counts as proof

  template <class V>
  void visit(V& v) {
    v("detector", detector);
    v.choice("bound", bound, 3);
    v("tie_by_bound", tie_by_bound);
    v("cover", cover);
    v("pairs", pairs);
    v("neighbours", neighbours);
    v("median", median);
    v("accuse_missing", accuse_missing);
  }
};

/// Sets that a vehicle is told before the start.
struct Prior {
  std::vector<int> attacked, suspected, free;

  template <class V>
  void visit(V& v) {
    v("attacked", attacked);
    v("suspected", suspected);
    v("free", free);
  }
};

/// Shared by all vehicles.
struct Shared {
  Setting setting;
  Options options;
  Formation formation;
  std::vector<Prior> priors;  ///< per vehicle, or empty
  int room = 0;               ///< most members of an attacked or suspected set
  int room_free = 0;          ///< most listed labels of a free set

  template <class V>
  void visit(V& v) {
    v("setting", setting);
    v("options", options);
    v("formation", formation);
    v("priors", priors);
    v.range("room", room, 0, LabelSet::kMost);
    v.range("room_free", room_free, 0, 65535);
  }
};

/// Why a vehicle no longer vouches: the data contradict Assumptions 1 and 2. Bits.
enum Trouble : unsigned {
  kTooMany = 1,         ///< more than b sensors proved attacked
  kTooManyRuns = 2,     ///< left side of (29) above b
  kBothSets = 4,        ///< a sensor both proved attacked and free
  kFreeImpossible = 8,  ///< a free sensor showed what no honest one can
  kNoRoom = 16,         ///< more suspects than b attackers can cause
  kNoCover = 32,        ///< fired pairs that b attackers cannot explain
  kHeard = 64,          ///< a vehicle in range says one of these
  kQuorum = 128,  ///< a median that liars cannot move is further from the prediction than all bounds allow
};

/// The three sets of Algorithm 2. With Options::cover, `suspected` holds pairs: e stands for (e, e+1).
struct Sets {
  LabelSet attacked, suspected, free;

  template <class V>
  void visit(V& v) {
    v("attacked", attacked);
    v("suspected", suspected);
    v("free", free);
  }
};

/// Of a design file: vehicle l.id of such a string hears `neighbours`, and the settings lead nowhere else.
inline bool fits(const Shared& g, const Local& l, std::span<const int> neighbours) noexcept {
  const int N = l.agents;
  const int L = g.setting.range;
  const bool string = l.states == 2 && l.outputs >= (l.id > 0 ? 4 : 2) && g.setting.vehicles == N &&
                      g.setting.attacked <= L && N >= 2 * L + 1 &&
                      std::all_of(neighbours.begin(), neighbours.end(),
                                  [&](int j) { return std::max(j, l.id) - std::min(j, l.id) <= L; });
  if (!string || (g.formation.steers() && g.formation.reference.empty())) return false;
  if (g.priors.empty()) return true;
  if (g.priors.size() != static_cast<std::size_t>(N)) return false;
  const Prior& prior = g.priors[static_cast<std::size_t>(l.id)];
  const auto known = [N](const std::vector<int>& ids, int room) {
    return ids.size() <= static_cast<std::size_t>(room) &&
           std::all_of(ids.begin(), ids.end(), [N](int id) { return id >= 0 && id < N; });
  };
  return known(prior.attacked, g.room) && known(prior.suspected, g.room) && known(prior.free, g.room_free);
}

struct VehicleState {
  Vec<2> x = Vec<2>::Zero();           ///< xhat_i(t)
  Vec<2> prediction = Vec<2>::Zero();  ///< xbar_i(t)
  Bound alpha;                         ///< alpha_i(t); NaN: a gap lies behind this estimate
  Bound foreseen;                      ///< the same of xbar_i(t), E
  double beta = kNaN;                  ///< beta_i(t); NaN outside V_1
  double u = 0.0;                      ///< u_i(t) of Algorithm 3; NaN: the filter only observes
  double applied = kNaN;               ///< recorded input since t; NaN = u
  double y[2] = {0.0, 0.0};            ///< y_ii
  double link[2] = {0.0, 0.0};         ///< y_{i-1,i}
  double innovation = kNaN;            ///< ||y_ii - xbar_i||
  double level = kNaN;                 ///< g_i of (28)
  double gap[2] = {kNaN, kNaN};        ///< certified least gap, certified spacing error
  std::int64_t t = -1;
  int source = -1;       ///< j_i(t) of (13); -1 = none
  unsigned trouble = 0;  ///< bits of Trouble, never cleared
  bool has_y = false;
  bool has_link = false;
  bool impossible = false;  ///< the absolute sensor showed what no honest one can
  bool changed = true;      ///< sets, since (29) was last counted
  Verdict verdict = Verdict::silent;
  Sets sets;
  std::unique_ptr<double[]> gains;         ///< k_{i,m} (14), m = i-L..i+L; V_1 only
  std::unique_ptr<Suspicions> suspicions;  ///< Options::pairs only

  template <class V>
  void visit(V& v) {
    v("estimate", x);
    v("prediction", prediction);
    v("alpha", alpha);
    v("foreseen", foreseen);
    v("beta", beta);
    v("u", u);
    v("applied", applied);
    v("y", y);
    v("link", link);
    v("innovation", innovation);
    v("level", level);
    v("gap", gap);
    v.range("t", t, -1, INT64_MAX / 4);
    v.range("source", source, -1, 65535);
    v("trouble", trouble);
    v("has_y", has_y);
    v("has_link", has_link);
    v("impossible", impossible);
    v("changed", changed);
    v.choice("verdict", verdict, kVerdicts);
    v("sets", sets);
    if (gains != nullptr)
      for (int k = 0; k < window; ++k) v("gains", gains[static_cast<std::size_t>(k)]);
    if (suspicions != nullptr) v("suspicions", *suspicions);
  }
  int window = 0;  ///< 2 L + 1, the size of gains
};

struct VehicleMessage {
  bool has_y = false;
  bool has_link = false;
  bool doubt = false;      ///< the sender's data contradict the assumptions
  double numbers[6] = {};  ///< y_ii, y_{i-1,i}, xbar_i(t)
  double bound = kNaN;  ///< on the error of xbar_i(t), what (6) has alpha_i(t-1) for; NaN: nothing is known
  Sets sets;            ///< of t-1

  template <class V>
  void visit(V& v) {
    v.numbers("absolute", std::span<double>(numbers, 2));
    v.numbers("relative", std::span<double>(numbers + 2, 2));
    v.numbers("prediction", std::span<double>(numbers + 4, 2));
    v.optional("bound", bound);
    v.flag("has_absolute", has_y);
    v.flag("has_relative", has_link);
    v.flag("doubt", doubt);
    v.labels("attacked", sets.attacked);
    v.labels("suspected", sets.suspected);
    v.labels("free", sets.free);
  }
  bool covered() const { return !std::isnan(bound); }
  const double* y() const { return numbers; }
  const double* link() const { return numbers + 2; }
  const double* prediction() const { return numbers + 4; }
};

GARRISON_EXPORT void start(const Local& local, const Shared& shared, const Vec<2>& x0, VehicleState& s,
                           VehicleMessage& m);
GARRISON_EXPORT void sense(const Local& local, const Shared& shared, VehicleState& s, const double* y,
                           std::int64_t t, VehicleMessage& m) noexcept;
GARRISON_EXPORT void fuse(const Local& local, const Shared& shared, VehicleState& s,
                          const Inbox<VehicleMessage>& inbox) noexcept;
/// What a vehicle makes of the messages of one sample when its own past is of no use: S3 or its best source.
GARRISON_EXPORT void rejoin(const Local& local, const Shared& shared, VehicleState& s,
                            const Inbox<VehicleMessage>& inbox, std::int64_t t) noexcept;

}  // namespace garrison::platoon
