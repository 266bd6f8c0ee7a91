// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/steady_state.hpp"

#include "analysis/extended.hpp"
#include "analysis/policy_iteration.hpp"
#include "core/solvers.hpp"
#include "garrison/core/budget.hpp"

namespace garrison::rdkf {
namespace {

using detail::Extended;
using detail::extended;
using detail::inverse_root;
using detail::product;

constexpr double kGrown = 1e14;  // times the largest entry of Sw and of (C'Sv^-1C)^-1
/// Sweeps after which a recursion that still changes is left to Newton's method.
constexpr int kQuickSweeps = 400;
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

/// (Q + M'M)^-1 from a root of Q^-1, row by row of M (Potter): where M is huge, because measurements have
/// hardly any noise, the sum would hold nothing of Q. Q: Matrix or Extended.
template <class Wide>
Wide updated(const Wide& Q, const Matrix& M) {
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

Matrix predicted(const Setting& s, std::size_t j, const Matrix& P) {
  const Matrix half = s.A * P;
  const Matrix Pbar = half * s.A.transpose() + s.Sw[j];
  return 0.5 * (Pbar + Pbar.transpose());
}

/// (1/d_i) sum over N_i of Pbar_j^-1 for every agent.
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

std::vector<Matrix> sweep(const Setting& s, const std::vector<Matrix>& P) {
  std::vector<Matrix> next = fused(s, P);
  for (std::size_t i = 0; i < next.size(); ++i) next[i] = updated(next[i], s.M[i]);
  return next;
}

/// C_i' Sv_i^-1 C_i
std::vector<Matrix> measured(const Setting& s) {
  std::vector<Matrix> all;
  for (const Matrix& M : s.M) all.push_back(M.transpose() * M);
  return all;
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

/// Sweeps until the change is below `tolerance`, or where rounding keeps it; false: still changing after
/// `most`.
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

/// (5) for Newton's method. The best policy at P weighs neighbour j by L_ij = P_i Pbar_j^-1 / d_i, P_i from
/// (5).
class Fusion : public detail::RiccatiMap {
 public:
  explicit Fusion(const Setting& s) : s_(s) {}

  detail::Matrices residual(const detail::Matrices& P) override {
    const Extended A = extended(s_.A);
    std::vector<Extended> information;
    for (std::size_t j = 0; j < P.size(); ++j) {
      const Extended prior = detail::congruence(A, extended(P[j])) + extended(s_.Sw[j]);
      information.push_back(square(inverse_root(prior)));
    }
    weights_.assign(P.size(), {});
    detail::Matrices r;
    for (std::size_t i = 0; i < P.size(); ++i) {
      const auto& heard = s_.neighbours[i];
      Extended sum = Extended::Zero(s_.A.rows(), s_.A.cols());
      for (const int j : heard) sum += information[static_cast<std::size_t>(j)];
      sum /= static_cast<long double>(heard.size());
      const Extended next = updated(sum, s_.M[i]);
      r.push_back((next - extended(P[i])).cast<double>());
      const long double root = std::sqrt(static_cast<long double>(heard.size()));
      for (const int j : heard) {
        const Extended weight = product(product(next, information[static_cast<std::size_t>(j)]), A);
        weights_[i].push_back((weight / root).cast<double>());
      }
    }
    return r;
  }

  detail::Matrices apply(const detail::Matrices& D) const override {
    detail::Matrices all;
    for (std::size_t i = 0; i < D.size(); ++i) {
      Matrix sum = Matrix::Zero(s_.A.rows(), s_.A.cols());
      for (std::size_t k = 0; k < weights_[i].size(); ++k)
        sum += weights_[i][k] * D[static_cast<std::size_t>(s_.neighbours[i][k])] * weights_[i][k].transpose();
      all.push_back(std::move(sum));
    }
    return all;
  }

 private:
  const Setting& s_;
  std::vector<std::vector<Matrix>> weights_;  // sqrt(d_i) L_ij A, in the order of N_i
};

/// What n samples of all sensors tell of the state, without process noise.
Matrix information(const Matrix& A, const std::vector<Matrix>& seen) {
  Matrix all = Matrix::Zero(A.rows(), A.cols());
  for (const Matrix& one : seen) all += one;
  Matrix O = all;
  for (Eigen::Index k = 1; k < A.rows(); ++k) O = all + A.transpose() * O * A;
  return O;
}

/// Units of the states, powers of 2, in which they are seen about equally well; 1 for states nobody sees.
Vector units(const Setting& s) {
  return information(s.A, measured(s)).diagonal().unaryExpr([](double seen) {
    return seen > 0.0 ? std::exp2(-std::round(0.5 * std::log2(seen))) : 1.0;
  });
}

/// The same problem for the states x / unit.
Setting in_units(const Setting& s, const Vector& unit) {
  const Vector back = unit.cwiseInverse();
  Setting own = s;
  own.A = back.asDiagonal() * s.A * unit.asDiagonal();
  for (Matrix& C : own.C) C = C * unit.asDiagonal();
  for (Matrix& M : own.M) M = M * unit.asDiagonal();
  for (Matrix& Sw : own.Sw) Sw = back.asDiagonal() * Sw * back.asDiagonal();
  return own;
}

/// Process noise that excites every seen mode about as strongly as it is seen, and none less than Sw does:
/// with it no mode is slow to settle. `s`: in `units`.
Matrix even_noise(const Setting& s, const std::vector<Matrix>& seen) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information(s.A, seen));
  constexpr double kLeast = 1e-12;  // times the largest; below it rounding decides
  const double least = kLeast * eigen.eigenvalues().maxCoeff();
  const Vector inverse = eigen.eigenvalues().unaryExpr([&](double v) { return 1.0 / std::max(v, least); });
  const Matrix shape = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  double most = 1.0;
  for (const Matrix& Sw : s.Sw)
    most = std::max(most, Sw.diagonal().cwiseQuotient(shape.diagonal()).maxCoeff());
  return most * shape;
}

std::vector<Matrix> noisier(const Setting& s, double more, const Matrix& even) {
  std::vector<Matrix> all;
  for (const Matrix& Sw : s.Sw) all.push_back(Sw + more * (Sw + even));
  return all;
}

/// Times `even` at which every state has about the noise of Sw alone.
double own_noise(const Setting& s, const Matrix& even) {
  double least = 1.0;
  for (const Matrix& Sw : s.Sw)
    least = std::min(least, Sw.diagonal().cwiseQuotient(even.diagonal()).minCoeff());
  return least;
}

/// Newton's method on (5). The solution for more process noise is an upper bound, as it needs one to start
/// from; with enough noise the sweeps settle quickly. From there the noise falls step by step, so that an
/// upper bound is never so much larger than the solution that rounding hides what is well known.
bool newton(const Setting& given, SteadyState& out) {
  constexpr double kFall = 1e-4;
  const Vector unit = units(given);
  const Setting s = in_units(given, unit);
  const std::vector<Matrix> seen = measured(s);
  const Matrix even = even_noise(s, seen);
  const double own = own_noise(s, even);
  Setting noisy = s;
  SteadyState rough;
  double more = 1.0;
  for (bool settled = false; !settled; out.sweeps += rough.sweeps) {
    more *= 1e2;
    if (more > 1e20) return false;
    rough = {};
    rough.P.assign(s.C.size(), Matrix::Zero(s.A.rows(), s.A.cols()));
    noisy.Sw = noisier(s, more, even);
    settled = settle(noisy, seen, 1e-6, kQuickSweeps, rough);
  }
  std::vector<Matrix> P = std::move(rough.P);
  while (more > 0.0) {
    more = more > own ? more * kFall : 0.0;
    noisy.Sw = noisier(s, more, even);
    for (Matrix& one : P) one *= 1.01;
    Fusion fusion(noisy);
    auto found = detail::policy_iteration(fusion, std::move(P));
    out.sweeps += found.steps;
    if (!found.converged) return false;
    P = std::move(found.P);
    out.change = found.change;
  }
  for (std::size_t i = 0; i < P.size(); ++i) out.P[i] = unit.asDiagonal() * P[i] * unit.asDiagonal();
  return true;
}

/// The rest of the way from a P near the solution, where modes need more samples than there were sweeps:
/// Newton's method in units in which the diagonal of P is about 1, so that no state is lost in the rounding
/// of another. Its start need not be an upper bound, but only so good that the gains at it are stable.
bool finish(const Setting& given, SteadyState& out) {
  Vector largest = Vector::Zero(given.A.rows());
  for (const Matrix& P : out.P) largest = largest.cwiseMax(P.diagonal());
  if (!(largest.minCoeff() > 0.0)) return false;
  const Vector unit =
      largest.unaryExpr([](double variance) { return std::exp2(std::round(0.5 * std::log2(variance))); });
  const Setting s = in_units(given, unit);
  const Vector back = unit.cwiseInverse();
  std::vector<Matrix> P;
  for (const Matrix& one : out.P) P.push_back(1.01 * (back.asDiagonal() * one * back.asDiagonal()));
  Fusion fusion(s);
  const auto found = detail::policy_iteration(fusion, std::move(P));
  out.sweeps += found.steps;
  if (!found.converged) return false;
  for (const Matrix& one : found.P)
    if (Eigen::LLT<Matrix>(one).info() != Eigen::Success) return false;
  for (std::size_t i = 0; i < found.P.size(); ++i)
    out.P[i] = unit.asDiagonal() * found.P[i] * unit.asDiagonal();
  out.change = found.change;
  return true;
}

void require_start(const Setting& s, const std::vector<Matrix>& P) {
  if (static_cast<int>(P.size()) != s.agents())
    refuse("P", std::to_string(P.size()) + " matrices", std::to_string(s.agents()) + ", one per agent");
  for (std::size_t i = 0; i < P.size(); ++i)
    if (P[i].rows() != s.states() || P[i].cols() != s.states() || !P[i].allFinite())
      refuse("P[" + std::to_string(i) + "]",
             std::to_string(P[i].rows()) + " x " + std::to_string(P[i].cols()) + " or not finite",
             "a finite positive semidefinite matrix, as many rows as states");
}

/// Solves (5) for out.P.
void solve(const Setting& s, const std::vector<Matrix>& seen, const SteadyOptions& options,
           SteadyState& out) {
  const int quick = std::min(kQuickSweeps, options.most_sweeps);
  if (options.borders != nullptr) {
    if (settle(s, seen, options.tolerance, quick, *options.borders, out)) return;
    refuse("model", "covariances that still change after " + std::to_string(out.sweeps) + " sweeps",
           "a pair (A, C) with which they settle",
           "Newton's method, which such plants need, is for networks that one process holds");
  }
  if (settle(s, seen, options.tolerance, quick, out) || newton(s, out) ||
      settle(s, seen, options.tolerance, options.most_sweeps - out.sweeps, out) || finish(s, out))
    return;
  refuse("model",
         "covariances that still change by " + text(out.change) + " after " + std::to_string(out.sweeps) +
             " sweeps",
         "a pair (A, C) that is detectable with some margin within so many samples, and process noise of at "
         "least about 1e-14 of what the measurements tell",
         "take a longer period where states integrate each other, raise process_covariance where it is "
         "small, or leave out what is hardly seen");
}

}  // namespace

std::vector<Matrix> riccati_sweep(const Setting& s, const std::vector<Matrix>& P) {
  require_start(s, P);
  return sweep(s, P);
}

SteadyState steady_state(const Setting& s, const SteadyOptions& options) {
  const auto n = s.states();
  const std::vector<Matrix> seen = measured(s);
  SteadyState out;
  out.P = options.start.empty() ? std::vector<Matrix>(s.C.size(), Matrix::Zero(n, n)) : options.start;
  require_start(s, out.P);
  solve(s, seen, options, out);
  for (std::size_t j = 0; j < s.C.size(); ++j) out.Pbar.push_back(predicted(s, j, out.P[j]));
  out.Q = fused(s, out.P);
  return out;
}

}  // namespace garrison::rdkf
