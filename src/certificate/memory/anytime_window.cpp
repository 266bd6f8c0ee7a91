// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/anytime_window.hpp"

#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "ellipsoid_union.hpp"
#include "leverage_room.hpp"

namespace garrison::certificate {
namespace {

/// What a leaf says of a source.
enum class Says : char { undecided, attacked, honest, proved };

struct Leaf {
  std::vector<Says> says;  // per source
  std::vector<char> kept;  // rows behind its region
  Region region;
  double mu = 0.0;

  int attacked() const {
    return static_cast<int>(std::count_if(says.begin(), says.end(),
                                          [](Says s) { return s == Says::attacked || s == Says::proved; }));
  }
};

}  // namespace

struct AnytimeWindowWorkspace::Room {
  Room(const Window& w, int most)
      : by_leverage(w),
        fit(w.most_unknowns()),
        direction(w.most_unknowns()),
        pull(w.most_unknowns()),
        leaves(static_cast<std::size_t>(most)),
        all(w.states(), most) {
    const auto prepare = [&](Leaf& leaf) {
      leaf.says.resize(static_cast<std::size_t>(w.sources()));
      leaf.kept.resize(static_cast<std::size_t>(w.most_rows()));
      leaf.region = by_leverage.witness.region;
    };
    for (Leaf& leaf : leaves) prepare(leaf);
    prepare(parent);
    prepare(child);
    attacked.reserve(child.says.size());
    honest.reserve(child.says.size());
    witness.region = by_leverage.witness.region;
    witness.proofs.reserve(child.says.size());
  }

  LeverageWindowWorkspace::Room by_leverage;
  detail::WindowFit fit;
  Vector direction, pull;
  std::vector<Leaf> leaves;  // the first `count` are open
  Leaf parent, child;
  std::vector<int> attacked, honest;
  detail::EllipsoidUnion all;
  std::size_t count = 0;
  WindowWitness witness;

