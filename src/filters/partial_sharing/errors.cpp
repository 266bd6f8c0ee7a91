// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/errors.hpp"

#include <algorithm>
#include <array>

#include "core/solvers.hpp"
#include "core/spectrum.hpp"

namespace garrison::partial_sharing {
namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

Sparse assembled(Eigen::Index size, const Entries& entries) {
  Sparse matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// `value(r, a)` at row (i, r) and column (j, a) for all rows r.
template <class Value>
void column(Entries& entries, int m, int i, int j, int a, const Value& value) {
  for (int r = 0; r < m; ++r) entries.emplace_back(i * m + r, j * m + a, value(r));
}

Sparse error_steps(const Setting& s, const std::vector<LocalGains>& gains, std::int64_t k, bool own,
                   bool others) {
  const int m = s.states();
  const Matrix selected = s.selection.at(k);
  Entries entries;
  for (int i = 0; i < s.agents(); ++i) {
    const LocalGains& g = gains[static_cast<std::size_t>(i)];
    Matrix F = g.F;
    for (const int j : s.hears[static_cast<std::size_t>(i)])
      for (int a = 0; a < m; ++a) {
        if (selected(j, a) == 0.0) continue;
        F.col(a) -= g.C.col(a);
        if (others) column(entries, m, i, j, a, [&](int r) { return g.C(r, a); });
      }
    if (!own) continue;
    for (int a = 0; a < m; ++a) column(entries, m, i, i, a, [&](int r) { return F(r, a); });
  }
  return assembled(s.size(), entries);
}

/// M X M' for symmetric X, exactly symmetric.
Matrix congruence(const Sparse& M, const Matrix& X) {
  const Matrix half = M * X;
  const Matrix whole = M * half.transpose();
  return (whole + whole.transpose()) / 2.0;
}

Matrix initial(const Setting& s, bool common) {
  const int m = s.states();
  Matrix P = Matrix::Zero(s.size(), s.size());
  for (int i = 0; i < s.agents(); ++i)
    for (int j = 0; j < s.agents(); ++j)
      if (common || i == j) P.block(i * m, j * m, m, m) = s.P0;
  return P;
}

/// The gains of one k after the other, for the whole network.
class Recursions {
 public:
  explicit Recursions(const Setting& s) {
    for (int i = 0; i < s.agents(); ++i) each_.emplace_back(s, i);
  }
  std::vector<LocalGains> step() {
    std::vector<LocalGains> all;
    for (LocalRecursion& one : each_) all.push_back(one.step());
    return all;
  }

 private:
  std::vector<LocalRecursion> each_;
};

}  // namespace

Sparse coupling(const Setting& s, std::int64_t k) {
  const int m = s.states();
  const Matrix selected = s.selection.at(k);
  Entries entries;
  for (int i = 0; i < s.agents(); ++i)
    for (const int j : s.hears[static_cast<std::size_t>(i)])
      for (int a = 0; a < m; ++a) {
        if (selected(j, a) == 0.0) continue;
        entries.emplace_back(i * m + a, i * m + a, 1.0);
        entries.emplace_back(i * m + a, j * m + a, -1.0);
      }
  return assembled(s.size(), entries);
}

Sparse error_step(const Setting& s, const std::vector<LocalGains>& gains, std::int64_t k) {
  return error_steps(s, gains, k, true, true);
}

Sparse attack_step(const Setting& s, const std::vector<LocalGains>& gains, std::int64_t k) {
  return error_steps(s, gains, k, false, true);
}

Matrix noise_covariance(const Setting& s, const std::vector<LocalGains>& gains) {
  const int m = s.states();
  Matrix noise = s.Q.replicate(s.agents(), s.agents());
  for (int i = 0; i < s.agents(); ++i) {
    const Matrix& K = gains[static_cast<std::size_t>(i)].K;
    noise.block(i * m, i * m, m, m) += K * s.R[static_cast<std::size_t>(i)] * K.transpose();
  }
  return noise;
}

Matrix covariance_step(const Setting& s, const std::vector<LocalGains>& gains, std::int64_t k,
                       const Matrix& P, const Matrix& Sigma) {
  Matrix next = congruence(error_step(s, gains, k), P) + noise_covariance(s, gains);
  if (Sigma.size() != 0) next += congruence(attack_step(s, gains, k), Sigma);
  return next;
}

void check_byzantine(const Setting& s, const std::vector<int>& byzantine) {
  std::vector<int> sorted = byzantine;
  std::sort(sorted.begin(), sorted.end());
  const std::string range = "agents in 0.." + std::to_string(s.agents() - 1);
  if (!sorted.empty() && sorted.front() < 0) refuse("byzantine", std::to_string(sorted.front()), range);
  if (!sorted.empty() && sorted.back() >= s.agents())
    refuse("byzantine", std::to_string(sorted.back()), range);
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    refuse("byzantine", "agent " + std::to_string(*twice) + " twice", "every agent once");
}

void check_attack(const Setting& s, const MatrixRef& Sigma, const std::vector<int>& byzantine) {
  check_byzantine(s, byzantine);
  const std::string size = std::to_string(s.size()) + " x " + std::to_string(s.size());
  if (Sigma.rows() != s.size() || Sigma.cols() != s.size())
    refuse("Sigma", std::to_string(Sigma.rows()) + " x " + std::to_string(Sigma.cols()), size,
           "one block of m x m for every pair of agents");
  if (!Sigma.allFinite()) refuse("Sigma", "a number that is not finite", "finite numbers");
  const double largest = Sigma.size() == 0 ? 0.0 : Sigma.cwiseAbs().maxCoeff();
  if ((Sigma - Sigma.transpose()).cwiseAbs().maxCoeff() > 1e-12 * largest)
    refuse("Sigma", "a matrix that is not symmetric", "a symmetric covariance");
  const int m = s.states();
  for (int i = 0; i < s.agents(); ++i) {
    if (std::find(byzantine.begin(), byzantine.end(), i) != byzantine.end()) continue;
    if (Sigma.middleRows(i * m, m).cwiseAbs().maxCoeff() > 0.0)
      refuse("Sigma", "nonzero entries on the regular agent " + std::to_string(i),
             "zero outside the Byzantine agents", "name it in byzantine, or clear its rows and columns");
  }
  if (largest == 0.0) return;
  const double least = garrison::detail::least_eigenvalue(Sigma);
  if (least < -1e-10 * largest)
    refuse("Sigma", "least eigenvalue " + text(least), "a positive semidefinite covariance");
}

Trajectory error_covariance(const Setting& s, int steps, const Matrix& Sigma, std::int64_t k0, bool common) {
  if (k0 < 0) refuse("k0", std::to_string(k0), "a time >= 0");
  Recursions recursions(s);
  Trajectory out;
  out.P = initial(s, common);
  out.nmse.push_back(out.P.trace());
  for (int k = 0; k < steps; ++k) {
    out.P = covariance_step(s, recursions.step(), k, out.P, k >= k0 ? Sigma : Matrix());
    out.nmse.push_back(out.P.trace());
  }
  return out;
}

Trajectory error_covariance_iid(const Setting& s, int steps, const Matrix& Sigma, std::int64_t k0,
                                bool common) {
  const int m = s.states();
  const int N = s.agents();
  const Matrix W = s.selection.moments_uniform();
  std::vector<double> p;
  for (int j = 0; j < N; ++j) p.push_back(static_cast<double>(s.selection.shared(j)) / m);
  Recursions recursions(s);
  Trajectory out;
  out.P = initial(s, common);
  out.nmse.push_back(out.P.trace());
  const auto block = [m](const Matrix& M, int i, int j) { return M.block(i * m, j * m, m, m); };
  for (int k = 0; k < steps; ++k) {
    const auto gains = recursions.step();
    Matrix F = Matrix::Zero(s.size(), s.size());
    Matrix B = F;  // -C E{Lc}
    Matrix CZC = F;
    const bool attacked = k >= k0 && Sigma.size() != 0;
    for (int i = 0; i < N; ++i) {
      const LocalGains& g = gains[static_cast<std::size_t>(i)];
      F.block(i * m, i * m, m, m) = g.F;
      for (const int j : s.hears[static_cast<std::size_t>(i)]) {
        B.block(i * m, i * m, m, m) -= p[static_cast<std::size_t>(j)] * g.C;
        B.block(i * m, j * m, m, m) += p[static_cast<std::size_t>(j)] * g.C;
      }
      for (int q = 0; q < N; ++q) {
        Matrix sum = Matrix::Zero(m, m);  // X_iq + Y_iq
        for (const int j : s.hears[static_cast<std::size_t>(i)])
          for (const int r : s.hears[static_cast<std::size_t>(q)]) {
            Matrix difference =
                block(out.P, j, r) - block(out.P, j, q) - block(out.P, i, r) + block(out.P, i, q);
            if (attacked) difference += block(Sigma, j, r);
            sum += block(W, j, r).cwiseProduct(difference);
          }
        CZC.block(i * m, q * m, m, m) = g.C * sum * gains[static_cast<std::size_t>(q)].C.transpose();
      }
    }
    const Matrix FPB = F * out.P * B.transpose();
    const Matrix next = F * out.P * F.transpose() + FPB + FPB.transpose() + CZC + noise_covariance(s, gains);
    out.P = (next + next.transpose()) / 2.0;
    out.nmse.push_back(out.P.trace());
  }
  return out;
}

}  // namespace garrison::partial_sharing
