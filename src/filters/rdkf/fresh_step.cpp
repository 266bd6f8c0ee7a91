// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/fresh_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace garrison::rdkf {
namespace {

/// Relative error of the optimality conditions up to which a solution is accepted.
constexpr double kAccepted = 1e-13;
/// A pivot below this share of its diagonal entry is rounding of zero.
constexpr double kPivot = 1e-13;

/// Cholesky elimination of the first `pivots` of `size` columns of a symmetric matrix, in place: lower
/// triangle and zeros around it, `height` (a multiple of kGroup) doubles a column. What is left of the other
/// columns is the Schur complement. False at a pivot that is not positive.
template <int B>
GARRISON_INLINE bool eliminate(double* a, int height, int size, int pivots) {
  using L = Lanes<B>;
  for (int j = 0; j < size; ++j) {
    double* const column = a + j * height;
    const double diagonal = column[j];
    const int before = std::min(j, pivots);
    for (int r = j / kGroup * kGroup; r < height; r += kGroup) {
      L even = L::all(0.0);
      L odd = L::all(0.0);
      int k = 0;
      for (; k + 1 < before; k += 2) {
        even.add(L::at(a + k * height + r), L::all(a[k * height + j]));
        odd.add(L::at(a + (k + 1) * height + r), L::all(a[(k + 1) * height + j]));
      }
      if (k < before) even.add(L::at(a + k * height + r), L::all(a[k * height + j]));
      L rest = L::at(column + r);
      for (int p = 0; p < L::parts; ++p) rest.part[p] -= even.part[p] + odd.part[p];
      rest.to(column + r);
    }
    if (j >= pivots) continue;
    if (!(column[j] > kPivot * diagonal)) return false;
    for (int i = j / kGroup * kGroup; i < j; ++i) column[i] = 0.0;
    const L inverse = L::all(1.0 / std::sqrt(column[j]));
    for (int r = j / kGroup * kGroup; r < height; r += kGroup) {
      L scaled = L::at(column + r);
      for (int p = 0; p < L::parts; ++p) scaled.part[p] *= inverse.part[p];
      scaled.to(column + r);
    }
  }
  return true;
}

template <int B>
GARRISON_INLINE double dot(const double* x, const double* y, int height, int first = 0) {
  using L = Lanes<B>;
  L sum = L::all(0.0);
  for (int r = first / kGroup * kGroup; r < height; r += kGroup) sum.add(L::at(x + r), L::at(y + r));
  return sum.sum();
}

/// y += factor x
template <int B>
GARRISON_INLINE void add(double factor, const double* x, double* y, int height, int first = 0) {
  using L = Lanes<B>;
  const L all = L::all(factor);
  for (int r = first / kGroup * kGroup; r < height; r += kGroup) {
    L sum = L::at(y + r);
    sum.add(all, L::at(x + r));
    sum.to(y + r);
  }
}

/// out = L^-1 v, for the factor of `size` columns.
template <int B>
GARRISON_INLINE void forward(const double* factor, int height, int size, const double* v, double* out) {
  std::copy_n(v, height, out);
  for (int k = 0; k < size; ++k) {
    const double* const column = factor + k * height;
    const double w = out[k] / column[k];
    add<B>(-w, column, out, height, k);
    out[k] = w;
  }
}

/// out = L^-T right
template <int B>
GARRISON_INLINE void backward(const double* factor, int height, int size, const double* right, double* out) {
  std::fill_n(out, height, 0.0);
  for (int k = size; k-- > 0;) {
    const double* const column = factor + k * height;
    out[k] = (right[k] - dot<B>(column, out, height, k)) / column[k];
  }
}

/// One problem and the room that it needs; q x q matrices are `high` numbers a column, K is `tall`.
struct Fresh {
  int n, q, tall, high;
  Aligned<double> room;
  double *K, *D, *F, *r, *u, *w, *v, *z;

