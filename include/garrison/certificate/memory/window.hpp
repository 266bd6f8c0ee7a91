// SPDX-License-Identifier: Apache-2.0
// The measurements of several steps as one regression: what the certificates with memory read. Definitions
// and proofs: docs/certificates.md, section 8.
#pragma once

#include <span>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::certificate {

/// How a row of the regression may be wrong, honest as it is.
enum class RowNoise : char {
  gaussian,  ///< N(0, 1), and at most `bias` on top of it
  bounded,   ///< at most `bias`
  set,       ///< one of the n rows of a set prior: their errors together are at most prior_length() long
};

/// z = N theta + o + noise with theta = (x(0), w~(0), .., w~(steps-2)), where x(k+1) = A_k x(k) + u_k + Gam_k
/// w~(k), and x(steps-1) = E theta + o is what is asked for. Every row is divided by its standard deviation
/// and has a source, which is attacked or honest as a whole; process noise and prior are rows of source -1,
/// always honest. Write `begin`, a prior, then for k = 0..steps-1 the rows of step k and `advance` to the
/// next. Sized once; nothing but the constructor allocates.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class GARRISON_EXPORT Window {
 public:
  /// For at most `steps` steps of a state of `states` numbers, `noise` >= 0 numbers of process noise per
  /// step, and at most `capacity` measurements of sources 0..sources-1. @throws InvalidInput
  Window(int states, int noise, int steps, int sources, int capacity);

  /// An empty window of 1..capacity steps. w~ ~ N(0, I), or |w~_i| <= process_bound where that is given (>
  /// 0).
  /// @throws InvalidInput
  void begin(int steps, double process_bound = kNaN);
  /// x(0) - c0 ~ N(0, P0), independent of the noise. c0: n; P0: n x n, positive definite. At most one prior,
  /// right after `begin`. @throws InvalidInput
  void prior_gaussian(const VectorRef& c0, const MatrixRef& P0);
  /// (x(0) - c0)' P0^-1 (x(0) - c0) <= r0^2, for certain. `weight` > 0: as how many standard deviations r0
  /// counts (4: like noise at its quantile; 15..30 when a region is carried on step by step).
  /// @throws InvalidInput
  void prior_set(const VectorRef& c0, const MatrixRef& P0, double r0, double weight = 4.0);

  /// A measurement y = c x + v of the present step: c has `states` numbers, v ~ N(0, variance) and at most
  /// `bias` on top; |v| <= bias alone when `bounded`. False, and left out, when it says nothing: not finite,
  /// c = 0, variance not positive, bias negative, no such source, or full. A row left out does not count as
  /// attacked.
  bool add(int source, std::span<const double> c, double y, double variance, double bias = 0.0,
           bool bounded = false) noexcept;
  /// To the next step. A: n x n; Gam: n x noise; u: n, a known input. Numbers that are not finite leave a
  /// window that answers nothing. @throws InvalidInput beyond the last step, or for other shapes
  void advance(const MatrixRef& A, const MatrixRef& Gam, const VectorRef& u);

  int states() const { return static_cast<int>(X_.rows()); }
  int sources() const { return sources_; }
  int most_steps() const { return most_steps_; }
  int most_unknowns() const { return static_cast<int>(N_.rows()); }
  int most_rows() const { return static_cast<int>(N_.cols()); }
  int steps() const { return steps_; }
  int step() const { return step_; }          ///< the present one, 0..steps-1
  int unknowns() const { return unknowns_; }  ///< numbers in theta
  int rows() const { return rows_; }

  /// Of row r: N as a column, z, source (-1: honest), step (-1: process noise), bound of the bias, kind.
  auto N(int r) const { return N_.col(r).head(unknowns_); }
  double z(int r) const { return z_(r); }
  int source(int r) const { return source_[static_cast<std::size_t>(r)]; }
  int step_of(int r) const { return step_of_[static_cast<std::size_t>(r)]; }
  double bias(int r) const { return bias_(r); }
  RowNoise noise(int r) const { return noise_[static_cast<std::size_t>(r)]; }
  /// Bound on the length of the errors of a set prior; 0 without one.
  double prior_length() const { return prior_length_; }
  /// The present state: x = E theta + o. E: n x unknowns.
  auto E() const { return X_.leftCols(unknowns_); }
  const Vector& o() const { return o_; }

 private:
  void prior(const VectorRef& c0, const MatrixRef& P0, double scale, RowNoise kind);
  void append(double z, int source, int step, double bias, RowNoise noise) noexcept;

  Matrix N_;  // most unknowns x most rows
  Vector z_, bias_;
  std::vector<int> source_, step_of_;
  std::vector<RowNoise> noise_;
  Matrix X_, X_room_;  // n x most unknowns
  Vector o_, o_room_;
  Matrix P_room_;  // n x n
  int noise_inputs_, sources_, most_steps_;
  int steps_ = 1, step_ = 0, unknowns_ = 0, rows_ = 0;
  double prior_length_ = 0.0;
  bool has_prior_ = false;
};

/// Gam of Window::advance, n x noise, for process noise of a covariance: Gam Gam' = Q, without directions in
/// which there is none (up to rounding where all variances are scaled to 1, since states have units).
/// @throws InvalidInput for what is no covariance
GARRISON_EXPORT Matrix noise_root(const MatrixRef& Q);

}  // namespace garrison::certificate
