// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/leverage_ball.hpp"

#include <algorithm>
#include <cmath>

#include "least_squares.hpp"
#include "require.hpp"
#include "top.hpp"

namespace garrison::certificate {

namespace {

/// What the kept rows decide without their measurements. Of all rows at hand it is the same in every sample
/// that brings the same rows.
struct Frame {
  Frame(int states, int sources, int capacity)
      : fit(states),
        reach(capacity),
        influence(capacity),
        sigma(capacity),
        leverage(static_cast<std::size_t>(sources)) {}

  detail::LeastSquares fit;
  Vector reach;                  // sqrt(C_j G^-1 C_j')
  Vector influence;              // on ||G^1/2 (x - c)|| of the measurement, |residual| aside
  Vector sigma;                  // of each row, kept or not
  std::vector<double> leverage;  // sum over the kept rows of each source
  bool determined = false;
  int left = -1;  // of `mu`
  double mu = 0.0;

  template <class Keeps>
  void make(const Rows& rows, const Keeps& keeps) {
    left = -1;
    for (int j = 0; j < rows.size(); ++j) sigma(j) = std::sqrt(rows.variance(j));
    determined = fit.factor(rows, keeps);
    if (!determined) return;
    std::fill(leverage.begin(), leverage.end(), 0.0);
    for (int j = 0; j < rows.size(); ++j) {
      if (!keeps(j)) continue;
      const double spread2 = fit.spread2(rows, j);
      reach(j) = std::sqrt(spread2);
      influence(j) = reach(j) / rows.variance(j);
      leverage[static_cast<std::size_t>(rows.source(j))] += spread2 / rows.variance(j);
    }
  }
};

}  // namespace

/// What a pass needs; one number per row or per source.
struct LeverageWorkspace::Room {
  Room(int states, int sources, int capacity)
      : known(states, sources, capacity),
        whole(states, sources, capacity),
        part(states, sources, capacity),
        own_at(capacity),
        out(static_cast<std::size_t>(sources)),
        part_out(out.size()),
        hit(out.size()),
        influence(static_cast<std::size_t>(sources)),
        noise(static_cast<std::size_t>(sources)),
        sorted(static_cast<std::size_t>(sources)) {
    witness.region.center.resize(states);
    witness.region.box.resize(states);
    witness.kept.reserve(static_cast<std::size_t>(capacity));
    witness.proved.reserve(static_cast<std::size_t>(sources));
  }

  Rows known;  // those of `whole`
  Frame whole, part;
  Frame* frame = nullptr;      // of the present pass
  Vector own_at;               // C_j times the centre of the own ball
  double own_radius = 0.0;     // bG of the own ball
  double rounding = 0.0;       // on ||G^1/2 (x - c)|| of rounding
  std::vector<char> out;       // sources that are proved
  std::vector<char> part_out;  // those that `part` leaves out; none = it was not made
  std::vector<char> hit;       // sources that a pass refutes
  int count_out = 0;
  bool own = false;                      // an own ball exists
  std::vector<double> influence, noise;  // sums over the kept rows of a source
  std::vector<double> sorted;
  Witness witness;

