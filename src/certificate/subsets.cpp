// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/subsets.hpp"

#include <algorithm>
#include <cmath>

#include "least_squares.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

enum class Part : char { absent, left_out, in, proved };

double choices(int of, int take) {
  double count = 1.0;
  for (int k = 1; k <= take; ++k) count *= static_cast<double>(of - take + k) / k;
  return std::round(count);
}

}  // namespace

struct SubsetsWorkspace::Room {
  Room(int states, int sources, int capacity, int limit)
      : fit(states),
        part(static_cast<std::size_t>(sources)),
        cleared(static_cast<std::size_t>(sources)),
        x(states, limit),
        box(states, limit),
        radius(limit),
        c(states) {
    at_hand.reserve(static_cast<std::size_t>(sources));
    witness.region.center.resize(states);
    witness.region.box.resize(states);
    witness.kept.reserve(static_cast<std::size_t>(capacity));
    witness.proved.reserve(static_cast<std::size_t>(sources));
  }

  detail::LeastSquares fit;
  std::vector<Part> part;     // of each source in the set that is being tried
  std::vector<char> cleared;  // per source: in some consistent set
  std::vector<int> at_hand;   // sources with a row that are not proved
  int left = 0;
  // Consistent sets, one per column: their least-squares state, and how far the true one may be.
  Matrix x, box;
  Vector radius;
  Eigen::Index consistent = 0;
  Vector c;
  Witness witness;

  void begin(const Rows& rows, const Assumption& a);
  bool uses(const Rows& rows, int j) const {
    return part[static_cast<std::size_t>(rows.source(j))] == Part::in;
  }
  bool leave_out(const Rows& rows, const Levels& levels, double z3, std::size_t first, int more);
  bool judge(const Rows& rows, const Levels& levels, double z3);
  std::pair<Eigen::Index, double> furthest(const Vector& from) const;
  void enclose();
  void close(const Rows& rows);
};

void SubsetsWorkspace::Room::begin(const Rows& rows, const Assumption& a) {
  std::fill(part.begin(), part.end(), Part::absent);
  std::fill(cleared.begin(), cleared.end(), 0);
  for (const int source : a.proved) part[static_cast<std::size_t>(source)] = Part::proved;
  at_hand.clear();
  for (int source = 0; source < rows.sources(); ++source) {
    if (!rows.has(source) || part[static_cast<std::size_t>(source)] == Part::proved) continue;
    part[static_cast<std::size_t>(source)] = Part::in;
    at_hand.push_back(source);
  }
  left = a.s - static_cast<int>(a.proved.size());
  consistent = 0;
  witness.region.radius = kInfinity;
  witness.kept.clear();
  witness.proved.clear();
}

/// Tries all sets, those left out in lexicographic order. False when the rows of some set, consistent or not,
/// do not determine the state.
bool SubsetsWorkspace::Room::leave_out(const Rows& rows, const Levels& levels, double z3, std::size_t first,
                                       int more) {
  if (more == 0) return judge(rows, levels, z3);
  for (std::size_t k = first; k + static_cast<std::size_t>(more) <= at_hand.size(); ++k) {
    Part& of = part[static_cast<std::size_t>(at_hand[k])];
    of = Part::left_out;
    const bool answered = leave_out(rows, levels, z3, k + 1, more - 1);
    of = Part::in;
    if (!answered) return false;
  }
  return true;
}

bool SubsetsWorkspace::Room::judge(const Rows& rows, const Levels& levels, double z3) {
  if (!fit.solve(rows, [&](int j) { return uses(rows, j); })) return false;
  double sum = 0.0;
  double rounding = 0.0;  // on ||G^1/2 (x - c)||
  for (int j = 0; j < rows.size(); ++j) {
    if (!uses(rows, j)) continue;
    const double sigma = std::sqrt(rows.variance(j));
    const double residual = std::abs(rows.y(j) - rows.c(j).dot(fit.state()));
    const double reach = std::sqrt(fit.spread2(rows, j));
    const double room = levels.z1 * sigma + levels.z2 * reach;
    rounding += reach / rows.variance(j) * fit.rounding(rows, j);
    if (!(residual <= room + 1e-12 * (room + std::abs(rows.y(j))))) return true;
    sum += (residual / sigma) * (residual / sigma);
  }
  if (!std::isnan(z3) && !(sum <= z3 * z3 * (1.0 + 1e-12))) return true;
  x.col(consistent) = fit.state();
  const double far = levels.z2 + rounding;
  radius(consistent) = far / std::sqrt(fit.least());
  for (Eigen::Index k = 0; k < box.rows(); ++k) box(k, consistent) = far * std::sqrt(fit.variance(k));
  ++consistent;
  for (const int source : at_hand)
    if (part[static_cast<std::size_t>(source)] == Part::in) cleared[static_cast<std::size_t>(source)] = 1;
  return true;
}

