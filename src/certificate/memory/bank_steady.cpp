// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "../require.hpp"
#include "bank_sources.hpp"
#include "choices.hpp"
#include "core/solvers.hpp"
#include "garrison/certificate/kernels.hpp"
#include "garrison/core/budget.hpp"
#include "riccati.hpp"

namespace garrison::certificate {
namespace {

/// The rows of some sources, and how its Kalman filter settles.
struct Settled {
  Matrix C;
  Vector R;
  std::vector<int> source;  // of each row
  Matrix P, S, L;           // before the rows, of the innovation, the gain
};

std::optional<Settled> settle(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources,
                              const std::vector<char>& out) {
  Settled f;
  for (std::size_t j = 0; j < sources.size(); ++j)
    if (out[j] == 0)
      f.source.insert(f.source.end(), static_cast<std::size_t>(sources[j].R.size()), static_cast<int>(j));
  const auto rows = static_cast<Eigen::Index>(f.source.size());
  if (rows == 0) return {};
  f.C.resize(rows, A.rows());
  f.R.resize(rows);
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < sources.size(); ++j) {
    if (out[j] != 0) continue;
    f.C.middleRows(at, sources[j].R.size()) = sources[j].C;
    f.R.segment(at, sources[j].R.size()) = sources[j].R;
    at += sources[j].R.size();
  }
  const std::optional<Matrix> P = detail::steady_covariance(A, f.C, Q, f.R);
  if (!P) return {};
  f.P = *P;
  f.S = f.C * f.P * f.C.transpose() + Matrix(f.R.asDiagonal());
  f.L = Eigen::LLT<Matrix>(f.S).solve(f.C * f.P).transpose();
  return f;
}

/// sum_k |F^k B| over the columns, per coordinate and in the 2-norm; infinite when it does not settle.
Vector impulse_sums(const Matrix& F, const Matrix& B) {
  constexpr int kMost = 20000;
  const Eigen::Index n = F.rows();
  Vector sum = Vector::Zero(n + 1);
  Matrix XB = B;
  for (int k = 0; k < kMost; ++k) {
    Vector add(n + 1);
    add.head(n) = XB.cwiseAbs().rowwise().sum();
    add(n) = XB.colwise().norm().sum();
    sum += add;
    if ((add.array() <= 1e-10 * sum.array()).all()) return sum;
    XB = F * XB;
  }
  return Vector::Constant(n + 1, kInfinity);
}

Matrix after_rows(const Settled& f) { return f.P - f.L * f.C * f.P; }

/// Theorem B2 for one member K and the honest part H of it: how far its centre ever is from x.
Vector distance(const MatrixRef& A, const Settled& K, const Settled& H, const std::vector<char>& out_H,
                const WindowLevels& z) {
  const Eigen::Index n = A.rows();
  const Matrix T = Eigen::LLT<Matrix>(K.S).matrixL();
  Matrix T_H(H.C.rows(), T.cols());
  Eigen::Index at = 0;
  for (std::size_t r = 0; r < K.source.size(); ++r)
    if (out_H[static_cast<std::size_t>(K.source[r])] == 0)
      T_H.row(at++) = T.row(static_cast<Eigen::Index>(r));
  const Matrix F = (Matrix::Identity(n, n) - H.L * H.C) * A;
  const Matrix P_H = after_rows(H);
  Vector bound = z.z1 * impulse_sums(F, K.L * T - H.L * T_H);
  bound.head(n) += z.zc * P_H.diagonal().cwiseMax(0.0).cwiseSqrt();
  bound(n) += z.z2 * std::sqrt(spectral_norm(P_H));
  bound(n) = std::min(bound(n), bound.head(n).norm());
  return bound;
}

/// The largest of `of`(distances, K) over all members K and honest parts; infinite where some set does not
/// detect.
template <class Of>
Vector worst_member(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources, int s,
                    const WindowLevels& z, int limit, const Of& of) {
  const Eigen::Index n = A.rows();
  detail::require_bank(A, Q, sources, s);
  const int m = static_cast<int>(sources.size());
  detail::require_least("z1", z.z1, 0.0);
  detail::require_least("z2", z.z2, 0.0);
  detail::require_least("zc", z.zc, 0.0);
  const int second = std::min(s, m - s);
  const double pairs = detail::choices(m, s) * detail::choices(m - s, second);
  if (!(pairs <= limit))
    refuse("pairs of sets", text(pairs), "at most limit = " + std::to_string(limit), "take a smaller s");
  std::vector<char> out(sources.size(), 0);
  std::vector<int> ids(sources.size());
  for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = static_cast<int>(k);
  Vector worst = Vector::Zero(n + 1);
  const bool bounded = detail::each_choice(std::span<const int>(ids), s, std::span(out), char{1}, [&] {
    const auto K = settle(A, Q, sources, out);
    if (!K) return false;
    std::vector<int> rest;
    for (const int id : ids)
      if (out[static_cast<std::size_t>(id)] == 0) rest.push_back(id);
    return detail::each_choice(std::span<const int>(rest), second, std::span(out), char{1}, [&] {
      require_time("the bank's steady error");
      const auto H = settle(A, Q, sources, out);
      if (!H) return false;
      worst = worst.cwiseMax(of(distance(A, *K, *H, out, z), *K));
      return true;
    });
  });
  return bounded ? worst : Vector::Constant(n + 1, kInfinity);
}

}  // namespace

Vector bank_steady(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources, int s,
                   const WindowLevels& z, int limit) {
  return worst_member(A, Q, sources, s, z, limit, [](const Vector& far, const Settled&) { return far; });
}

Vector bank_steady_width(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources,
                         int s, const WindowLevels& z, int limit) {
  const Eigen::Index n = A.rows();
  return worst_member(A, Q, sources, s, z, limit,
                      [&](const Vector& far, const Settled& K) {
                        Vector reach = far;
                        reach.head(n) += z.zc * after_rows(K).diagonal().cwiseMax(0.0).cwiseSqrt();
                        return reach;
                      })
      .head(n);
}

}  // namespace garrison::certificate
