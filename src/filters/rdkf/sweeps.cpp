// SPDX-License-Identifier: Apache-2.0
#include "sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/solvers.hpp"
#include "garrison/core/budget.hpp"

namespace garrison::rdkf {
namespace {

using detail::Extended;
using detail::inverse_root;
using detail::product;

constexpr double kGrown = 1e14;  // times the largest entry of Sw and of (C'Sv^-1C)^-1
/// Rounding may keep the change above the tolerance: sweeps without progress after which a small change
/// counts.
constexpr int kPatience = 30;
constexpr double kSmallChange = 1e-10;

Matrix inverse(const Matrix& S) {
  const Matrix inv = Eigen::LLT<Matrix>(S).solve(Matrix::Identity(S.rows(), S.cols()));
  return 0.5 * (inv + inv.transpose());
}

Matrix inverse_root(const Matrix& Q) {
  return Eigen::LLT<Matrix>(Q).matrixU().solve(Matrix::Identity(Q.rows(), Q.cols()));
}
Matrix square(const Matrix& S) { return S * S.transpose(); }
Extended square(const Extended& S) { return product(S, S.transpose()); }

/// `updated` for Q: Matrix or Extended.
template <class Wide>
Wide potter(const Wide& Q, const Matrix& M) {
  using T = typename Wide::Scalar;
  using Column = Eigen::Matrix<T, Dynamic, 1>;
  Wide S = inverse_root(Q);
  for (Eigen::Index r = 0; r < M.rows(); ++r) {
    const Column a = S.transpose() * M.row(r).transpose().template cast<T>();
    const T whole = T(1) + a.squaredNorm();
    const Column moved = S * a;
    S.noalias() -= moved * (a / (whole + std::sqrt(whole))).transpose();
  }
  const Wide P = square(S);
  return T(0.5) * (P + P.transpose());
}

/// A network without other parts.
class Unbounded final : public Borders {
 public:
  void refresh(std::vector<Matrix>&) override {}
  double largest(double value) override { return value; }
};

/// Unit of the covariances: what makes a bound of them large or small.
double scale(const Setting& s, const std::vector<Matrix>& seen, Borders& borders) {
  double size = 0.0;
  double information = 0.0;
  for (const Matrix& Sw : s.Sw) size = std::max(size, Sw.cwiseAbs().maxCoeff());
  for (const Matrix& one : seen) information = std::max(information, one.cwiseAbs().maxCoeff());
  size = borders.largest(size);
  information = borders.largest(information);
  return information > 0.0 ? std::max(size, 1.0 / information) : size;
}

void refuse_growth(double grown, int agent) {
  refuse("model", "covariances that grow beyond " + text(grown),
         "a pair (A, C) that is detectable with some margin",
         "equation (5) has no usable solution: " +
             (agent < 0 ? std::string("an agent") : "agent " + std::to_string(agent)) +
             " hardly learns of a mode that does not decay");
}

}  // namespace

Matrix predicted(const Setting& s, std::size_t j, const Matrix& P) {
  const Matrix half = s.A * P;
  const Matrix Pbar = half * s.A.transpose() + s.Sw[j];
  return 0.5 * (Pbar + Pbar.transpose());
}

std::vector<Matrix> fused(const Setting& s, const std::vector<Matrix>& P) {
  std::vector<Matrix> information;
  for (std::size_t j = 0; j < P.size(); ++j) information.push_back(inverse(predicted(s, j, P[j])));
  std::vector<Matrix> Q;
  for (const auto& heard : s.neighbours) {
    Matrix sum = Matrix::Zero(s.states(), s.states());
    for (const int j : heard) sum += information[static_cast<std::size_t>(j)];
    Q.push_back(sum / static_cast<double>(heard.size()));
  }
  return Q;
}

Matrix updated(const Matrix& Q, const Matrix& M) { return potter(Q, M); }
Extended updated(const Extended& Q, const Matrix& M) { return potter(Q, M); }

std::vector<Matrix> sweep(const Setting& s, const std::vector<Matrix>& P) {
  std::vector<Matrix> next = fused(s, P);
  for (std::size_t i = 0; i < next.size(); ++i) next[i] = updated(next[i], s.M[i]);
  return next;
}

std::vector<Matrix> measured(const Setting& s) {
  std::vector<Matrix> all;
  for (const Matrix& M : s.M) all.push_back(M.transpose() * M);
  return all;
}

bool settle(const Setting& s, const std::vector<Matrix>& seen, double tolerance, int most, Borders& borders,
            SteadyState& out) {
  const double grown = kGrown * scale(s, seen, borders);
  double best = kInfinity;
  int since_best = 0;
  for (int k = 0; k < most; ++k) {
    ++out.sweeps;
    require_time("the sweeps of (5)");
    std::vector<Matrix> next = sweep(s, out.P);
    borders.refresh(next);
    out.change = 0.0;
    int beyond = -1;
    for (std::size_t i = 0; i < next.size(); ++i) {
      const double size = next[i].cwiseAbs().maxCoeff();
      if (!(size <= grown) && beyond < 0) beyond = static_cast<int>(i);
      out.change = std::max(out.change, (next[i] - out.P[i]).cwiseAbs().maxCoeff() / size);
    }
    if (borders.largest(beyond < 0 ? 0.0 : 1.0) > 0.0) refuse_growth(grown, beyond);
    out.change = borders.largest(out.change);
    out.P = std::move(next);
    since_best = out.change < best ? 0 : since_best + 1;
    best = std::min(best, out.change);
    if (out.change < tolerance || (since_best >= kPatience && best < kSmallChange)) return true;
  }
  return false;
}
bool settle(const Setting& s, const std::vector<Matrix>& seen, double tolerance, int most, SteadyState& out) {
  Unbounded whole;
  return settle(s, seen, tolerance, most, whole, out);
}

}  // namespace garrison::rdkf
