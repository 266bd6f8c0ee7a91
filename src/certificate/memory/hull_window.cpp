// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/hull_window.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "../require.hpp"
#include "choices.hpp"
#include "core/solvers.hpp"

namespace garrison::certificate {
namespace {

/// Rows |N d - r| <= b of one set of sources, and least upper bounds on e'd: by weak duality e'd <= sum y r +
/// |y| b for ANY y with N'y = e. The simplex method looks for the smallest one; a basis is some rows, each
/// with a sign.
class Program {
 public:
  Program(Matrix N, Vector r, Vector b) : N_(std::move(N)), r_(std::move(r)), b_(std::move(b)) {
    const Eigen::ColPivHouseholderQR<Matrix> qr(N_.transpose());
    if (qr.rank() < N_.cols()) return;
    start_.resize(static_cast<std::size_t>(N_.cols()));
    for (Eigen::Index k = 0; k < N_.cols(); ++k)
      start_[static_cast<std::size_t>(k)] = qr.colsPermutation().indices()(k);
    scale_ = 1.0 + r_.cwiseAbs().maxCoeff() + b_.maxCoeff();
  }

  bool determined() const { return !start_.empty(); }

  /// The least upper bound; none when the rows contradict each other.
  std::optional<double> most(const Vector& e) const {
    const Eigen::Index p = N_.cols();
    std::vector<Eigen::Index> basis = start_;
    Vector sign = Vector::Ones(p);
    Matrix B(p, p);
    Vector cost(p);
    const auto most_steps = static_cast<int>(50 * (N_.rows() + p));
    for (Eigen::Index k = 0; k < p; ++k) B.col(k) = row(basis, k);
    sign = (Eigen::PartialPivLU<Matrix>(B).solve(e).array() < 0.0).select(-sign, sign);  // a feasible start
    for (int step = 0;; ++step) {
      for (Eigen::Index k = 0; k < p; ++k) {
        B.col(k) = sign(k) * row(basis, k);
        cost(k) = b_(at(basis, k)) + sign(k) * r_(at(basis, k));
      }
      const Eigen::PartialPivLU<Matrix> now(B);
      const Vector y = now.solve(e);
      const Vector d = now.transpose().solve(cost);
      const auto [enters, way, gain] = entering(d, step > most_steps / 2);
      if (enters < 0 || step == most_steps) return value(basis, y, sign);
      const Vector w = now.solve(Vector(way * N_.row(enters).transpose()));
      Eigen::Index leaves = -1;
      double least = kInfinity;
      for (Eigen::Index k = 0; k < p; ++k) {
        if (!(w(k) > 1e-11)) continue;
        const double ratio = std::max(y(k), 0.0) / w(k);
        if (ratio < least) {
          least = ratio;
          leaves = k;
        }
      }
      if (leaves < 0) {
        if (gain < -1e-6 * scale_) return {};
        return value(basis, y, sign);
      }
      basis[static_cast<std::size_t>(leaves)] = enters;
      sign(leaves) = way;
    }
  }

 private:
  static Eigen::Index at(const std::vector<Eigen::Index>& basis, Eigen::Index k) {
    return basis[static_cast<std::size_t>(k)];
  }
  Vector row(const std::vector<Eigen::Index>& basis, Eigen::Index k) const {
    return N_.row(at(basis, k)).transpose();
  }
  double value(const std::vector<Eigen::Index>& basis, const Vector& y, const Vector& sign) const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < y.size(); ++k)
      sum += sign(k) * y(k) * r_(at(basis, k)) + std::abs(y(k)) * b_(at(basis, k));
    return sum;
  }
  struct Entering {
    Eigen::Index row;
    double way, gain;
  };
  /// The row that d violates most; late, the first one: no cycles.
  Entering entering(const Vector& d, bool late) const {
    Entering best{-1, 1.0, -1e-10 * scale_};
    for (Eigen::Index j = 0; j < N_.rows(); ++j) {
      const double over = N_.row(j).dot(d) - r_(j);
      const double gain = b_(j) - std::abs(over);
      if (!(gain < best.gain)) continue;
      best = {j, over > 0.0 ? 1.0 : -1.0, gain};
      if (late) break;
    }
    return best;
  }

  Matrix N_;
  Vector r_, b_;
  std::vector<Eigen::Index> start_;
  double scale_ = 1.0;
};

}  // namespace

Box hull_window(const Window& w, int s, int limit) {
  detail::require_least("s", s, 0);
  if (w.step() + 1 != w.steps())
    refuse("window", "step " + std::to_string(w.step()), "its last step, " + std::to_string(w.steps() - 1),
           "advance() to it, or begin() a shorter one");
  std::vector<char> part(static_cast<std::size_t>(w.sources()), 0);
  for (int r = 0; r < w.rows(); ++r) {
    if (w.noise(r) != RowNoise::bounded)
      refuse("window", "rows with Gaussian noise or a prior", "bounded rows only", "use leverage_window()");
    if (w.source(r) >= 0) part[static_cast<std::size_t>(w.source(r))] = 1;
  }
  std::vector<int> ids;
  for (int source = 0; source < w.sources(); ++source)
    if (part[static_cast<std::size_t>(source)] != 0) ids.push_back(source);
  const int left = std::min(s, static_cast<int>(ids.size()));
  const double sets = detail::choices(static_cast<int>(ids.size()), left);
  if (!(sets <= limit))
    refuse("sets", text(sets), "at most limit = " + std::to_string(limit), "use leverage_window()");

  const Eigen::Index n = w.states();
  const int p = w.unknowns();
  Box hull{Vector::Constant(n, kInfinity), Vector::Constant(n, -kInfinity)};
  const bool determined = detail::each_choice(std::span<const int>(ids), left, std::span(part), char{0}, [&] {
    std::vector<int> rows;
    for (int r = 0; r < w.rows(); ++r)
      if (w.source(r) < 0 || part[static_cast<std::size_t>(w.source(r))] != 0) rows.push_back(r);
    const auto count = static_cast<Eigen::Index>(rows.size());
    if (count < p) return false;
    Matrix N(count, p);
    Vector z(count);
    Vector b(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const int r = rows[static_cast<std::size_t>(k)];
      N.row(k) = w.N(r).transpose();
      z(k) = w.z(r);
      b(k) = w.bias(r) * (1.0 + 1e-12) + 1e-12 * std::abs(w.z(r));  // noise at its bound
    }
    const Vector theta = Eigen::ColPivHouseholderQR<Matrix>(N).solve(z);
    if (!theta.allFinite()) return false;
    const Program program(N, z - N * theta, b);
    if (!program.determined()) return false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector e = w.E().row(i).transpose();
      const double middle = e.dot(theta) + w.o()(i);
      const auto above = program.most(e);
      const auto below = program.most(-e);
      if (!above || !below) return true;  // nothing explains these rows
      hull.hi(i) = std::max(hull.hi(i), middle + *above);
      hull.lo(i) = std::min(hull.lo(i), middle - *below);
    }
    return true;
  });
  if (!determined) return {Vector::Constant(n, -kInfinity), Vector::Constant(n, kInfinity)};
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(hull.lo(i) <= hull.hi(i))) hull.lo(i) = hull.hi(i) = kNaN;
  return hull;
}

}  // namespace garrison::certificate
