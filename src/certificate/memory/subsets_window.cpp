// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/subsets_window.hpp"

#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "choices.hpp"
#include "ellipsoid_union.hpp"
#include "garrison/certificate/memory/leverage_window.hpp"
#include "window_sources.hpp"

namespace garrison::certificate {

using detail::Part;

struct SubsetsWindowWorkspace::Room {
  Room(const Window& w, int limit)
      : sources(w),
        V(w.most_unknowns(), w.most_rows()),
        f(w.states(), w.most_rows()),
        residual(w.most_rows()),
        H(w.most_unknowns(), w.states()),
        P(w.states(), w.states()),
        prior(w.states(), w.states()),
        shape(w.states(), w.states()),
        column(w.states()),
        box(w.states()),
        c(w.states()),
        all(w.states(), limit) {
    witness.region.center.resize(w.states());
    witness.region.box.resize(w.states());
    witness.region.shape.resize(w.states(), w.states());
    witness.proofs.reserve(static_cast<std::size_t>(w.sources()));
    cleared.resize(static_cast<std::size_t>(w.sources()));
  }

  detail::WindowSources sources;
  Matrix V, f;  // of the rows of the set that is tried: G^-1/2 N_r', E G^-1 N_r'
  Vector residual;
  Matrix H, P, prior, shape;
  Vector column, box, c;
  std::vector<char> cleared;  // per source: in a kept set
  detail::EllipsoidUnion all;
  WindowWitness witness;