  Fresh(Eigen::Index states, Eigen::Index outputs)
      : n(static_cast<int>(states)),
        q(static_cast<int>(outputs)),
        tall(padded(states + outputs)),
        high(padded(outputs)),
        room(static_cast<std::size_t>(tall * (n + q + 1) + high * (2 * q + 4)), 0.0) {
    K = room.data();
    z = K + tall * (n + q);
    D = z + tall;
    F = D + high * q;
    r = F + high * q;
    u = r + high;
    w = u + high;
    v = w + high;
  }
};

/// [Q .; M 0] without its first n columns is -M Q^-1 M' = -2 D; the n columns stay as [L; M L^-T].
template <int B>
GARRISON_INLINE bool reduce(Fresh& f, const MatrixRef& Q, const MatrixRef& M, Penalty penalty) {
  for (int k = 0; k < f.n; ++k) {
    double* const column = f.K + k * f.tall;
    std::copy_n(Q.col(k).data() + k, f.n - k, column + k);
    std::copy_n(M.col(k).data(), f.q, column + f.n);
  }
  if (!eliminate<B>(f.K, f.tall, f.n + f.q, f.n)) return false;
  for (int j = 0; j < f.q; ++j)
    for (int i = j; i < f.q; ++i)
      f.D[j * f.high + i] = f.D[i * f.high + j] = -0.5 * f.K[(f.n + j) * f.tall + f.n + i];
  if (penalty == Penalty::huber)
    for (int j = 0; j < f.q; ++j) f.D[j * f.high + j] += 0.5;
  return true;
}

/// u with (D + mu I) u = r and |u| = level, or mu = 0 and |u| <= level. No iterations where D + mu I has no
/// factor.
template <int B>
GARRISON_INLINE Step secular(Fresh& f, double level) {
  const double most = std::sqrt(dot<B>(f.D, f.D, f.high * f.q));  // >= the largest eigenvalue
  Step step{std::max(0.0, std::sqrt(dot<B>(f.r, f.r, f.high)) / level - most), 0};
  while (step.iterations < 100) {
    ++step.iterations;
    std::copy_n(f.D, f.high * f.q, f.F);
    for (int j = 0; j < f.q; ++j) f.F[j * f.high + j] += step.mu;
    if (!eliminate<B>(f.F, f.high, f.q, f.q)) return {kNaN, 0};
    forward<B>(f.F, f.high, f.q, f.r, f.w);
    backward<B>(f.F, f.high, f.q, f.w, f.u);
    const double square = dot<B>(f.u, f.u, f.high);
    const double length = std::sqrt(square);
    if (step.mu == 0.0 && length <= level) break;
    forward<B>(f.F, f.high, f.q, f.u, f.w);
    const double change = (length / level - 1.0) * square / dot<B>(f.w, f.w, f.high);
    if (!(change > step.mu * std::numeric_limits<double>::epsilon())) break;
    step.mu += change;
    if (change > 1e-8 * step.mu) continue;
    // Quadratic convergence: with u moved along its derivative the next iteration would change nothing.
    backward<B>(f.F, f.high, f.q, f.w, f.v);
    add<B>(-change, f.v, f.u, f.high);
    break;
  }
  return step;
}

/// r = mu u + D u and the length of u hold as far as rounding goes. `size`: of what r was made of.
template <int B>
GARRISON_INLINE bool optimal(Fresh& f, const Step& step, double level, double size) {
  std::copy_n(f.r, f.high, f.v);
  add<B>(-step.mu, f.u, f.v, f.high);
  for (int j = 0; j < f.q; ++j) add<B>(-f.u[j], f.D + j * f.high, f.v, f.high);
  const double wrong = std::sqrt(dot<B>(f.v, f.v, f.high));
  const double length = std::sqrt(dot<B>(f.u, f.u, f.high));
  return wrong <= kAccepted * size &&
         (step.mu == 0.0 ? length <= level : std::abs(length - level) <= kAccepted * level);
}

/// x += Q^-1 M' u / 2
template <int B>
GARRISON_INLINE void move(Fresh& f, double scale, double* x) {
  for (int i = 0; i < f.q; ++i) f.z[f.n + i] = -0.5 * scale * f.u[i];
  for (int k = f.n; k-- > 0;) {
    const double* const column = f.K + k * f.tall;
    f.z[k] = -dot<B>(column, f.z, f.tall, k) / column[k];
  }
  for (int k = 0; k < f.n; ++k) x[k] += f.z[k];
}

/// `solved`: x and step are the solution; otherwise x is as it was.
struct Solve {
  template <int B>
  static GARRISON_INLINE void run(const MatrixRef* Q, const MatrixRef* M, Penalty penalty, double lambda,
                                  const double* b, double* x, Step* step, bool* solved) {
    Fresh f(Q->rows(), M->rows());
    *solved = reduce<B>(f, *Q, *M, penalty);
    if (!*solved) return;
    *step = {lambda == 0.0 ? kInfinity : 0.0, 0};
    if (lambda == 0.0) return;
    double largest = 0.0;
    double size = 0.0;
    for (int i = 0; i < f.q; ++i) {
      double Mx = 0.0;
      for (int k = 0; k < f.n; ++k) Mx += (*M)(i, k) * x[k];
      f.r[i] = b[i] - Mx;
      largest = std::max(largest, std::abs(f.r[i]));
      size = std::max({size, std::abs(b[i]), std::abs(Mx)});
    }
    if (largest == 0.0) return;
    for (int i = 0; i < f.q; ++i) f.r[i] /= largest;  // squares of huge entries would overflow
    const double level = lambda / largest;
    *step = secular<B>(f, level);
    *solved = step->iterations > 0 && optimal<B>(f, *step, level, size / largest);
    if (*solved) move<B>(f, largest, x);
  }
};

}  // namespace

Step solve_fresh(const MatrixRef& Q, const MatrixRef& M, Penalty penalty, const Price& price, const double* b,
                 double* x) {
  Step step;
  bool solved = false;
  if (price.smoothing == 0.0)  // else |u| has a part without eigenvalue
    run_widest<Solve>(&Q, &M, penalty, price.lambda, b, x, &step, &solved);
  if (solved) return step;
  // Also tells a Q that is not positive definite from one that is so only just.
  const StepFactors factors = step_factors(Matrix::Identity(M.rows(), M.rows()), M, Q, penalty);
  Aligned<double> room(factors.room());
  return solve(factors, price, b, x, room.data());
}

}  // namespace garrison::rdkf