  bool ask(const Window& w, const WindowAssumption& a, Leaf& leaf);
  bool explained(const Window& w, const WindowAssumption& a, const Leaf& leaf);
  std::size_t widest() const;
  int to_split(const Window& w, const Leaf& leaf);
  void add_child(const Window& w, const WindowAssumption& a, int source, Says says);
  void close(const Window& w);
  const WindowWitness& answer(const Window& w, const WindowAssumption& a);
};

/// W2M with what the leaf says; false when the data refute the leaf.
bool AnytimeWindowWorkspace::Room::ask(const Window& w, const WindowAssumption& a, Leaf& leaf) {
  attacked.clear();
  honest.clear();
  for (std::size_t k = 0; k < leaf.says.size(); ++k) {
    if (leaf.says[k] == Says::attacked) attacked.push_back(static_cast<int>(k));
    if (leaf.says[k] == Says::honest) honest.push_back(static_cast<int>(k));
  }
  const WindowAssumption given{a.s, a.levels, false, attacked, honest};
  const WindowWitness& found = by_leverage.answer(w, given);
  if (found.region.refuted()) return false;
  leaf.region = found.region;
  leaf.mu = found.mu;
  leaf.kept = by_leverage.best_kept;
  for (const Proof& proof : found.proofs) {
    Says& says = leaf.says[static_cast<std::size_t>(proof.source)];
    if (says == Says::undecided) says = Says::proved;
  }
  // With nothing left to decide the residuals of the rest must be noise.
  return leaf.attacked() != a.s || !leaf.region.answered() || explained(w, a, leaf);
}

bool AnytimeWindowWorkspace::Room::explained(const Window& w, const WindowAssumption& a, const Leaf& leaf) {
  const auto uses = [&](int r) {
    if (w.source(r) < 0) return true;
    const Says says = leaf.says[static_cast<std::size_t>(w.source(r))];
    return says != Says::attacked && says != Says::proved;
  };
  fit.clear(w.unknowns());
  double bias2 = w.prior_length() * w.prior_length();
  for (int r = 0; r < w.rows(); ++r) {
    if (!uses(r)) continue;
    fit.add(w, r);
    bias2 += w.bias(r) * w.bias(r);
  }
  if (!fit.solve()) return true;
  auto v = direction.head(w.unknowns());
  for (int r = 0; r < w.rows(); ++r) {
    if (!uses(r)) continue;
    v = w.N(r);
    fit.to_frame(v);
    const double free = fit.free(v);
    const double slack = 1e-12 * (1.0 + std::abs(w.z(r))) + 1e-9 + fit.rounding();
    const double room = (a.levels.z1 + std::sqrt(bias2)) * free + slack;
    if (!(std::abs(w.z(r) - w.N(r).dot(fit.theta())) <= room)) return false;
  }
  return true;
}

/// The first of the open leaves with the largest ball.
std::size_t AnytimeWindowWorkspace::Room::widest() const {
  std::size_t at = 0;
  for (std::size_t k = 1; k < count; ++k)
    if (leaves[k].region.radius > leaves[at].region.radius) at = k;
  return at;
}

/// The undecided source that moves the leaf's state most (without a region: that knows most); -1 without one.
int AnytimeWindowWorkspace::Room::to_split(const Window& w, const Leaf& leaf) {
  const int p = w.unknowns();
  bool has_fit = leaf.region.answered();
  if (has_fit) {
    fit.clear(p);
    for (int r = 0; r < w.rows(); ++r)
      if (leaf.kept[static_cast<std::size_t>(r)] != 0) fit.add(w, r);
    has_fit = fit.solve();
  }
  int best = -1;
  double most = -1.0;
  auto sum = pull.head(p);
  for (int source = 0; source < w.sources(); ++source) {
    if (leaf.says[static_cast<std::size_t>(source)] != Says::undecided) continue;
    sum.setZero();
    double influence = 0.0;
    bool present = false;
    for (int r = 0; r < w.rows(); ++r) {
      if (w.source(r) != source) continue;
      present = true;
      if (has_fit)
        sum += (w.z(r) - w.N(r).dot(fit.theta())) * w.N(r);
      else
        influence += w.N(r).squaredNorm();
    }
    if (!present) continue;
    if (has_fit) {
      fit.to_frame(sum);
      for (Eigen::Index i = 0; i < w.states(); ++i) {
        auto e = direction.head(p);
        e = w.E().row(i).transpose();
        fit.to_frame(e);
        const double moved = e.dot(sum);
        influence += moved * moved;
      }
      influence = std::sqrt(influence);
    }
    if (influence > most) {
      most = influence;
      best = source;
    }
  }
  return best;
}

void AnytimeWindowWorkspace::Room::add_child(const Window& w, const WindowAssumption& a, int source,
                                             Says says) {
  for (std::size_t k = 0; k < child.says.size();
       ++k)  // what W2M proved it proves again, or the leaf keeps it
    child.says[k] = parent.says[k] == Says::proved ? Says::undecided : parent.says[k];
  child.says[static_cast<std::size_t>(source)] = says;
  if (!ask(w, a, child)) return;
  Leaf& leaf = leaves[count++];
  leaf = child;
  if (!(child.region.radius > parent.region.radius) || !parent.region.answered()) return;
  // The region of the parent holds for the child too.
  leaf.region = parent.region;
  leaf.mu = parent.mu;
  leaf.kept = parent.kept;
  for (std::size_t k = 0; k < leaf.says.size(); ++k)
    if (parent.says[k] == Says::proved && leaf.says[k] == Says::undecided) leaf.says[k] = Says::proved;
}

/// The union of the open leaves.
void AnytimeWindowWorkspace::Room::close(const Window& w) {
  Region& region = witness.region;
  witness.count = static_cast<int>(count);
  region.radius = region.stretch = kNaN;
  if (count == 0) return;
  const auto open = std::span(leaves).first(count);
  const Leaf& first = leaves[widest()];
  region = first.region;
  witness.mu = count == 1 ? first.mu : kNaN;
  if (!first.region.answered()) {
    region.radius = region.stretch = kInfinity;
    return;
  }
  if (count > 1) {
    all.clear();
    for (const Leaf& leaf : open)
      all.add(leaf.region.center, leaf.region.shape, leaf.region.stretch, leaf.region.box);
    all.hull(region);
    all.enclose(first.region.shape, region);
    double radius = 0.0;  // each leaf's ball is already the better of ellipsoid and box
    for (const Leaf& leaf : open)
      radius = std::max(radius, (leaf.region.center - region.center).norm() + leaf.region.radius);
    region.radius = std::min(radius, region.box.norm());
  }
  for (int source = 0; source < w.sources(); ++source)
    if (std::all_of(open.begin(), open.end(), [&](const Leaf& leaf) {
          const Says says = leaf.says[static_cast<std::size_t>(source)];
          return says == Says::attacked || says == Says::proved;
        }))
      witness.proofs.push_back({source, kAlways});
}

const WindowWitness& AnytimeWindowWorkspace::Room::answer(const Window& w, const WindowAssumption& a) {
  count = 0;
  witness.proofs.clear();
  witness.mu = kNaN;
  std::fill(child.says.begin(), child.says.end(), Says::undecided);
  for (const int source : a.proved) child.says[static_cast<std::size_t>(source)] = Says::attacked;
  for (const int source : a.honest) child.says[static_cast<std::size_t>(source)] = Says::honest;
  if (ask(w, a, child)) leaves[count++] = child;
  while (count > 0 && count < leaves.size()) {
    const std::size_t at = widest();
    if (leaves[at].attacked() >= a.s) break;  // the widest cannot be split: no split of another one helps
    const int source = to_split(w, leaves[at]);
    if (source < 0) break;
    parent = leaves[at];
    --count;
    // Leaves stay in the order in which they were opened: ties go to the oldest.
    std::rotate(leaves.begin() + static_cast<std::ptrdiff_t>(at),
                leaves.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                leaves.begin() + static_cast<std::ptrdiff_t>(count) + 1);
    add_child(w, a, source, Says::attacked);
    add_child(w, a, source, Says::honest);
  }
  close(w);
  return witness;
}

AnytimeWindowWorkspace::AnytimeWindowWorkspace(const Window& window, int leaves) {
  detail::require_least("leaves", leaves, 1);
  detail::require_room("leaves",
                       static_cast<double>(leaves) * (window.most_rows() + window.sources() +
                                                      2.0 * window.states() * (window.states() + 2.0)));
  room_ = std::make_unique<Room>(window, leaves);
}
AnytimeWindowWorkspace::~AnytimeWindowWorkspace() = default;
AnytimeWindowWorkspace::AnytimeWindowWorkspace(AnytimeWindowWorkspace&&) noexcept = default;
AnytimeWindowWorkspace& AnytimeWindowWorkspace::operator=(AnytimeWindowWorkspace&&) noexcept = default;

const WindowWitness& anytime_window(const Window& window, const WindowAssumption& a,
                                    AnytimeWindowWorkspace& room) noexcept {
  return room.room_->answer(window, a);
}

WindowWitness anytime_window(const Window& window, const WindowAssumption& a, int leaves) {
  require(a, window);
  if (a.moving) refuse("moving", "true", "a set that is fixed in the window", "use leverage_window()");
  AnytimeWindowWorkspace room(window, leaves);
  return anytime_window(window, a, room);
}

}  // namespace garrison::certificate