/// The consistent set whose ball reaches furthest from a point, and how far.
std::pair<Eigen::Index, double> SubsetsWorkspace::Room::furthest(const Vector& from) const {
  std::pair<Eigen::Index, double> far{0, -1.0};
  for (Eigen::Index k = 0; k < consistent; ++k) {
    const double reach = (x.col(k) - from).norm() + radius(k);
    if (reach > far.second) far = {k, reach};
  }
  return far;
}

/// A small ball around all consistent sets: from the middle of their box, steps towards the furthest (Badoiu
/// and Clarkson) as long as they help.
void SubsetsWorkspace::Room::enclose() {
  Region& region = witness.region;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    double low = kInfinity;
    double high = -kInfinity;
    for (Eigen::Index k = 0; k < consistent; ++k) {
      low = std::min(low, x(i, k) - radius(k));
      high = std::max(high, x(i, k) + radius(k));
    }
    region.center(i) = 0.5 * (low + high);
  }
  auto far = furthest(region.center);
  for (int t = 1; t < 30; ++t) {
    c = region.center + (x.col(far.first) - region.center) / (t + 2);
    const auto next = furthest(c);
    if (next.second >= far.second) break;
    region.center = c;
    far = next;
  }
  region.radius = far.second;
  region.box.setZero();
  for (Eigen::Index k = 0; k < consistent; ++k)
    region.box = region.box.cwiseMax((x.col(k) - region.center).cwiseAbs() + box.col(k));
}

/// Reports the proved sources, those known before among them, and the rows of the others.
void SubsetsWorkspace::Room::close(const Rows& rows) {
  if (!witness.region.refuted())
    for (int source = 0; source < rows.sources(); ++source) {
      const Part of = part[static_cast<std::size_t>(source)];
      const bool shown = of == Part::in && consistent > 0 && cleared[static_cast<std::size_t>(source)] == 0 &&
                         witness.region.answered();
      if (of == Part::proved || shown) witness.proved.push_back(source);
    }
  for (int j = 0; j < rows.size(); ++j)
    witness.kept.push_back(
        static_cast<char>(!std::binary_search(witness.proved.begin(), witness.proved.end(), rows.source(j))));
}

SubsetsWorkspace::SubsetsWorkspace(int states, int sources, int capacity, int limit) {
  const Rows checks_the_sizes(states, sources, capacity);
  detail::require_least("limit", limit, 1);
  detail::require_room("limit", 2.0 * states * static_cast<double>(limit));
  room_ = std::make_unique<Room>(states, sources, capacity, limit);
}
SubsetsWorkspace::~SubsetsWorkspace() = default;
SubsetsWorkspace::SubsetsWorkspace(SubsetsWorkspace&&) noexcept = default;
SubsetsWorkspace& SubsetsWorkspace::operator=(SubsetsWorkspace&&) noexcept = default;

double subsets_to_try(const Rows& rows, const Assumption& a) noexcept {
  int at_hand = rows.present();
  for (const int source : a.proved) at_hand -= rows.has(source) ? 1 : 0;
  const int left = a.s - static_cast<int>(a.proved.size());
  return left < 0 || at_hand <= left ? 0.0 : choices(at_hand, left);
}

const Witness& witness_subsets(const Rows& rows, const Assumption& a, double z3,
                               SubsetsWorkspace& workspace) noexcept {
  SubsetsWorkspace::Room& room = *workspace.room_;
  room.begin(rows, a);
  const double sets = subsets_to_try(rows, a);
  if (room.left < 0) {
    room.witness.region.radius = kNaN;
  } else if (sets >= 1.0 && sets <= static_cast<double>(room.radius.size()) &&
             room.leave_out(rows, a.levels, z3, 0, room.left)) {
    if (room.consistent == 0)
      room.witness.region.radius = kNaN;
    else
      room.enclose();
  }
  room.close(rows);
  return room.witness;
}

Witness witness_subsets(const Rows& rows, const Assumption& a, double z3, int limit) {
  require(a, rows);
  detail::require_least("limit", limit, 1);
  if (!std::isnan(z3)) detail::require_least("z3", z3, 0.0);
  if (a.bounded) refuse("bounded", "true", "Gaussian levels", "use interval() or leverage_ball()");
  if (a.prior != nullptr) refuse("prior", "a region", "none", "only leverage_ball() uses one");
  const double sets = subsets_to_try(rows, a);
  if (!(sets <= limit))
    refuse("sets", text(sets), "at most limit = " + std::to_string(limit),
           "use leverage_ball(), or raise the limit");
  SubsetsWorkspace workspace(rows.states(), rows.sources(), rows.capacity(),
                             std::max(1, static_cast<int>(sets)));
  return witness_subsets(rows, a, z3, workspace);
}

}  // namespace garrison::certificate
