// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/leverage_window.hpp"

#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "../top.hpp"
#include "leverage_room.hpp"

namespace garrison::certificate {

WindowLevels window_levels(double delta, int rows, int states) {
  if (!(delta > 0.0 && delta < 1.0)) refuse("delta", text(delta), "a probability in (0, 1)");
  detail::require_least("rows", rows, 1);
  detail::require_least("states", states, 1);
  const double third = delta / 3.0;
  return {two_sided(third / (3.0 * rows)), chi(third, states), two_sided(third / states), kNaN};
}

void require(const WindowAssumption& a, const Window& window) {
  detail::require_least("s", a.s, 0);
  detail::require_least("z1", a.levels.z1, 0.0);
  detail::require_least("z2", a.levels.z2, 0.0);
  detail::require_least("zc", a.levels.zc, 0.0);
  if (!std::isnan(a.levels.z3)) detail::require_least("z3", a.levels.z3, 0.0);
  if (window.step() + 1 != window.steps())
    refuse("window", "step " + std::to_string(window.step()),
           "its last step, " + std::to_string(window.steps() - 1),
           "advance() to it, or begin() a shorter one");
  if (a.moving && !a.proved.empty())
    refuse("proved", "sources that are always attacked", "none with a moving set");
  std::vector<char> seen(static_cast<std::size_t>(window.sources()), 0);
  const auto mark = [&](const char* which, std::span<const int> sources) {
    for (const int source : sources) {
      if (source < 0 || source >= window.sources())
        refuse(which, std::to_string(source), "a source in 0.." + std::to_string(window.sources() - 1));
      if (seen[static_cast<std::size_t>(source)]++ != 0)
        refuse(which, std::to_string(source) + " twice", "every source once, proved or honest");
    }
  };
  mark("proved", a.proved);
  mark("honest", a.honest);
}

using Room = LeverageWindowWorkspace::Room;

Room::Room(const Window& w)
    : n(w.states()),
      fit(w.most_unknowns()),
      frame(w.states()),
      V(w.most_unknowns(), w.most_rows()),
      H(w.most_unknowns(), w.states()),
      EV(w.states(), w.most_rows()),
      FV(w.states(), w.most_rows()),
      row(1, w.most_rows()),
      residual(w.most_rows()),
      cross(w.most_rows()),
      gram(w.most_unknowns(), w.most_unknowns()),
      columns(w.most_unknowns(), 3),
      P(w.states(), w.states()),
      Sigma(w.states(), w.states()),
      small(w.states(), w.states()),
      direction(w.most_unknowns()),
      box(w.states()),
      kept(static_cast<std::size_t>(w.most_rows())),
      hit(static_cast<std::size_t>(w.most_rows())),
      is_honest(static_cast<std::size_t>(w.sources())),
      order(static_cast<std::size_t>(w.most_rows())),
      offset(static_cast<std::size_t>(w.sources()) * static_cast<std::size_t>(w.most_steps()) + 1),
      blocks(static_cast<std::size_t>(w.most_rows())),
      dropped(static_cast<std::size_t>(w.most_steps())),
      first(static_cast<std::size_t>(w.most_steps()) + 1),
      value(static_cast<std::size_t>(w.most_rows())),
      leverage(static_cast<std::size_t>(w.most_rows())),
      scratch(static_cast<std::size_t>(w.most_rows())) {
  witness.region.center.resize(n);
  witness.region.box.resize(n);
  witness.region.shape.resize(n, n);
  witness.proofs.reserve(static_cast<std::size_t>(w.sources()) * static_cast<std::size_t>(w.most_steps()));
}

void Room::begin(const Window& w, const WindowAssumption& a) {
  std::fill(dropped.begin(), dropped.end(), 0);
  std::fill(is_honest.begin(), is_honest.end(), 0);
  for (const int source : a.honest) is_honest[static_cast<std::size_t>(source)] = 1;
  witness.proofs.clear();
  for (const int source : a.proved) witness.proofs.push_back({source, kAlways});
  dropped[0] = static_cast<int>(a.proved.size());
  for (int r = 0; r < w.rows(); ++r)
    kept[static_cast<std::size_t>(r)] =
        static_cast<char>(std::find(a.proved.begin(), a.proved.end(), w.source(r)) == a.proved.end());
  witness.region.radius = witness.region.stretch = kInfinity;
  witness.mu = 0.0;
  witness.count = 1;
}

/// The rows that may be attacked, block by block: all rows of a source (fixed), or its rows of one step.
void Room::sort_blocks(const Window& w, const WindowAssumption& a) {
  const int groups = a.moving ? w.steps() : 1;
  const auto keys = static_cast<std::size_t>(groups) * static_cast<std::size_t>(w.sources());
  const auto key = [&](int r) {
    const int group = a.moving ? w.step_of(r) : 0;
    return static_cast<std::size_t>(group) * static_cast<std::size_t>(w.sources()) +
           static_cast<std::size_t>(w.source(r));
  };
  const auto counts = [&](int r) {
    return kept[static_cast<std::size_t>(r)] != 0 && w.source(r) >= 0 &&
           is_honest[static_cast<std::size_t>(w.source(r))] == 0;
  };
  std::fill_n(offset.begin(), keys + 1, 0);
  for (int r = 0; r < w.rows(); ++r)
    if (counts(r)) ++offset[key(r) + 1];
  count_blocks = 0;
  for (std::size_t k = 0; k < keys; ++k) {
    const int group = static_cast<int>(k / static_cast<std::size_t>(w.sources()));
    if (k % static_cast<std::size_t>(w.sources()) == 0) first[static_cast<std::size_t>(group)] = count_blocks;
    if (offset[k + 1] > 0) blocks[count_blocks++] = {group, offset[k], offset[k + 1]};
    offset[k + 1] += offset[k];
  }
  first[static_cast<std::size_t>(groups)] = count_blocks;
  count_groups = groups;
  for (int r = 0; r < w.rows(); ++r)
    if (counts(r)) order[static_cast<std::size_t>(offset[key(r)]++)] = r;
}

/// ||columns of M over the rows of a block||^2, M with few rows: by the smaller Gram matrix.
double Room::norm2(const Matrix& M, Eigen::Index height, const Block& b) {
  if (b.count == 1) return M.col(at(b, 0)).head(height).squaredNorm();
  if (height == 1) {
    double sum = 0.0;
    for (int q = 0; q < b.count; ++q) sum += M(0, at(b, q)) * M(0, at(b, q));
    return sum;
  }
  if (b.count <= height) {
    auto G = gram.topLeftCorner(b.count, b.count);
    for (int q = 0; q < b.count; ++q)
      for (int t = 0; t <= q; ++t)
        G(q, t) = G(t, q) = M.col(at(b, q)).head(height).dot(M.col(at(b, t)).head(height));
    return std::max(detail::extreme_eigenvalues(G, columns).second, 0.0);
  }
  auto G = gram.topLeftCorner(height, height);
  G.setZero();
  for (int q = 0; q < b.count; ++q) {
    const auto v = M.col(at(b, q)).head(height);
    for (Eigen::Index k = 0; k < height; ++k) G.col(k) += v(k) * v;
  }
  return std::max(detail::extreme_eigenvalues(G, columns).second, 0.0);
}

/// ||sum of res_r M_r over a block||, M with `height` rows.
double Room::pull(const Matrix& M, Eigen::Index height, const Block& b) {
  auto sum = direction.head(height);
  sum.setZero();
  for (int q = 0; q < b.count; ++q) sum += residual(at(b, q)) * M.col(at(b, q)).head(height);
  return sum.norm();
}

/// G, the frame, the residuals, leverages and lambda. False when there is no answer.
bool Room::fit_rows(const Window& w, const WindowAssumption& a) {
  const int p = w.unknowns();
  fit.clear(p);
  for (int r = 0; r < w.rows(); ++r)
    if (kept[static_cast<std::size_t>(r)] != 0) fit.add(w, r);
  if (!fit.solve()) return false;
  for (int r = 0; r < w.rows(); ++r) {
    V.col(r).head(p) = w.N(r);
    fit.to_frame(V.col(r).head(p));
    residual(r) = w.z(r) - w.N(r).dot(fit.theta());
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    H.col(i).head(p) = w.E().row(i).transpose();
    fit.to_frame(H.col(i).head(p));
  }
  for (int r = 0; r < w.rows(); ++r)
    for (Eigen::Index i = 0; i < n; ++i) EV(i, r) = H.col(i).head(p).dot(V.col(r).head(p));
  for (int b = 0; b < count_blocks; ++b) leverage[static_cast<std::size_t>(b)] = norm2(V, p, block(b));
  lambda = top([&](int b) { return leverage[static_cast<std::size_t>(b)]; }, a);
  if (lambda > 0.02) lambda = std::min(lambda, by_rows(w, a));
  lambda = std::min(lambda, 1.0);
  residual2 = top(
      [&](int b) {
        double sum = 0.0;
        for (int q = 0; q < block(b).count; ++q) sum += residual(at(block(b), q)) * residual(at(block(b), q));
        return sum;
      },
      a);
  all_pull = top([&](int b) { return pull(V, p, block(b)); }, a);
  return 1.0 - lambda > 1e-6;
}

/// The largest row sum of the block norms of the hat matrix over any set within the budgets: another bound on
/// lambda.
double Room::by_rows(const Window& w, const WindowAssumption& a) {
  const int p = w.unknowns();
  double most = 0.0;
  for (int i = 0; i < count_blocks; ++i) {
    const Block& own = block(i);
    if (left(own.group, a) < 1) continue;
    double sum = leverage[static_cast<std::size_t>(i)];
    for (int g = 0; g < count_groups; ++g) {
      const int take = left(g, a) - (g == own.group ? 1 : 0);
      if (take <= 0) continue;
      const int from = first[static_cast<std::size_t>(g)];
      const int to = first[static_cast<std::size_t>(g) + 1];
      for (int j = from; j < to; ++j) {
        double squares = 0.0;
        if (j != i)
          for (int q = 0; q < own.count; ++q)
            for (int t = 0; t < block(j).count; ++t) {
              const double entry = V.col(at(own, q)).head(p).dot(V.col(at(block(j), t)).head(p));
              squares += entry * entry;
            }
        scratch[static_cast<std::size_t>(j - from)] = std::sqrt(squares);
      }
      sum += detail::top({scratch.data(), static_cast<std::size_t>(to - from)}, take);
    }
    most = std::max(most, sum);
  }
  return most;
}

/// Per biased row r: TOP over the blocks b of ||Lam_br||^2.
void Room::reach_of_bias(const Window& w, const WindowAssumption& a) {
  const int p = w.unknowns();
  bias2 = 0.0;
  for (int r = 0; r < w.rows(); ++r) {
    cross(r) = 0.0;
    if (kept[static_cast<std::size_t>(r)] == 0 || w.bias(r) == 0.0) continue;
    bias2 += w.bias(r) * w.bias(r);
    cross(r) = std::sqrt(top(
        [&](int b) {
          double sum = 0.0;
          for (int q = 0; q < block(b).count; ++q) {
            const double entry = V.col(at(block(b), q)).head(p).dot(V.col(r).head(p));
            sum += entry * entry;
          }
          return sum;
        },
        a));
  }
}

/// Bound on ||F G^1/2 (theta - LS)||. M = F V: height x rows; F2 = ||F||^2; zq: quantile of the noise in F.
/// shaped: F makes noise and set prior together at most 1 long.
double Room::reach(const Window& w, const WindowAssumption& a, const Matrix& M, Eigen::Index height,
                   double F2, double zq, bool shaped) {
  const double mu = 1.0 - lambda;
  const double phi = std::min(lambda * F2, top([&](int b) { return norm2(M, height, block(b)); }, a));
  const double root = std::sqrt(phi);
  const double attack =
      std::min(std::sqrt(F2) * all_pull / mu, top([&](int b) { return pull(M, height, block(b)); }, a) +
                                                  root * lambda / mu * std::sqrt(residual2));
  const double spread = std::sqrt(F2 + phi / mu);
  const double half = lambda < 0.5 ? std::sqrt(lambda * (1.0 - lambda)) : 0.5;
  const double across = root / mu * half;
  double bias = 0.0;
  if (bias2 > 0.0) {
    for (int r = 0; r < w.rows(); ++r)
      if (kept[static_cast<std::size_t>(r)] != 0 && w.bias(r) > 0.0)
        bias += (M.col(r).head(height).norm() + root / mu * cross(r)) * w.bias(r);
    bias = std::min(std::sqrt(bias2) * spread, bias);
  }
  const auto of = [&](RowNoise kind) {
    auto G = gram.topLeftCorner(height, height);
    G.setZero();
    for (int r = 0; r < w.rows(); ++r) {
      if (kept[static_cast<std::size_t>(r)] == 0 || w.noise(r) != kind) continue;
      const auto v = M.col(r).head(height);
      for (Eigen::Index k = 0; k < height; ++k) G.col(k) += v(k) * v;
    }
    return std::sqrt(std::max(detail::extreme_eigenvalues(G, columns).second, 0.0));
  };
  const double length = w.prior_length();
  double noise = zq > 0.0 ? zq * std::min(spread, of(RowNoise::gaussian) + across) : 0.0;
  if (length > 0.0) noise += length * std::min(spread, of(RowNoise::set) + across);
  if (shaped) noise = std::min(noise, 1.0 + across * (zq + length));
  return attack + std::min(noise + bias, (zq + std::sqrt(length * length + bias2)) * spread) +
         fit.rounding() * std::sqrt(F2);
}

/// Ellipsoid, box and ball of this pass; the better one stays. False when the state has no spread at all.
bool Room::enclose(const Window& w, const WindowAssumption& a) {
  P.setZero();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      P(i, k) = H.col(i).head(w.unknowns()).dot(H.col(k).head(w.unknowns()));
  double largest = frame.eigenvalues(P).second;
  if (!(largest > 0.0 && largest <= kHuge * kHuge)) return false;
  const auto in_frame = [&](const Matrix& shape, bool shaped) {
    frame.set(shape);
    FV.leftCols(w.rows()) = frame.W().lazyProduct(EV.leftCols(w.rows()));
    const double F = frame.stretch(P);
    return reach(w, a, FV, n, F * F, a.levels.z2, shaped);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    row.leftCols(w.rows()) = EV.row(i).head(w.rows());
    box(i) = reach(w, a, row, 1, P(i, i), a.levels.zc, false);
  }
  double stretch = in_frame(P, false);
  if (w.prior_length() > 0.0) {
    // Noise and prior apart: otherwise a step-by-step prior would grow by `stretch` in every step.
    const auto part = [&](RowNoise kind, double scale, Matrix& into) {
      into.setZero();
      for (int r = 0; r < w.rows(); ++r)
        if (kept[static_cast<std::size_t>(r)] != 0 && w.noise(r) == kind)
          for (Eigen::Index k = 0; k < n; ++k) into.col(k) += (scale * scale * EV(k, r)) * EV.col(r);
    };
    part(RowNoise::set, w.prior_length(), small);
    part(RowNoise::gaussian, a.levels.z2, Sigma);
    detail::outer_sum(small, Sigma, Sigma);
    const auto [least, most] = frame.eigenvalues(Sigma);
    if (least > 1e-13 * most) {
      const double other = in_frame(Sigma, true);
      if (other * std::sqrt(most) < 3.0 * stretch * std::sqrt(largest)) {
        P = Sigma;
        stretch = other;
        largest = most;
      }
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) box(i) = std::min(box(i), stretch * std::sqrt(std::max(P(i, i), 0.0)));
  const double radius = std::min(stretch * std::sqrt(largest), box.norm());
  Region& best = witness.region;
  if (!(radius < best.radius)) return true;
  for (Eigen::Index i = 0; i < n; ++i) {
    direction.head(w.unknowns()) = w.E().row(i).transpose();
    best.center(i) = direction.head(w.unknowns()).dot(fit.theta()) + w.o()(i);
  }
  if (!best.center.allFinite() || !std::isfinite(radius)) return false;
  best.radius = radius;
  best.stretch = stretch;
  best.shape = P;
  best.box = box;
  witness.mu = 1.0 - lambda;
  std::copy(kept.begin(), kept.end(), best_kept.begin());
  return true;
}

/// Rows outside what an honest one can be prove an attack. Everything is judged before anything is dropped.
Room::Verdict Room::gate(const Window& w, const WindowAssumption& a) {
  const int p = w.unknowns();
  bool found = false;
  for (int r = 0; r < w.rows(); ++r) {
    auto& mark = hit[static_cast<std::size_t>(r)];
    mark = 0;
    if (kept[static_cast<std::size_t>(r)] == 0 || w.source(r) < 0) continue;
    const double size = std::abs(residual(r));
    if (!(size > a.levels.z1 + w.bias(r))) continue;  // less than any room
    for (int q = 0; q < w.rows(); ++q) row(0, q) = V.col(r).head(p).dot(V.col(q).head(p));
    const double room =
        a.levels.z1 + w.bias(r) + reach(w, a, row, 1, V.col(r).head(p).squaredNorm(), a.levels.z1, false);
    if (!(size > room + 1e-12 * (room + std::abs(w.z(r))))) continue;
    if (is_honest[static_cast<std::size_t>(w.source(r))] != 0) return Verdict::contradiction;
    mark = 1;
    found = true;
  }
  if (!found) return Verdict::nothing;
  for (int r = 0; r < w.rows(); ++r) {
    if (hit[static_cast<std::size_t>(r)] == 0 || kept[static_cast<std::size_t>(r)] == 0) continue;
    const int step = a.moving ? w.step_of(r) : kAlways;
    witness.proofs.push_back({w.source(r), step});
    ++dropped[static_cast<std::size_t>(a.moving ? step : 0)];
    for (int q = 0; q < w.rows(); ++q)
      if (w.source(q) == w.source(r) && (!a.moving || w.step_of(q) == step))
        kept[static_cast<std::size_t>(q)] = 0;
  }
  return Verdict::dropped;
}

const WindowWitness& Room::answer(const Window& w, const WindowAssumption& a) {
  constexpr int kPasses = 20;  // every one is valid: more would only be sharper
  begin(w, a);
  const auto refuted = [&] { witness.region.radius = witness.region.stretch = witness.mu = kNaN; };
  for (int pass = 0; pass < kPasses; ++pass) {
    if (*std::max_element(dropped.begin(), dropped.end()) > a.s) {
      refuted();
      break;
    }
    sort_blocks(w, a);
    if (!fit_rows(w, a)) break;
    reach_of_bias(w, a);
    if (!enclose(w, a)) break;
    const Verdict verdict = gate(w, a);
    if (verdict == Verdict::contradiction) refuted();
    if (verdict != Verdict::dropped) break;
  }
  return witness;
}

LeverageWindowWorkspace::LeverageWindowWorkspace(const Window& window)
    : room_(std::make_unique<Room>(window)) {}
LeverageWindowWorkspace::~LeverageWindowWorkspace() = default;
LeverageWindowWorkspace::LeverageWindowWorkspace(LeverageWindowWorkspace&&) noexcept = default;
LeverageWindowWorkspace& LeverageWindowWorkspace::operator=(LeverageWindowWorkspace&&) noexcept = default;

const WindowWitness& leverage_window(const Window& window, const WindowAssumption& a,
                                     LeverageWindowWorkspace& room) noexcept {
  return room.room_->answer(window, a);
}

WindowWitness leverage_window(const Window& window, const WindowAssumption& a) {
  require(a, window);
  LeverageWindowWorkspace room(window);
  return leverage_window(window, a, room);
}

}  // namespace garrison::certificate
