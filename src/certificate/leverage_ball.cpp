// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/leverage_ball.hpp"

#include <algorithm>
#include <cmath>

#include "least_squares.hpp"
#include "require.hpp"
#include "top.hpp"

namespace garrison::certificate {

/// What a pass needs; one number per row or per source.
struct LeverageWorkspace::Room {
  Room(int states, int sources, int capacity)
      : fit(states),
        reach(capacity),
        out(static_cast<std::size_t>(sources)),
        hit(out.size()),
        leverage(static_cast<std::size_t>(sources)),
        influence(static_cast<std::size_t>(sources)),
        noise(static_cast<std::size_t>(sources)),
        sorted(static_cast<std::size_t>(sources)) {
    witness.region.center.resize(states);
    witness.region.box.resize(states);
    witness.kept.reserve(static_cast<std::size_t>(capacity));
    witness.proved.reserve(static_cast<std::size_t>(sources));
  }

  detail::LeastSquares fit;
  Vector reach;           // of the own ball: bound on |C_j (x - c)|
  std::vector<char> out;  // sources that are proved
  std::vector<char> hit;  // sources that a pass refutes
  int count_out = 0;
  bool own = false;                                // an own ball exists
  std::vector<double> leverage, influence, noise;  // sums over the kept rows of a source
  std::vector<double> sorted;
  Witness witness;

