// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/subsets.hpp"

#include <algorithm>
#include <cmath>

#include "least_squares.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

/// A set that may be the honest one: its least-squares state, and how far the true one may be.
struct Candidate {
  Vector x;
  double radius;
  Vector box;
};

class Search {
 public:
  Search(const Rows& rows, const Assumption& a, double z3)
      : rows_(rows),
        a_(a),
        z3_(z3),
        fit_(rows.states()),
        in_(static_cast<std::size_t>(rows.sources()), 0),
        cleared_(in_.size(), 0) {
    for (const int source : a.proved) in_[static_cast<std::size_t>(source)] = -1;
    for (int source = 0; source < rows.sources(); ++source)
      if (rows.has(source) && in_[static_cast<std::size_t>(source)] == 0) at_hand_.push_back(source);
    left_ = a.s - static_cast<int>(a.proved.size());
    for (const int source : at_hand_) in_[static_cast<std::size_t>(source)] = 1;
  }

  int at_hand() const { return static_cast<int>(at_hand_.size()); }
  int left() const { return left_; }

  /// Tries all sets of at_hand - left sources, those left out in lexicographic order. False when the rows of
  /// some set, consistent or not, do not determine the state.
  bool all() { return leave_out(0, left_); }

  const std::vector<Candidate>& consistent() const { return consistent_; }
  Witness witness() const;

 private:
  bool leave_out(std::size_t first, int more) {
    if (more == 0) return judge();
    for (std::size_t k = first; k + static_cast<std::size_t>(more) <= at_hand_.size(); ++k) {
      char& in = in_[static_cast<std::size_t>(at_hand_[k])];
      in = 0;
      const bool answered = leave_out(k + 1, more - 1);
      in = 1;
      if (!answered) return false;
    }
    return true;
  }

  bool uses(int j) const { return in_[static_cast<std::size_t>(rows_.source(j))] == 1; }

  bool judge() {
    if (!fit_.solve(rows_, [&](int j) { return uses(j); })) return false;
    double sum = 0.0;
    for (int j = 0; j < rows_.size(); ++j) {
      if (!uses(j)) continue;
      const double sigma = std::sqrt(rows_.variance(j));
      const double residual = std::abs(rows_.y(j) - rows_.c(j).dot(fit_.state()));
      const double room = a_.levels.z1 * sigma + a_.levels.z2 * std::sqrt(fit_.spread2(rows_, j));
      if (!(residual <= room + 1e-12 * (room + std::abs(rows_.y(j))))) return true;
      sum += (residual / sigma) * (residual / sigma);
    }
    if (!std::isnan(z3_) && !(sum <= z3_ * z3_ * (1.0 + 1e-12))) return true;
    Candidate one{fit_.state(), a_.levels.z2 / std::sqrt(fit_.least()), Vector(rows_.states())};
    for (Eigen::Index k = 0; k < one.box.size(); ++k) one.box(k) = a_.levels.z2 * std::sqrt(fit_.variance(k));
    consistent_.push_back(std::move(one));
    for (const int source : at_hand_)
      cleared_[static_cast<std::size_t>(source)] |= in_[static_cast<std::size_t>(source)];
    return true;
  }

  /// The candidate whose ball reaches furthest from c, and how far.
  std::pair<const Candidate*, double> furthest(const Vector& c) const {
    std::pair<const Candidate*, double> far{nullptr, -1.0};
    for (const Candidate& one : consistent_) {
      const double reach = (one.x - c).norm() + one.radius;
      if (reach > far.second) far = {&one, reach};
    }
    return far;
  }

  Region enclosing() const;

  const Rows& rows_;
  const Assumption& a_;
  double z3_;
  detail::LeastSquares fit_;
  std::vector<char> in_;       // per source: 1 in the set, 0 left out or absent, -1 proved before
  std::vector<char> cleared_;  // per source: in some consistent set
  std::vector<int> at_hand_;   // sources with a row that are not proved
  int left_;
  std::vector<Candidate> consistent_;
};

/// A small ball around all candidates: from the middle of their box, steps towards the furthest (Badoiu and
/// Clarkson) as long as they help.
Region Search::enclosing() const {
  const auto n = static_cast<Eigen::Index>(rows_.states());
  Vector low = Vector::Constant(n, kInfinity);
  Vector high = -low;
  for (const Candidate& one : consistent_) {
    low = low.cwiseMin((one.x.array() - one.radius).matrix());
    high = high.cwiseMax((one.x.array() + one.radius).matrix());
  }
  Region region{0.5 * (low + high), 0.0, Vector::Zero(n)};
  auto far = furthest(region.center);
  for (int t = 1; t < 30; ++t) {
    const Vector c = region.center + (far.first->x - region.center) / (t + 2);
    const auto next = furthest(c);
    if (next.second >= far.second) break;
    region.center = c;
    far = next;
  }
  region.radius = far.second;
  for (const Candidate& one : consistent_)
    region.box = region.box.cwiseMax((one.x - region.center).cwiseAbs() + one.box);
  return region;
}

Witness Search::witness() const {
  Witness w;
  w.region = enclosing();
  w.proved.assign(a_.proved.begin(), a_.proved.end());
  for (const int source : at_hand_)
    if (cleared_[static_cast<std::size_t>(source)] == 0) w.proved.push_back(source);
  std::sort(w.proved.begin(), w.proved.end());
  return w;
}

double choices(int of, int take) {
  double count = 1.0;
  for (int k = 1; k <= take; ++k) count *= static_cast<double>(of - take + k) / k;
  return count;
}

}  // namespace

Witness witness_subsets(const Rows& rows, const Assumption& a, double z3, int limit) {
  require(a, rows);
  detail::require_least("limit", limit, 1);
  if (!std::isnan(z3)) detail::require_least("z3", z3, 0.0);
  if (a.bounded) refuse("bounded", "true", "Gaussian levels", "use interval() or leverage_ball()");
  if (a.prior != nullptr) refuse("prior", "a region", "none", "only leverage_ball() uses one");
  Search search(rows, a, z3);
  Witness w;
  if (search.left() < 0) {
    w.region.radius = kNaN;
  } else if (search.at_hand() > search.left()) {
    const double sets = choices(search.at_hand(), search.left());
    if (sets > limit)
      refuse("sets", text(std::round(sets)), "at most limit = " + std::to_string(limit),
             "use leverage_ball(), or raise the limit");
    if (search.all()) {
      if (search.consistent().empty())
        w.region.radius = kNaN;
      else
        w = search.witness();
    }
  }
  w.kept.resize(static_cast<std::size_t>(rows.size()));
  if (w.proved.empty() && !w.region.refuted()) w.proved.assign(a.proved.begin(), a.proved.end());
  for (int j = 0; j < rows.size(); ++j)
    w.kept[static_cast<std::size_t>(j)] =
        static_cast<char>(std::find(w.proved.begin(), w.proved.end(), rows.source(j)) == w.proved.end());
  return w;
}

}  // namespace garrison::certificate
