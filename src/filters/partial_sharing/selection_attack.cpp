// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "garrison/core/random.hpp"
#include "garrison/filters/partial_sharing/attack.hpp"

namespace garrison::partial_sharing {
namespace {

constexpr double kMostSubsets = 2e6;

double subsets(int m, int most) {
  double count = 0.0;
  double binomial = 1.0;
  for (int r = 0; r <= most; ++r) {
    count += binomial;
    binomial *= static_cast<double>(m - r) / (r + 1);
  }
  return count;
}

/// Calls `visit(set, value)` for all index sets of at most `most` entries, by size, then lexicographically;
/// value = v'Dv + linear'v.
class Subsets {
 public:
  using Visit = std::function<void(const std::vector<int>&, double)>;
  Subsets(const Matrix& D, const Vector& linear, const Visit& visit)
      : D_(D), linear_(linear), visit_(visit) {}
  void all(int most) {
    for (int size = 0; size <= most; ++size) extend(0, size, 0.0);
  }

 private:
  void extend(int first, int left, double value) {
    if (left == 0) return visit_(set_, value);
    for (int a = first; a + left <= static_cast<int>(D_.rows()); ++a) {
      double more = D_(a, a) + linear_(a);
      for (const int b : set_) more += 2.0 * D_(a, b);
      set_.push_back(a);
      extend(a + 1, left - 1, value + more);
      set_.pop_back();
    }
  }
  const Matrix& D_;
  const Vector& linear_;
  const Visit& visit_;
  std::vector<int> set_;
};

double sum_of_largest(Vector values, int count) {
  std::sort(values.begin(), values.end(), std::greater<>());
  double sum = 0.0;
  for (int k = 0; k < count; ++k) sum += std::max(values(k), 0.0);
  return sum;
}

}  // namespace

SelectionProblem::SelectionProblem(Matrix form, int count, int limit)
    : G(std::move(form)),
      blocks(count),
      size(count > 0 ? static_cast<int>(G.rows()) / count : 0),
      most(limit) {
  if (count < 1 || G.rows() != G.cols() || G.rows() % count != 0 || G.rows() == 0)
    refuse("G", std::to_string(G.rows()) + " x " + std::to_string(G.cols()),
           "a square matrix of " + std::to_string(count) + " equal blocks");
  if (!G.allFinite()) refuse("G", "a number that is not finite", "finite numbers");
  if (limit < 0 || limit > size)
    refuse("shared (l)", std::to_string(limit), "a number of entries in 0.." + std::to_string(size));
  if (subsets(size, limit) > kMostSubsets)
    refuse("shared (l)", std::to_string(limit) + " of " + amount(size, "entry", "entries"),
           "at most " + text(kMostSubsets) + " subsets per agent", "every subset of a block is tried");
}

double SelectionProblem::objective(const Vector& s) const {
  if (s.size() != G.rows())
    refuse("s", amount(s.size(), "number"), std::to_string(G.rows()) + ", as G has rows");
  return s.dot(G * s);
}

Vector SelectionProblem::best_block(int i, const Vector& s, double factor) const {
  const auto own = static_cast<Eigen::Index>(i) * size;
  const Matrix D = G.block(own, own, size, size);
  const Vector linear = factor * (G.middleRows(own, size) * s - D * s.segment(own, size));
  const double tie = 1e-13 * (D.cwiseAbs().sum() + linear.cwiseAbs().sum());
  double best = -kInfinity;
  std::vector<int> winner;
  const Subsets::Visit visit = [&](const std::vector<int>& set, double value) {
    if (value > best + tie || best == -kInfinity) {
      best = value;
      winner = set;
    }
  };
  Subsets(D, linear, visit).all(most);
  Vector v = Vector::Zero(size);
  for (const int a : winner) v(a) = 1.0;
  return v;
}

Ascent ascent(const SelectionProblem& p, const Vector& start, int sweeps, double factor, bool newest,
              bool rounding) {
  if (start.size() != p.G.rows()) refuse("start", amount(start.size(), "number"), std::to_string(p.G.rows()));
  constexpr int most_sweeps = 1'000'000;
  if (sweeps < 0 || sweeps > most_sweeps)
    refuse("sweeps", std::to_string(sweeps), "0.." + std::to_string(most_sweeps));
  Ascent out;
  out.s = start;
  out.objective.push_back(p.objective(out.s));
  for (int t = 0; t < sweeps; ++t) {
    const Vector before = out.s;
    for (int i = 0; i < p.blocks; ++i)
      out.s.segment(static_cast<Eigen::Index>(i) * p.size, p.size) =
          p.best_block(i, newest ? out.s : before, factor);
    out.objective.push_back(p.objective(out.s));
  }
  for (int i = 0; rounding && i < p.blocks; ++i) {
    auto own = out.s.segment(static_cast<Eigen::Index>(i) * p.size, p.size);
    std::vector<int> order(static_cast<std::size_t>(p.size));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return own(a) > own(b); });
    own.setZero();
    for (int k = 0; k < p.most; ++k) own(order[static_cast<std::size_t>(k)]) = 1.0;
  }
  out.rounded = p.objective(out.s);
  return out;
}