  bool keeps(const Rows& rows, int j) const { return out[static_cast<std::size_t>(rows.source(j))] == 0; }
  void begin(const Assumption& a);
  bool refute(const Rows& rows, const Assumption& a);
  bool fit_rows(const Rows& rows, const Assumption& a);
  double in_frame(const Rows& rows, const Assumption& a, int left, double mu);
  double top(const std::vector<double>& of, int k);
  void close(const Rows& rows);
};

void LeverageWorkspace::Room::begin(const Assumption& a) {
  std::fill(out.begin(), out.end(), 0);
  for (const int source : a.proved) out[static_cast<std::size_t>(source)] = 1;
  count_out = static_cast<int>(a.proved.size());
  own = false;
  witness.region.radius = kInfinity;
  witness.kept.clear();
  witness.proved.clear();
}

double LeverageWorkspace::Room::top(const std::vector<double>& of, int k) {
  std::copy(of.begin(), of.end(), sorted.begin());
  return detail::top(sorted, k);
}

/// Step 1: a residual outside a valid ball proves an attack. Whether a source was refuted.
bool LeverageWorkspace::Room::refute(const Rows& rows, const Assumption& a) {
  const int before = count_out;
  const auto outside = [&](int j, double Cc, double room) {
    const double width = a.bounded ? rows.width(j) : a.levels.z1 * std::sqrt(rows.variance(j));
    return std::abs(rows.y(j) - Cc) > width + room + 1e-12 * (width + std::abs(rows.y(j)) + std::abs(Cc));
  };
  // All rows are judged before any source leaves: `keeps` must not change within a pass.
  std::fill(hit.begin(), hit.end(), 0);
  for (int j = 0; j < rows.size(); ++j) {
    if (!keeps(rows, j)) continue;
    bool bad = own && outside(j, rows.c(j).dot(fit.state()), reach(j));
    if (a.prior != nullptr && a.prior->answered())
      bad = bad || outside(j, rows.c(j).dot(a.prior->center), rows.c(j).norm() * a.prior->radius);
    if (bad) hit[static_cast<std::size_t>(rows.source(j))] = 1;
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (hit[k] == 0) continue;
    out[k] = 1;
    ++count_out;
  }
  return count_out > before;
}

/// Steps 2 and 3, the sums per source: false when the kept rows do not determine the state.
bool LeverageWorkspace::Room::fit_rows(const Rows& rows, const Assumption& a) {
  own = false;
  if (!fit.solve(rows, [&](int j) { return keeps(rows, j); })) return false;
  std::fill(leverage.begin(), leverage.end(), 0.0);
  std::fill(influence.begin(), influence.end(), 0.0);
  std::fill(noise.begin(), noise.end(), 0.0);
  for (int j = 0; j < rows.size(); ++j) {
    if (!keeps(rows, j)) continue;
    const auto source = static_cast<std::size_t>(rows.source(j));
    const double spread2 = fit.spread2(rows, j);
    const double infl = std::sqrt(spread2) / rows.variance(j);
    reach(j) = std::sqrt(spread2);
    const double residual = std::abs(rows.y(j) - rows.c(j).dot(fit.state()));
    leverage[source] += spread2 / rows.variance(j);
    influence[source] += infl * residual;
    if (a.bounded) noise[source] += infl * rows.width(j);
  }
  return true;
}

/// bG of step 3: bound on ||G^1/2 (x - c)||.
double LeverageWorkspace::Room::in_frame(const Rows& rows, const Assumption& a, int left, double mu) {
  const double attack = top(influence, left);
  if (!a.bounded) return attack / mu + a.levels.z2 / std::sqrt(mu);
  int kept = 0;
  for (int source = 0; source < rows.sources(); ++source)
    kept += static_cast<int>(rows.has(source) && out[static_cast<std::size_t>(source)] == 0);
  // The expression does not fall with the number of attacked among the kept: its maximum is at `left`.
  return (attack + top(noise, kept - left)) / mu;
}

/// Reports which rows were kept and which sources are proved.
void LeverageWorkspace::Room::close(const Rows& rows) {
  for (int j = 0; j < rows.size(); ++j) witness.kept.push_back(static_cast<char>(keeps(rows, j)));
  if (witness.region.refuted()) return;
  for (std::size_t k = 0; k < out.size(); ++k)
    if (out[k] != 0) witness.proved.push_back(static_cast<int>(k));
}

LeverageWorkspace::LeverageWorkspace(int states, int sources, int capacity) {
  const Rows checks_the_sizes(states, sources, capacity);
  room_ = std::make_unique<Room>(states, sources, capacity);
}
LeverageWorkspace::~LeverageWorkspace() = default;
LeverageWorkspace::LeverageWorkspace(LeverageWorkspace&&) noexcept = default;
LeverageWorkspace& LeverageWorkspace::operator=(LeverageWorkspace&&) noexcept = default;

const Witness& leverage_ball(const Rows& rows, const Assumption& a, LeverageWorkspace& workspace) noexcept {
  constexpr double kLeast = 1e-6;  // of mu: below it, the attackers hold all the leverage
  LeverageWorkspace::Room& room = *workspace.room_;
  Region& best = room.witness.region;
  room.begin(a);
  for (int pass = 0; pass < rows.size() + 2; ++pass) {
    const bool refuted = room.refute(rows, a);
    const int left = a.s - room.count_out;
    if (left < 0) {
      best.radius = kNaN;
      break;
    }
    if (room.own && !refuted) break;
    if (!room.fit_rows(rows, a)) break;
    const double mu = 1.0 - room.top(room.leverage, left);
    if (!(mu > kLeast)) break;
    const double bG = room.in_frame(rows, a, left, mu);
    const double b = bG / std::sqrt(room.fit.least());
    if (!std::isfinite(b)) break;
    room.own = true;
    room.reach *= bG;
    if (!(b < best.radius)) continue;
    best.radius = b;
    best.center = room.fit.state();
    for (Eigen::Index k = 0; k < best.box.size(); ++k) best.box(k) = bG * std::sqrt(room.fit.variance(k));
  }
  room.close(rows);
  return room.witness;
}

void require(const Assumption& a, const Rows& rows) {
  detail::require_least("s", a.s, 0);
  if (!a.bounded) {
    detail::require_least("z1", a.levels.z1, 0.0);
    detail::require_least("z2", a.levels.z2, 0.0);
  }
  if (a.prior != nullptr && a.prior->answered()) {
    detail::require_least("prior radius", a.prior->radius, 0.0);
    detail::require_shape("prior center", a.prior->center, rows.states(), 1);
  }
  std::vector<char> seen(static_cast<std::size_t>(rows.sources()), 0);
  for (const int source : a.proved) {
    if (source < 0 || source >= rows.sources())
      refuse("proved", std::to_string(source), "a source in 0.." + std::to_string(rows.sources() - 1));
    if (seen[static_cast<std::size_t>(source)]++ != 0)
      refuse("proved", std::to_string(source) + " twice", "every source once");
  }
}

Witness leverage_ball(const Rows& rows, const Assumption& a) {
  require(a, rows);
  LeverageWorkspace workspace(rows.states(), rows.sources(), rows.capacity());
  return leverage_ball(rows, a, workspace);
}

}  // namespace garrison::certificate
