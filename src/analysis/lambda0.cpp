// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "branch_and_bound.hpp"
#include "directions.hpp"
#include "garrison/analysis/subsets.hpp"
#include "garrison/core/dispatch.hpp"

namespace garrison {
namespace {

constexpr double kOrthogonal = 1e-12;
// Of three states: sets, which rows of very different lengths do not slow.
constexpr Eigen::Index kFewRows = 20;
/// Entries that are farther from 1 than this power of two are brought there: squares of squares of others are
/// numbers, and keep their bits.
constexpr int kFar = 64;

SubsetBound searched(const MatrixRef& C, int s, const SubsetLimits& limits) {
  if (C.cols() < 3 || (C.cols() == 3 && C.rows() > kFewRows))
    return detail::lambda0_by_directions(C, s, limits);
  return dispatch(static_cast<int>(C.cols()),
                  [&]<int n>() { return detail::BranchAndBound<n>(C, s, limits).run(); });
}

}  // namespace

std::optional<double> lambda0_orthogonal(const MatrixRef& C, int s) {
  detail::require_subset_input("lambda0", C, s);
  const Eigen::Index most = std::min(C.rows(), C.cols());  // so many rows can be orthogonal to each other
  Matrix first(most, C.cols());  // of each kind; a row meets the columns of its entries
  Vector products(most);
  std::vector<int> size;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    if (std::abs(C.row(i).squaredNorm() - 1.0) > kOrthogonal) return std::nullopt;
    const auto kinds = static_cast<Eigen::Index>(size.size());
    products.head(kinds).setZero();
    for (Eigen::Index k = 0; k < C.cols(); ++k)
      if (C(i, k) != 0.0) products.head(kinds) += C(i, k) * first.col(k).head(kinds);
    Eigen::Index home = kinds;
    for (Eigen::Index g = 0; g < kinds; ++g) {
      const double product = std::abs(products(g));
      if (std::abs(product - 1.0) <= kOrthogonal)
        home = g;
      else if (product > kOrthogonal)
        return std::nullopt;
    }
    if (home == most) return std::nullopt;
    if (home == kinds) {
      first.row(kinds) = C.row(i);
      size.push_back(0);
    }
    ++size[static_cast<std::size_t>(home)];
  }
  if (static_cast<Eigen::Index>(size.size()) < C.cols()) return 0.0;
  return std::max(0.0, static_cast<double>(*std::min_element(size.begin(), size.end()) - s));
}

SubsetLimits usual_limits(Eigen::Index rows, Eigen::Index states) {
  constexpr double kWork = 4e7;  // rows looked at, for few states
  const double per_node =
      static_cast<double>(rows) * std::max(1.0, static_cast<double>(states * states) / 16.0);
  SubsetLimits limits;
  limits.max_nodes =
      static_cast<std::int64_t>(std::clamp(kWork / per_node, 200.0, static_cast<double>(limits.max_nodes)));
  return limits;
}

SubsetBound lambda0(const MatrixRef& C, int s, const SubsetLimits& limits) {
  detail::require_subset_input("lambda0", C, s);
  SubsetBound trivial;
  trivial.exact = true;
  if (C.rows() - s < C.cols()) {  // fewer rows than states are left
    for (int i = 0; i < s; ++i) trivial.removed.push_back(i);
    trivial.method = "rank";
    return trivial;
  }
  if (const auto closed = lambda0_orthogonal(C, s)) {
    const auto groups = detail::group_rows(C);
    const auto smallest = std::min_element(groups.members.begin(), groups.members.end(),
                                           [](const auto& a, const auto& b) { return a.size() < b.size(); });
    trivial.removed = *smallest;
    for (int i = 0; static_cast<int>(trivial.removed.size()) < s; ++i)
      if (std::find(smallest->begin(), smallest->end(), i) == smallest->end()) trivial.removed.push_back(i);
    trivial.removed.resize(static_cast<std::size_t>(s));
    std::sort(trivial.removed.begin(), trivial.removed.end());
    trivial.lower = trivial.upper = *closed;
    trivial.method = "orthogonal rows";
    return trivial;
  }
  int power = 0;
  std::frexp(C.cwiseAbs().maxCoeff(), &power);
  if (std::abs(power) <= kFar) return searched(C, s, limits);
  power = std::max(power, -1000);  // 2^1000 is a number
  SubsetBound bound = searched(C * std::ldexp(1.0, -power), s, limits);
  bound.lower = std::ldexp(bound.lower, 2 * power);
  bound.upper = std::ldexp(bound.upper, 2 * power);
  return bound;
}

}  // namespace garrison