  bool judge(const Window& w, const WindowLevels& z);
  bool explained(const Window& w, const WindowLevels& z);
  void collect(const Window& w, const WindowLevels& z);
  const WindowWitness& answer(const Window& w, const WindowAssumption& a);
};

/// Whether the set that is marked determines theta; if it also explains its rows, it is collected.
bool SubsetsWindowWorkspace::Room::judge(const Window& w, const WindowLevels& z) {
  if (!sources.solve(w)) return false;
  if (!explained(w, z)) return true;
  collect(w, z);
  for (const int source : sources.at_hand)
    if (sources.part[static_cast<std::size_t>(source)] == Part::in)
      cleared[static_cast<std::size_t>(source)] = 1;
  return true;
}

bool SubsetsWindowWorkspace::Room::explained(const Window& w, const WindowLevels& z) {
  const int p = w.unknowns();
  double bias2 = w.prior_length() * w.prior_length();
  bool apart = w.prior_length() == 0.0;  // every bounded error has a bound of its own
  double sum = 0.0;
  for (int r = 0; r < w.rows(); ++r) {
    if (!sources.uses(w, r)) continue;
    V.col(r).head(p) = w.N(r);
    sources.fit.to_frame(V.col(r).head(p));
    residual(r) = w.z(r) - w.N(r).dot(sources.fit.theta());
    bias2 += w.bias(r) * w.bias(r);
    sum += residual(r) * residual(r);
  }
  const double length = std::sqrt(bias2);
  apart = apart && length > 0.0;
  for (int r = 0; r < w.rows(); ++r) {
    if (!sources.uses(w, r)) continue;
    const double free = sources.fit.free(V.col(r).head(p));
    const double slack = 1e-12 * (1.0 + std::abs(w.z(r))) + 1e-9 + sources.fit.rounding();
    const double size = std::abs(residual(r));
    if (!(size > z.z1 * free + slack)) continue;  // within any room
    double push = length * free;
    if (apart) {
      double each = 0.0;
      for (int q = 0; q < w.rows(); ++q) {
        if (!sources.uses(w, q) || w.bias(q) == 0.0) continue;
        each += std::abs((q == r ? 1.0 : 0.0) - V.col(r).head(p).dot(V.col(q).head(p))) * w.bias(q);
      }
      push = std::min(push, each);
    }
    if (!(size <= z.z1 * free + push + slack)) return false;
  }
  return std::isnan(z.z3) || std::sqrt(sum) <= (z.z3 + length) * (1.0 + 1e-12);
}

/// Ellipsoid and box of the set that is tried.
void SubsetsWindowWorkspace::Room::collect(const Window& w, const WindowLevels& z) {
  const Eigen::Index n = w.states();
  const int p = w.unknowns();
  for (Eigen::Index i = 0; i < n; ++i) {
    H.col(i).head(p) = w.E().row(i).transpose();
    sources.fit.to_frame(H.col(i).head(p));
    double sum = w.o()(i);
    for (Eigen::Index k = 0; k < p; ++k) sum += w.E()(i, k) * sources.fit.theta()(k);
    c(i) = sum;
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) P(i, k) = H.col(i).head(p).dot(H.col(k).head(p));
  double length2 = w.prior_length() * w.prior_length();
  box.setZero();    // the bounded parts
  prior.setZero();  // of the set prior
  shape.setZero();  // of the Gaussian rows
  for (int r = 0; r < w.rows(); ++r) {
    if (!sources.uses(w, r)) continue;
    for (Eigen::Index i = 0; i < n; ++i) f(i, r) = H.col(i).head(p).dot(V.col(r).head(p));
    box += w.bias(r) * f.col(r).cwiseAbs();
    length2 += w.bias(r) * w.bias(r);
    if (w.noise(r) == RowNoise::bounded) continue;
    Matrix& of = w.noise(r) == RowNoise::set ? prior : shape;
    for (Eigen::Index k = 0; k < n; ++k) of.col(k) += f(k, r) * f.col(r);
  }
  const double length = std::sqrt(length2);
  for (Eigen::Index i = 0; i < n; ++i) {
    box(i) += z.zc * std::sqrt(std::max(shape(i, i), 0.0)) +
              w.prior_length() * std::sqrt(std::max(prior(i, i), 0.0));
    const double reach = std::sqrt(std::max(P(i, i), 0.0));
    box(i) = std::min(box(i), (z.zc + length) * reach) + sources.fit.rounding() * reach;
  }
  detail::ShapeFrame& frame = all.frame();
  bool apart = w.prior_length() > 0.0;
  if (apart) {
    prior *= w.prior_length() * w.prior_length();
    shape *= z.z2 * z.z2;
    detail::outer_sum(prior, shape, shape);
    const auto [least, largest] = frame.eigenvalues(shape);
    apart = least > 1e-13 * largest;  // bounded rows may reach where these two do not
  }
  if (!apart) shape = P;
  frame.set(shape);
  double bias = 0.0;
  for (int r = 0; r < w.rows(); ++r)
    if (sources.uses(w, r) && w.bias(r) > 0.0) bias += frame.length(f.col(r)) * w.bias(r);
  const double radius =
      apart ? 1.0 + bias : z.z2 + (w.prior_length() > 0.0 ? length : std::min(length, bias));
  all.add(c, shape, radius + sources.fit.rounding() * (apart ? frame.stretch(P) : 1.0), box);
}

const WindowWitness& SubsetsWindowWorkspace::Room::answer(const Window& w, const WindowAssumption& a) {
  Region& region = witness.region;
  region.radius = region.stretch = kInfinity;
  witness.proofs.clear();
  for (const int source : a.proved) witness.proofs.push_back({source, kAlways});
  witness.count = 0;
  all.clear();
  const int left = a.s - static_cast<int>(a.proved.size());
  if (left < 0) {
    region.radius = region.stretch = kNaN;
    return witness;
  }
  sources.begin(w, a.proved);
  std::fill(cleared.begin(), cleared.end(), 0);
  const double sets = subsets_to_try(w, a);
  const int take = std::min(left, static_cast<int>(sources.at_hand.size()));
  if (!(sets <= all.capacity()) ||
      !detail::each_choice(std::span<const int>(sources.at_hand), take, std::span(sources.part),
                           Part::left_out, [&] { return judge(w, a.levels); }))
    return witness;
  witness.count = all.size();
  if (all.size() == 0) {
    region.radius = region.stretch = kNaN;
    return witness;
  }
  all.hull(region);
  all.shape(region, shape);
  all.enclose(shape, region);
  if (!std::isfinite(region.radius) || !region.center.allFinite()) {
    region.radius = region.stretch = kInfinity;
    return witness;
  }
  if (static_cast<int>(sources.at_hand.size()) < 2 * take) return witness;
  for (const int source : sources.at_hand)
    if (cleared[static_cast<std::size_t>(source)] == 0) witness.proofs.push_back({source, kAlways});
  return witness;
}

SubsetsWindowWorkspace::SubsetsWindowWorkspace(const Window& window, int limit) {
  detail::require_least("limit", limit, 1);
  detail::require_room("limit", static_cast<double>(window.states()) * (window.states() + 2.0) * limit);
  detail::require_room("sources", detail::WindowSources::numbers(window));
  room_ = std::make_unique<Room>(window, limit);
}
SubsetsWindowWorkspace::~SubsetsWindowWorkspace() = default;
SubsetsWindowWorkspace::SubsetsWindowWorkspace(SubsetsWindowWorkspace&&) noexcept = default;
SubsetsWindowWorkspace& SubsetsWindowWorkspace::operator=(SubsetsWindowWorkspace&&) noexcept = default;

double subsets_to_try(const Window& w, const WindowAssumption& a) noexcept {
  int at_hand = 0;
  for (int source = 0; source < w.sources(); ++source) {
    bool present = false;
    for (int r = 0; r < w.rows() && !present; ++r) present = w.source(r) == source;
    at_hand += present && std::find(a.proved.begin(), a.proved.end(), source) == a.proved.end() ? 1 : 0;
  }
  const int left = a.s - static_cast<int>(a.proved.size());
  return left < 0 ? 0.0 : detail::choices(at_hand, std::min(left, at_hand));
}

const WindowWitness& subsets_window(const Window& window, const WindowAssumption& a,
                                    SubsetsWindowWorkspace& room) noexcept {
  return room.room_->answer(window, a);
}

namespace {

void require_subsets(const Window& window, const WindowAssumption& a) {
  require(a, window);
  if (a.moving) refuse("moving", "true", "a set that is fixed in the window", "use leverage_window()");
  if (!a.honest.empty()) refuse("honest", "sources", "none", "only leverage_window() uses them");
}

}  // namespace

WindowWitness subsets_window(const Window& window, const WindowAssumption& a, int limit) {
  require_subsets(window, a);
  const double sets = subsets_to_try(window, a);
  if (!(sets <= limit))
    refuse("sets", text(sets), "at most limit = " + std::to_string(limit),
           "use leverage_window() or anytime_window(), or raise the limit");
  SubsetsWindowWorkspace room(window, std::max(1, static_cast<int>(sets)));
  return subsets_window(window, a, room);
}

Vector subsets_window_width(const Window& w, const WindowAssumption& a, int limit) {
  require_subsets(w, a);
  if (!a.proved.empty()) refuse("proved", "sources", "none at design time");
  const Eigen::Index n = w.states();
  const WindowLevels& z = a.levels;
  detail::WindowSources sources(w);
  sources.begin(w, {});
  const auto ids = std::vector<int>(sources.at_hand);
  const int m = static_cast<int>(ids.size());
  const int first = std::min(a.s, m);
  const int second = std::min(a.s, m - first);
  const double pairs = detail::choices(m, first) * detail::choices(m - first, second);
  if (!(pairs <= limit))
    refuse("pairs of sets", text(pairs), "at most limit = " + std::to_string(limit), "take a smaller s");
  detail::require_room("sources", detail::WindowSources::numbers(w));
  Matrix V(w.unknowns(), w.rows());
  Matrix H(w.unknowns(), n);
  Vector free(w.rows());
  const auto frame_of =
      [&](Vector& deviation) {  // of the marked set: V, H, sqrt of the diagonal of E G^-1 E'
        for (int r = 0; r < w.rows(); ++r) {
          if (!sources.uses(w, r)) continue;
          V.col(r) = w.N(r);
          sources.fit.to_frame(V.col(r));
        }
        for (Eigen::Index i = 0; i < n; ++i) {
          H.col(i) = w.E().row(i).transpose();
          sources.fit.to_frame(H.col(i));
        }
        deviation = H.colwise().norm().transpose();
      };
  const auto bounded = [&] {
    double sum = w.prior_length() * w.prior_length();
    for (int r = 0; r < w.rows(); ++r)
      if (sources.uses(w, r)) sum += w.bias(r) * w.bias(r);
    return std::sqrt(sum);
  };
  Vector worst = Vector::Zero(n);
  Vector sd_K(n);
  Vector sd_h(n);
  std::vector<int> rest;
  const bool answered =
      detail::each_choice(std::span<const int>(ids), first, std::span(sources.part), Part::left_out, [&] {
        if (!sources.solve(w)) return false;
        frame_of(sd_K);
        const double b_K = bounded();
        for (int r = 0; r < w.rows(); ++r)
          if (sources.uses(w, r)) free(r) = sources.fit.free(V.col(r));
        rest.clear();
        for (const int id : ids)
          if (sources.part[static_cast<std::size_t>(id)] == Part::in) rest.push_back(id);
        return detail::each_choice(std::span<const int>(rest), second, std::span(sources.part),
                                   Part::left_out, [&] {
                                     if (!sources.solve(w)) return false;
                                     frame_of(sd_h);
                                     const double b_h = bounded();
                                     Vector push = Vector::Zero(n);
                                     for (int r = 0; r < w.rows(); ++r)
                                       if (sources.uses(w, r))
                                         push += free(r) * (H.transpose() * V.col(r)).cwiseAbs();
                                     push *= z.z1 + b_K;
                                     if (!std::isnan(z.z3)) push = push.cwiseMin((z.z3 + b_K) * sd_h);
                                     worst = worst.cwiseMax((z.zc + b_h) * sd_h + (z.zc + b_K) * sd_K + push);
                                     return true;
                                   });
      });
  return answered ? worst : Vector::Constant(n, kInfinity);
}

}  // namespace garrison::certificate
