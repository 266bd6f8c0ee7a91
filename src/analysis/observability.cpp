// SPDX-License-Identifier: Apache-2.0
#include "garrison/analysis/observability.hpp"

#include <algorithm>
#include <numeric>

#include "clearly_observable.hpp"
#include "garrison/analysis/modes.hpp"
#include "garrison/analysis/subsets.hpp"
#include "garrison/core/budget.hpp"
#include "row_groups.hpp"
#include "splitting.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;
using detail::Complex;
using detail::MatrixOf;

/// Rows whose leverages sum to less than 1 minus this can go without any loss of rank.
constexpr double kMargin = 1e-6;
/// Relative singular value below which the mode is looked at with care.
constexpr double kWeak = 1e-3;

/// A row of C with its copies.
struct Group {
  Index row;
  int size;
};

[[noreturn]] void refuse_unclear(const std::string& which, const std::string& words) {
  refuse(which, words, "a pair that is surely observable, or surely not",
         "structure.visibility says how far the nearest pair with an unseen mode is");
}

Visibility look(const MatrixRef& A, const MatrixRef& C) {
  if (A.cols() != A.rows() || C.cols() != A.rows())
    refuse("C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()), "as many columns as A has rows");
  return detail::clearly_observable(A, C) ? Visibility{} : visibility(A, C, 0.0);
}

/// At one mode z: does [A - z I; C] keep its rank when groups of together at most s rows go? With R'R = P'P,
/// removing the rows V does no harm if the sum of their leverages |R'^-1 c|^2 is below 1.
template <class S>
class Removals {
 public:
  Removals(const Matrix& A, const Matrix& C, const detail::Pair& pair)
      : A_(A),
        C_(C),
        pair_A_(pair.A.cast<S>()),
        pair_C_(pair.C.cast<S>()),
        size_(detail::pair_size(pair.A, pair.C)) {}

  bool survives(S z, const std::vector<Group>& kept, const std::vector<Group>& free, int s) {
    if (++tried_ > kMostRemovals)
      refuse("s_sparse_observable", "more than " + text(kMostRemovals) + " sets to try", "a smaller s or N");
    require_time("the search for sensors whose loss ends observability");
    const MatrixOf<S> R = detail::triangle<S>(pair_A_, rows(pair_C_, kept), z);
    detail::VectorOf<S> v;
    if (detail::least_singular<S>(R, v) <= kWeak * size_) {
      const Visibility seen = look(A_, rows(C_, kept));
      if (seen.sight == Sight::unseen) return false;
      if (seen.sight == Sight::unclear && unclear_.empty()) unclear_ = seen.text();
    }
    std::vector<double> leverage(free.size());
    for (std::size_t k = 0; k < free.size(); ++k)
      leverage[k] = R.adjoint()
                        .template triangularView<Eigen::Lower>()
                        .solve(pair_C_.row(free[k].row).adjoint())
                        .squaredNorm();
    std::vector<std::size_t> order(free.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto density = [&](std::size_t k) { return leverage[k] / free[k].size; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return density(a) > density(b); });
    for (std::size_t k = 0; k < order.size(); ++k) {
      double budget = s;  // what the best choice from here on can remove, groups in parts allowed
      double sum = 0.0;
      for (std::size_t j = k; j < order.size() && budget > 0.0; ++j) {
        const double part = std::min(budget, static_cast<double>(free[order[j]].size));
        sum += part * density(order[j]);
        budget -= part;
      }
      if (!(sum >= 1.0 - kMargin)) return true;
      const Group& gone = free[order[k]];
      if (gone.size > s) continue;
      std::vector<Group> still;
      for (const Group& g : kept)
        if (g.row != gone.row) still.push_back(g);
      std::vector<Group> rest;
      for (std::size_t j = k + 1; j < order.size(); ++j) rest.push_back(free[order[j]]);
      if (!survives(z, still, rest, s - gone.size)) return false;
    }
    return true;
  }
  /// What was said of a pair of which one cannot tell; empty where there was none.
  const std::string& unclear() const { return unclear_; }

 private:
  template <class M>
  static M rows(const M& C, const std::vector<Group>& kept) {
    M some(static_cast<Index>(kept.size()), C.cols());
    for (std::size_t k = 0; k < kept.size(); ++k) some.row(static_cast<Index>(k)) = C.row(kept[k].row);
    return some;
  }

  const Matrix& A_;
  const Matrix& C_;
  MatrixOf<S> pair_A_, pair_C_;
  double size_;
  double tried_ = 0.0;
  std::string unclear_;
};

template <class S>
bool all_survive(const Matrix& A, const Matrix& C, const detail::Pair& pair,
                 const std::vector<Complex>& modes, const std::vector<Group>& groups, int s) {
  Removals<S> removals(A, C, pair);
  const bool all = std::all_of(modes.begin(), modes.end(), [&](Complex z) {
    return removals.survives(detail::scalar_of<S>(z), groups, groups, s);
  });
  if (all && !removals.unclear().empty())
    refuse_unclear("s_sparse_observable", "rows whose loss leaves a pair of which one " + removals.unclear());
  return all;
}

}  // namespace

bool observable(const MatrixRef& A, const MatrixRef& C) {
  const Visibility seen = look(A, C);
  if (seen.sight == Sight::unclear) refuse_unclear("observable", "(A, C) of which one " + seen.text());
  return seen.all_seen();
}

bool surely_observable(const MatrixRef& A, const MatrixRef& C) { return look(A, C).all_seen(); }

bool s_sparse_observable(const MatrixRef& A, const MatrixRef& C, int s) {
  detail::require_subset_input("s_sparse_observable", C, s);
  if (look(A, C).sight == Sight::unseen) return false;
  std::vector<Group> groups;
  for (const auto& members : detail::group_rows(C).members)
    groups.push_back({members.front(), static_cast<int>(members.size())});
  const auto [own_A, own_C] = detail::in_moderate_units(A, C);
  const double rate = detail::natural_rate(own_A);
  const detail::Pair pair = detail::balanced(own_A, own_C, rate);
  const auto modes = detail::candidate_modes(own_A, pair.A, rate, 0.0);
  const bool real = std::all_of(modes.begin(), modes.end(), [](Complex z) { return z.imag() == 0.0; });
  return real ? all_survive<double>(own_A, own_C, pair, modes, groups, s)
              : all_survive<Complex>(own_A, own_C, pair, modes, groups, s);
}

bool one_step_sparse_observable(const MatrixRef& C, int s) {
  return s < C.rows() && lambda0(C, s).lower > 1e-9;
}

}  // namespace garrison
