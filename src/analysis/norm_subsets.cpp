// SPDX-License-Identifier: Apache-2.0
// varpi and tau_0: all removals where they can be enumerated, else a certified interval.
#include <algorithm>
#include <cmath>
#include <functional>

#include "garrison/analysis/subsets.hpp"
#include "garrison/core/budget.hpp"
#include "garrison/core/dispatch.hpp"
#include "row_groups.hpp"
#include "symmetric_eigen.hpp"

namespace garrison {
namespace {

constexpr double kMostSets = 3e6;
constexpr double kMostWork = 2e9;    // sets times n^3
constexpr double kMostMemory = 2e7;  // numbers of all partial sums

/// Walks over all sets of removed rows (by counts per group of equal rows); `value(S)` of the sum of
/// weight_i C_i'C_i over the kept rows is maximised. No result when the budget is over first.
template <int n>
class Enumeration {
 public:
  Enumeration(const MatrixRef& C, const Vector& weight, int s, const detail::RowGroups& groups,
              const SubsetLimits& limits)
      : C_(C),
        weight_(weight),
        s_(s),
        groups_(groups),
        budget_(current_budget().within(limits.max_seconds)) {}

  template <class Value>
  std::optional<SubsetBound> run(const Value& value) {
    const std::size_t G = groups_.members.size();
    const Mat<n> zero = Mat<n>::Zero(C_.cols(), C_.cols());
    tail_.assign(G + 1, zero);
    capacity_.assign(G + 1, 0);
    for (std::size_t k = G; k-- > 0;) {
      tail_[k] = tail_[k + 1] + kept(groups_.members[k], 0);
      capacity_[k] = capacity_[k + 1] + groups_.members[k].size();
    }
    best_.lower = -1.0;
    walk(zero, 0, static_cast<std::size_t>(s_), value);
    if (stopped_) return std::nullopt;
    std::sort(best_.removed.begin(), best_.removed.end());
    best_.upper = best_.lower;
    best_.exact = true;
    best_.method = "enumeration";
    return best_;
  }

 private:
  /// Sum over the members that stay when the first `taken` go.
  Mat<n> kept(const std::vector<int>& members, std::size_t taken) const {
    Mat<n> sum = Mat<n>::Zero(C_.cols(), C_.cols());
    for (std::size_t j = taken; j < members.size(); ++j)
      sum += weight_(members[j]) * C_.row(members[j]).transpose() * C_.row(members[j]);
    return sum;
  }

  /// S: what is kept of the groups before k. Sums are built up, never subtracted: nothing is left of removed
  /// rows.
  template <class Value>
  void walk(const Mat<n>& S, std::size_t k, std::size_t left, const Value& value) {
    if (left == 0) {
      if (++best_.nodes % 64 == 0 && budget_.over()) stopped_ = true;
      const double v = value(Mat<n>(S + tail_[k]));
      if (v <= best_.lower) return;
      best_.lower = v;
      best_.removed = removed_;
      return;
    }
    if (capacity_[k] < left || stopped_) return;
    const auto& members = groups_.members[k];
    const std::size_t before = removed_.size();
    for (std::size_t taken = 0; taken <= std::min(members.size(), left); ++taken) {
      if (taken > 0) removed_.push_back(members[taken - 1]);
      walk(Mat<n>(S + kept(members, taken)), k + 1, left - taken, value);
    }
    removed_.resize(before);
  }

