// SPDX-License-Identifier: Apache-2.0
// varpi and tau_0: all removals where they can be enumerated, else a certified interval.
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

#include "garrison/analysis/subsets.hpp"
#include "garrison/core/dispatch.hpp"
#include "row_groups.hpp"

namespace garrison {
namespace {

constexpr double kMostSets = 3e6;

/// Walks over all sets of removed rows (by counts per group of equal rows); `value(S)` of the sum of
/// weight_i C_i'C_i over the kept rows is maximised.
template <int n>
class Enumeration {
 public:
  Enumeration(const MatrixRef& C, const Vector& weight, int s, const detail::RowGroups& groups)
      : C_(C), weight_(weight), s_(s), groups_(groups) {}

  template <class Value>
  SubsetBound run(const Value& value) {
    Mat<n> S = Mat<n>::Zero(C_.cols(), C_.cols());
    for (Eigen::Index i = 0; i < C_.rows(); ++i) S += outer(i);
    best_.lower = -1.0;
    walk(S, 0, s_, value);
    std::sort(best_.removed.begin(), best_.removed.end());
    best_.upper = best_.lower;
    best_.exact = true;
    best_.method = "enumeration";
    return best_;
  }

 private:
  Mat<n> outer(Eigen::Index i) const { return weight_(i) * C_.row(i).transpose() * C_.row(i); }

  template <class Value>
  void walk(Mat<n> S, std::size_t k, int left, const Value& value) {
    if (left == 0) {
      ++best_.nodes;
      const double v = value(S);
      if (v <= best_.lower) return;
      best_.lower = v;
      best_.removed = removed_;
      return;
    }
    if (k == groups_.members.size()) return;
    std::size_t capacity = 0;
    for (std::size_t j = k; j < groups_.members.size(); ++j) capacity += groups_.members[j].size();
    if (capacity < static_cast<std::size_t>(left)) return;
    const auto& members = groups_.members[k];
    std::size_t taken = 0;
    walk(S, k + 1, left, value);
    for (; taken < members.size() && static_cast<int>(taken) < left; ++taken) {
      S -= outer(members[taken]);
      removed_.push_back(members[taken]);
      walk(S, k + 1, left - static_cast<int>(taken) - 1, value);
    }
    removed_.resize(removed_.size() - taken);
  }

  const MatrixRef& C_;
  const Vector& weight_;
  int s_;
  const detail::RowGroups& groups_;
  SubsetBound best_;
  std::vector<int> removed_;
};

template <class M>
double spectral_norm(const M& m) {
  using Square = Eigen::Matrix<double, M::ColsAtCompileTime, M::ColsAtCompileTime>;
  const Square gram = m.transpose() * m;
  const auto values = Eigen::SelfAdjointEigenSolver<Square>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(values(values.size() - 1), 0.0));
}

void require_square(const MatrixRef& A, const MatrixRef& C) {
  if (A.rows() != C.cols() || A.cols() != C.cols() || !A.allFinite())
    refuse("A", std::to_string(A.rows()) + " x " + std::to_string(A.cols()),
           std::to_string(C.cols()) + " x " + std::to_string(C.cols()) + " finite numbers",
           "C has one column per state");
}

bool too_many(const detail::RowGroups& groups, int s, const SubsetLimits& limits) {
  return detail::removal_choices(groups, s) > std::min(kMostSets, static_cast<double>(limits.max_nodes));
}

}  // namespace

SubsetBound varpi(const MatrixRef& C, const MatrixRef& A, int s, const SubsetLimits& limits) {
  detail::require_subset_input("varpi", C, s);
  require_square(A, C);
  const auto groups = detail::group_rows(C);
  const double N = static_cast<double>(C.rows());
  if (too_many(groups, s, limits)) {
    // ||(I - S/N) A|| <= a (1 - lambda_0/N) as long as S <= N I, which unit rows guarantee.
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
  return dispatch(static_cast<int>(C.cols()), [&]<int n>() {
    const Mat<n> a = A;
    const Vector weight = Vector::Ones(C.rows());
    return Enumeration<n>(C, weight, s, groups).run([&](const Mat<n>& S) {
      const Mat<n> m = (Mat<n>::Identity(S.rows(), S.cols()) - S / N) * a;
      return spectral_norm(m);
    });
  });
}

SubsetBound tau0(const MatrixRef& C, const MatrixRef& A, int s, const SubsetLimits& limits) {
  detail::require_subset_input("tau0", C, s);
  require_square(A, C);
  const auto groups = detail::group_rows(C);
  const double N = static_cast<double>(C.rows());
  // (1/N) ||[C_i'C_i A]_M|| = (1/N) sqrt(lambda_max(sum over M of |C_i A|^2 C_i'C_i)), note 15.
  const Vector weight = (C * A).rowwise().squaredNorm();
  const auto value = [&](const auto& S) {
    using Square = std::decay_t<decltype(S)>;
    const auto values = Eigen::SelfAdjointEigenSolver<Square>(S, Eigen::EigenvaluesOnly).eigenvalues();
    return std::sqrt(std::max(values(values.size() - 1), 0.0)) / N;
  };
  if (too_many(groups, s, limits)) {
    SubsetBound b;
    b.upper = value(Matrix(C.transpose() * weight.asDiagonal() * C));  // removing rows only lowers it
    b.method = "bound by all rows";
    return b;
  }
  return dispatch(static_cast<int>(C.cols()),
                  [&]<int n>() { return Enumeration<n>(C, weight, s, groups).run(value); });
}

}  // namespace garrison