Vector best_of_starts(const SelectionProblem& p, int starts, std::uint64_t seed) {
  constexpr int most_starts = 100'000;
  if (starts < 1 || starts > most_starts)
    refuse("starts", std::to_string(starts), "1.." + std::to_string(most_starts));
  const Random chance(seed, 0, Purpose::start, 3);
  Vector best = Vector::Zero(p.G.rows());
  double record = p.objective(best);
  for (int k = 0; k < starts; ++k) {
    Vector s = Vector::Zero(p.G.rows());
    for (Eigen::Index a = 0; a < s.size(); ++a)
      s(a) = chance.uniform(k, static_cast<std::uint32_t>(a)) * p.size < p.most ? 1.0 : 0.0;
    for (int i = 0; i < p.blocks; ++i)
      s.segment(static_cast<Eigen::Index>(i) * p.size, p.size) = p.best_block(i, s, 2.0);
    double value = p.objective(s);
    for (bool better = true; better;) {
      const Ascent next = ascent(p, s, 1, 2.0, true, false);
      better = next.objective.back() > value + 1e-14 * std::abs(value);
      if (better) s = next.s;
      value = std::max(value, next.objective.back());
    }
    if (value > record) {
      record = value;
      best = s;
    }
  }
  return best;
}

ExactSelection exact_selection(const SelectionProblem& p, std::int64_t max_nodes) {
  const int B = p.blocks;
  const int m = p.size;
  const auto block = [&](int i, int j) {
    return p.G.block(static_cast<Eigen::Index>(i) * m, static_cast<Eigen::Index>(j) * m, m, m);
  };
  // What blocks i and j can give each other at most: the l largest of the rows' sums of their l largest
  // entries.
  Matrix pair = Matrix::Zero(B, B);
  std::vector<double> alone;
  const Vector nothing = Vector::Zero(m);
  for (int i = 0; i < B; ++i) {
    double best = 0.0;
    const Matrix D = block(i, i);
    const Subsets::Visit visit = [&](const std::vector<int>&, double value) { best = std::max(best, value); };
    Subsets(D, nothing, visit).all(p.most);
    alone.push_back(best);
    for (int j = 0; j < B; ++j) {
      Vector rows(m);
      for (int a = 0; a < m; ++a) rows(a) = sum_of_largest(block(i, j).row(a).transpose(), p.most);
      pair(i, j) = sum_of_largest(rows, p.most);
    }
  }
  pair = pair.cwiseMin(pair.transpose()).eval();
  ExactSelection out;
  out.s = best_of_starts(p, 8, 1);
  out.objective = p.objective(out.s);
  out.upper = out.objective;
  const double tie = 1e-13 * p.G.cwiseAbs().sum();
  Vector s = Vector::Zero(p.G.rows());
  const std::function<void(int, double)> branch = [&](int i, double value) {
    if (i == B) {
      if (value > out.objective + tie) {
        out.objective = p.objective(s);
        out.s = s;
      }
      return;
    }
    double bound = value;
    for (int j = i; j < B; ++j) {
      const Vector linear = 2.0 * p.G.middleRows(static_cast<Eigen::Index>(j) * m, m) * s;
      bound += alone[static_cast<std::size_t>(j)] + sum_of_largest(linear, p.most);
      for (int r = j + 1; r < B; ++r) bound += 2.0 * pair(j, r);
    }
    if (bound <= out.objective + tie) return;
    if (++out.nodes > max_nodes) {
      out.exact = false;
      out.upper = std::max(out.upper, bound);
      return;
    }
    const Matrix D = block(i, i);
    const Vector linear = 2.0 * p.G.middleRows(static_cast<Eigen::Index>(i) * m, m) * s;
    std::vector<std::pair<double, std::vector<int>>> children;
    const Subsets::Visit visit = [&](const std::vector<int>& set, double v) {
      children.emplace_back(v, set);
    };
    Subsets(D, linear, visit).all(p.most);
    std::stable_sort(children.begin(), children.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    auto own = s.segment(static_cast<Eigen::Index>(i) * m, m);
    for (const auto& [v, set] : children) {
      for (const int a : set) own(a) = 1.0;
      branch(i + 1, value + v);
      own.setZero();
    }
  };
  branch(0, 0.0);
  out.upper = std::max(out.upper, out.objective);
  return out;
}

}  // namespace garrison::partial_sharing