  bool keeps(const Rows& rows, int j) const { return out[static_cast<std::size_t>(rows.source(j))] == 0; }
  void begin(const Rows& rows, const Assumption& a);
  bool refute(const Rows& rows, const Assumption& a);
  void choose_frame(const Rows& rows);
  double spare(int left);
  bool fit_rows(const Rows& rows, const Assumption& a);
  double in_frame(const Rows& rows, const Assumption& a, int left, double mu);
  double top(const std::vector<double>& of, int k);
  void close(const Rows& rows);
};

void LeverageWorkspace::Room::begin(const Rows& rows, const Assumption& a) {
  if (known.follow(rows)) {
    whole.make(rows, [](int) { return true; });
    std::fill(part_out.begin(), part_out.end(), 0);
  }
  frame = &whole;
  std::fill(out.begin(), out.end(), 0);
  for (const int source : a.proved) out[static_cast<std::size_t>(source)] = 1;
  count_out = static_cast<int>(a.proved.size());
  own = false;
  witness.region.radius = kInfinity;
  witness.kept.clear();
  witness.proved.clear();
}

double LeverageWorkspace::Room::top(const std::vector<double>& of, int k) {
  if (k > 0 && k <= detail::kFew && k <= static_cast<int>(of.size()))
    return detail::top_few(of, static_cast<std::size_t>(k));
  std::copy(of.begin(), of.end(), sorted.begin());
  return detail::top(sorted, k);
}

/// Step 1: a residual outside a valid ball proves an attack. Whether a source was refuted.
bool LeverageWorkspace::Room::refute(const Rows& rows, const Assumption& a) {
  const bool prior = a.prior != nullptr && a.prior->answered();
  if (!own && !prior) return false;
  const int before = count_out;
  const auto outside = [&](int j, double Cc, double room) {
    const double width = a.bounded ? rows.width(j) : a.levels.z1 * frame->sigma(j);
    return std::abs(rows.y(j) - Cc) > width + room + 1e-12 * (width + std::abs(rows.y(j)) + std::abs(Cc));
  };
  // All rows are judged before any source leaves: `keeps` must not change within a pass.
  std::fill(hit.begin(), hit.end(), 0);
  for (int j = 0; j < rows.size(); ++j) {
    if (!keeps(rows, j)) continue;
    bool bad = own && outside(j, own_at(j), own_radius * frame->reach(j));
    if (prior) bad = bad || outside(j, rows.c(j).dot(a.prior->center), rows.c(j).norm() * a.prior->radius);
    if (bad) hit[static_cast<std::size_t>(rows.source(j))] = 1;
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (hit[k] == 0) continue;
    out[k] = 1;
    ++count_out;
  }
  return count_out > before;
}

/// Step 2, which no measurement enters.
void LeverageWorkspace::Room::choose_frame(const Rows& rows) {
  if (count_out == 0) return;
  frame = &part;
  if (part_out != out) part.make(rows, [&](int j) { return keeps(rows, j); });
  part_out = out;
}

/// Step 3, the sums per source: false when a number is lost to overflow.
bool LeverageWorkspace::Room::fit_rows(const Rows& rows, const Assumption& a) {
  const auto kept = [&](int j) { return keeps(rows, j); };
  if (!frame->fit.locate(rows, kept, a.bounded)) return false;
  std::fill(influence.begin(), influence.end(), 0.0);
  if (a.bounded) std::fill(noise.begin(), noise.end(), 0.0);
  rounding = 0.0;
  const Eigen::Index n = frame->fit.state().size();
  const double* const x = frame->fit.state().data();
  for (int j = 0; j < rows.size(); ++j) {
    if (!kept(j)) continue;
    const auto source = static_cast<std::size_t>(rows.source(j));
    const double* const c = rows.c(j).data();
    double at = 0.0;
    for (Eigen::Index k = 0; k < n; ++k) at += c[k] * x[k];
    own_at(j) = at;
    influence[source] += frame->influence(j) * std::abs(rows.y(j) - at);
    if (a.bounded) noise[source] += frame->influence(j) * rows.width(j);
    rounding += frame->influence(j) * frame->fit.rounding(rows, j);
  }
  return true;
}

/// mu: what `left` liars leave of the leverage; 0 when the kept rows do not determine the state.
double LeverageWorkspace::Room::spare(int left) {
  if (!frame->determined) return 0.0;
  if (frame->left == left) return frame->mu;
  frame->left = left;
  frame->mu = 1.0 - top(frame->leverage, left);
  return frame->mu;
}

/// bG of step 3: bound on ||G^1/2 (x - c)||.
double LeverageWorkspace::Room::in_frame(const Rows& rows, const Assumption& a, int left, double mu) {
  const double attack = top(influence, left);
  if (!a.bounded) return (attack + rounding) / mu + a.levels.z2 / std::sqrt(mu);
  int kept = 0;
  for (int source = 0; source < rows.sources(); ++source)
    kept += static_cast<int>(rows.has(source) && out[static_cast<std::size_t>(source)] == 0);
  // The expression does not fall with the number of attacked among the kept: its maximum is at `left`.
  return (attack + top(noise, kept - left) + rounding) / mu;
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
  room.begin(rows, a);
  for (int pass = 0; pass < rows.size() + 2; ++pass) {
    const bool refuted = room.refute(rows, a);
    const int left = a.s - room.count_out;
    if (left < 0) {
      best.radius = kNaN;
      break;
    }
    if (room.own && !refuted) break;
    room.choose_frame(rows);
    // Whether there is an answer does not depend on the measurements: no sums over them when there is none.
    const double mu = room.spare(left);
    if (!(mu > kLeast) || !room.fit_rows(rows, a)) break;
    const double bG = room.in_frame(rows, a, left, mu);
    const detail::LeastSquares& fit = room.frame->fit;
    const double b = bG / std::sqrt(fit.least());
    if (!std::isfinite(b)) break;
    room.own = true;
    room.own_radius = bG;
    if (!(b < best.radius)) continue;
    best.radius = b;
    best.center = fit.state();
    for (Eigen::Index k = 0; k < best.box.size(); ++k) best.box(k) = bG * std::sqrt(fit.variance(k));
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