  const MatrixRef& C_;
  const Vector& weight_;
  int s_;
  const detail::RowGroups& groups_;
  Budget budget_;
  bool stopped_ = false;
  SubsetBound best_;
  std::vector<int> removed_;
  std::vector<Mat<n>> tail_;           // sum of all rows of the groups from k on
  std::vector<std::size_t> capacity_;  // how many rows they have
};

/// Root of the largest eigenvalue of a positive semidefinite matrix.
template <class Square>
double root_of_largest(const Square& S) {
  const auto values = detail::eigenvalues<Square::ColsAtCompileTime>(S);
  return std::sqrt(std::max(values(values.size() - 1), 0.0));
}

template <class M>
double spectral_norm(const M& m) {
  const Mat<M::ColsAtCompileTime> gram = m.transpose() * m;
  return root_of_largest(gram);
}

void require_square(const MatrixRef& A, const MatrixRef& C) {
  if (A.rows() != C.cols() || A.cols() != C.cols() || !A.allFinite())
    refuse("A", std::to_string(A.rows()) + " x " + std::to_string(A.cols()),
           std::to_string(C.cols()) + " x " + std::to_string(C.cols()) + " finite numbers",
           "C has one column per state");
}

bool too_many(const detail::RowGroups& groups, int s, Eigen::Index states, const SubsetLimits& limits) {
  const double n = static_cast<double>(states);
  const double sets = std::min({kMostSets, static_cast<double>(limits.max_nodes), kMostWork / (n * n * n)});
  return static_cast<double>(groups.members.size()) * n * n > kMostMemory ||
         detail::removal_choices(groups, s) > sets;
}

}  // namespace

std::optional<SubsetBound> varpi_enumerated(const MatrixRef& C, const MatrixRef& A, int s,
                                            const SubsetLimits& limits) {
  detail::require_subset_input("varpi", C, s);
  require_square(A, C);
  const auto groups = detail::group_rows(C);
  if (too_many(groups, s, C.cols(), limits)) return std::nullopt;
  const double N = static_cast<double>(C.rows());
  return dispatch(static_cast<int>(C.cols()), [&]<int n>() {
    const Mat<n> a = A;
    const Vector weight = Vector::Ones(C.rows());
    return Enumeration<n>(C, weight, s, groups, limits).run([&](const Mat<n>& S) {
      const Mat<n> m = (Mat<n>::Identity(S.rows(), S.cols()) - S / N) * a;
      return spectral_norm(m);
    });
  });
}

SubsetBound varpi(const MatrixRef& C, const MatrixRef& A, int s, const SubsetLimits& limits) {
  if (auto exact = varpi_enumerated(C, A, s, limits)) return *std::move(exact);
  // ||(I - S/N) A|| <= a (1 - lambda_0/N) as long as S <= N I, which unit rows guarantee.
  const double N = static_cast<double>(C.rows());
  const auto l0 = lambda0(C, s, limits);
  SubsetBound b;
  const Matrix all = Matrix::Identity(C.cols(), C.cols()) - C.transpose() * C / N;
  b.lower = spectral_norm(Matrix(all * A));
  const double most = C.rowwise().squaredNorm().maxCoeff();
  b.upper = spectral_norm(Matrix(A)) * std::max(1.0 - l0.lower / N, most - 1.0);
  b.nodes = l0.nodes;
  b.method = "bound a (1 - lambda_0/N)";
  return b;
}

SubsetBound tau0(const MatrixRef& C, const MatrixRef& A, int s, const SubsetLimits& limits) {
  detail::require_subset_input("tau0", C, s);
  require_square(A, C);
  const auto groups = detail::group_rows(C);
  const double N = static_cast<double>(C.rows());
  // (1/N) ||[C_i'C_i A]_M|| = (1/N) sqrt(lambda_max(sum over M of |C_i A|^2 C_i'C_i)).
  const Vector weight = (C * A).rowwise().squaredNorm();
  const auto value = [&](const auto& S) { return root_of_largest(S) / N; };
  if (!too_many(groups, s, C.cols(), limits)) {
    auto exact = dispatch(static_cast<int>(C.cols()),
                          [&]<int n>() { return Enumeration<n>(C, weight, s, groups, limits).run(value); });
    if (exact) return *std::move(exact);
  }
  SubsetBound b;
  b.upper = value(Matrix(C.transpose() * weight.asDiagonal() * C));  // removing rows only lowers it
  b.method = "bound by all rows";
  return b;
}

}  // namespace garrison
