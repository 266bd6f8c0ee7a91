// SPDX-License-Identifier: Apache-2.0
// Takes the unseen modes out of a balanced pair. Internal.
#pragma once

#include <algorithm>

#include "balance.hpp"
#include "garrison/analysis/modes.hpp"
#include "garrison/core/budget.hpp"
#include "pencil.hpp"
#include "unseen_part.hpp"

namespace garrison::detail {

/// Takes the unseen modes out of a balanced pair one eigenspace after the other; what stays is the rest.
template <class S>
class Splitting {
 public:
  Splitting(const Pair& pair, double least) : A_(pair.A.cast<S>()), C_(pair.C.cast<S>()), least_(least) {
    size_ = pair_size(A_, C_);
    level_ = unseen_level(A_.rows());
    unclear_level_ = unclear_level(A_.rows());
  }

  Visibility run(const std::vector<Complex>& candidates) {
    out_.distance = kInfinity;
    // First what is surely unseen, from the best candidate: it may make clear what was unclear before.
    sweep(candidates, level_);
    if (doubtful_) sweep(candidates, unclear_level_);
    if (!out_.unseen.empty())
      out_.sight = Sight::unseen;
    else if (!out_.unclear.empty())
      out_.sight = Sight::unclear;
    return out_;
  }

  /// The pair without its unseen and unclear modes; every row of C is still there.
  const MatrixOf<S>& A() const { return A_; }
  const MatrixOf<S>& C() const { return C_; }
  /// Norm of the whole pair, to which distances are relative.
  double size() const { return size_; }

 private:
  using Index = Eigen::Index;
  static constexpr double kGoal = 0.1;  // part of the level below which a mode need not be refined

  void sweep(const std::vector<Complex>& candidates, double bar) {
    for (const Complex candidate : candidates) {
      require_time("the decision which modes are seen");
      while (A_.rows() > 0 && one_mode(scalar_of<S>(candidate), bar)) {
      }
    }
  }

  /// Looks at one z; true when something of relative distance up to `bar` was taken out there.
  bool one_mode(S z, double bar) {
    const Try found = descend(at(Complex(z)));
    const double sigma = found.sigma;
    z = found.z;
    if (sigma < out_.distance) {
      out_.distance = sigma;
      out_.nearest = z;
    }
    if (!(sigma <= bar)) {
      doubtful_ = doubtful_ || sigma <= unclear_level_;
      return false;
    }
    auto& list = sigma <= level_ ? out_.unseen : out_.unclear;
    const MatrixOf<S> gone = eigenspace(z, found.v, std::max(sigma, level_));
    list.insert(list.end(), static_cast<std::size_t>(gone.cols()), Complex(z));
    take_out(gone);
    return true;
  }

  struct Try {
    S z;
    VectorOf<S> v;
    double sigma;
  };
  Try at(Complex z) const {
    Try t{scalar_of<S>(outside(z, least_)), {}, 0.0};
    t.sigma = least_singular<S>(triangle<S>(A_, C_, t.z), t.v) / size_;
    return t;
  }

  /// Lowers sigma in z. For fixed v the best z is v'Av, for fixed z the best v is the singular vector: that
  /// never fails, but is slow near eigenvalues of A that lie close together. Newton's step to sigma = 0 is
  /// fast where the mode is unseen.
  Try descend(Try now) const {
    constexpr int kMost = 30;
    const double hopeless = A_.rows() <= kThorough ? 0.05 : 1e-5;
    int idle = 0;
    for (int k = 0; k < kMost && idle < 2 && now.sigma > kGoal * level_ && now.sigma < hopeless; ++k) {
      const VectorOf<S> moved = A_ * now.v;
      Try next = at(Complex(now.v.dot(moved)));
      const VectorOf<S> u = (moved - now.z * now.v) / (now.sigma * size_);
      const Complex slope(u.dot(now.v));
      if (std::abs(slope) > now.sigma) {
        for (const double copies : {1.0, 2.0, 3.0}) {  // a k-fold mode asks for k times the step
          Try newton = at(Complex(now.z) + copies * now.sigma * size_ / slope);
          if (newton.sigma < next.sigma) next = std::move(newton);
        }
      }
      if (!(next.sigma < now.sigma)) break;
      idle = next.sigma > 0.9 * now.sigma ? idle + 1 : 0;
      now = next;
    }
    return now;
  }

  /// Orthonormal basis of all directions that are as little seen at z as v.
  MatrixOf<S> eigenspace(S z, const VectorOf<S>& v, double level) const {
    const Index n = A_.rows();
    MatrixOf<S> pencil(n + C_.rows(), n);
    pencil.topRows(n) = A_;
    pencil.topRows(n).diagonal().array() -= z;
    pencil.bottomRows(C_.rows()) = C_;
    const Eigen::ColPivHouseholderQR<MatrixOf<S>> qr(pencil);
    Index rank = 0;
    while (rank < n && std::abs(qr.matrixQR()(rank, rank)) > level * size_) ++rank;
    if (n - rank >= 2) {
      MatrixOf<S> N(n, n - rank);
      N.topRows(rank) = -qr.matrixQR()
                             .topLeftCorner(rank, rank)
                             .template triangularView<Eigen::Upper>()
                             .solve(qr.matrixQR().topRightCorner(rank, n - rank));
      N.bottomRows(n - rank).setIdentity();
      const MatrixOf<S> placed = qr.colsPermutation() * N;
      const Eigen::HouseholderQR<MatrixOf<S>> basis(placed);
      const MatrixOf<S> thin = basis.householderQ() * MatrixOf<S>::Identity(n, n - rank);
      if ((pencil * thin).norm() <= 4.0 * level * size_ * std::sqrt(static_cast<double>(n - rank)))
        return thin;
    }
    return v;
  }

  /// The pair on what is orthogonal to `gone`, which A maps into itself and C does not see.
  void take_out(const MatrixOf<S>& gone) {
    const Index n = A_.rows();
    const Index rest = n - gone.cols();
    const Eigen::HouseholderQR<MatrixOf<S>> qr(gone);
    MatrixOf<S> keep = MatrixOf<S>::Zero(n, rest);
    keep.bottomRows(rest).setIdentity();
    keep = qr.householderQ() * keep;
    A_ = MatrixOf<S>(keep.adjoint() * A_ * keep);
    C_ = MatrixOf<S>(C_ * keep);
  }

  MatrixOf<S> A_, C_;
  double least_;
  double size_ = 1.0;
  double level_ = 0.0;
  double unclear_level_ = 0.0;
  bool doubtful_ = false;
  Visibility out_;
};

// Compiled once, in unseen_part.cpp: that takes a compiler half a minute.
extern template class Splitting<double>;
extern template class Splitting<Complex>;

}  // namespace garrison::detail
