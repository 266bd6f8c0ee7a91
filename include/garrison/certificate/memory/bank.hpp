// SPDX-License-Identifier: Apache-2.0
// Bank of filters (B): one Kalman filter per set of s sources left out. Infinite window, constant memory;
// needs an attacked set that never changes (S-fixed).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "garrison/certificate/memory/dependence.hpp"
#include "garrison/certificate/memory/free_directions.hpp"
#include "garrison/certificate/memory/levels.hpp"
#include "garrison/core/error.hpp"

namespace garrison::certificate {
namespace detail {
class ShapeFrame;
}

/// Outputs of one source: y = C x + v, v_i ~ N(0, R_i), independent (decorrelate them first).
struct BankSource {
  Matrix C;  ///< outputs x n
  Vector R;  ///< variances > 0
};

/// One member: its error is g + Psi d0 + free d, g ~ N(0, P), |d0| <= 1, d anything.
struct BankMember {
  Vector c;
  Matrix P, Psi;              ///< n x n; Psi has no columns after an unknown start
  std::vector<int> left_out;  ///< sources, ascending
  std::vector<int> accused;   ///< those of them that are attacked if this member is right: fewer once merged
  detail::FreeDirections free{};
  int number = 0;  ///< of its set, in lexicographic order
  Matrix heard{};  ///< what is kept of the innovations of each output, in standard deviations

  /// What changes from step to step, in a bank that nothing was merged in.
  template <class V>
  void visit(V& v) {
    v("c", c);
    v("P", P);
    v("Psi", Psi);
    v("free", free);
    v("number", number);
    v("heard", heard);
  }
};

/// What a step may change; null pointers keep the design's.
struct BankStep {
  const Matrix* A = nullptr;                         ///< n x n
  const Vector* u = nullptr;                         ///< n, known input
  const Matrix* Q = nullptr;                         ///< n x n
  const std::vector<BankSource>* sources = nullptr;  ///< of the same sizes
  bool predict = true;    ///< false: the rows belong to the same time as those before
  bool ellipsoid = true;  ///< false: box and ball alone, in a fraction of the time
};

/// Movable.
/// Threads: one at a time.
class GARRISON_EXPORT Bank {
 public:
  /// A, Q: n x n, Q positive semidefinite; at most `limit` members, C(sources, s) are needed. No start: every
  /// update answers "not enough rows" until one of the starts. @throws InvalidInput
  Bank(const MatrixRef& A, const MatrixRef& Q, const std::vector<BankSource>& sources, int s,
       int limit = 5000);
  ~Bank();
  Bank(Bank&&) noexcept;
  Bank& operator=(Bank&&) noexcept;

  /// All members anew: x - c0 ~ N(0, P0). @throws InvalidInput
  void start_gaussian(const VectorRef& c0, const MatrixRef& P0);
  /// All members anew from a region that contains x: its ellipsoid, or its ball. It may depend on all data so
  /// far: later noise is fresh. Sources attacked SINCE then must be at most s in total. @throws InvalidInput
  void restart(const Region& region);
  /// All members anew, with nothing known of x: no bound before the rows of every living member, over the
  /// steps, have determined it. Rows that do are no test. The time may depend on all data so far.
  void start_unknown();
  /// The same of a bank that began so; does not allocate. everything: also what speaks against white noise.
  void forget(bool everything = false) noexcept;

  /// Theorem B. y: outputs of all sources one below the other, NaN = missing. A member whose innovation is
  /// not noise dies; the region encloses those that live; a source that all of them accuse is proved (with at
  /// least 2s sources; no honest one except with twice the probability below); refuted when none lives (then
  /// restart, from the last region carried on by Propagation). Fails with probability <= rows P(|N| > z1) +
  /// delta(z2) + n P(|N| > zc) per step; over a run the tests add up. Does not allocate, cannot fail. Expects
  /// sizes as designed, levels >= 0. O(members (rows + n) n^2).
  const WindowWitness& update(const VectorRef& y, const WindowLevels& z, const BankStep& step = {}) noexcept;
  /// Checked. @throws InvalidInput
  const WindowWitness& checked_update(const VectorRef& y, const WindowLevels& z, const BankStep& step = {});

  /// Fewer members where their number costs too much: two living ones become one that leaves out both their
  /// sources and starts from an ellipsoid around both, until at most `most` >= 1 live; of each, with the one
  /// that adds fewest sources, and of those the nearest. Sound, and fails with delta(z2) more each time; the
  /// merged member knows less from now on, and answers only where the remaining sources detect. Allocates.
  /// @throws InvalidInput for most < 1 and levels out of range
  void merge(int most, const WindowLevels& z);

  int states() const { return static_cast<int>(A_.rows()); }
  int outputs() const { return outputs_; }
  /// What the innovations of all living members say against white noise, since the first start; where one of
  /// them does not say it, the sources that it leaves out may be the liars. Exact from an unknown or a
  /// Gaussian start; where a set prior is felt, nothing is compared.
  Dependence dependence() const noexcept;
  /// The living members.
  std::span<const BankMember> members() const { return {members_.data(), alive_}; }
  /// Whether some number of a living member is too large to go on with: an unstable plant, left alone.
  bool overflows() const noexcept;

  /// What lasts from step to step, of a bank that began with start_unknown and merged nothing. After reading:
  bool resume() noexcept;  ///< false where that cannot be worked with
  template <class V>
  void visit(V& v) {
    v.range("alive", alive_, 0, static_cast<std::int64_t>(members_.size()));
    v("past", past_);
    for (BankMember& member : members_) v("member", member);
  }

 private:
  bool advance(BankMember& member, const VectorRef& y, const WindowLevels& z, const BankStep& step) noexcept;
  bool take(BankMember& member, Eigen::Index row, double R, double y, double z1) noexcept;
  void leave_out(BankMember& member) const noexcept;
  void move(BankMember& member, double innovation, double variance) noexcept;
  void enclose(const WindowLevels& z, bool ellipsoid) noexcept;
  void hull(const WindowLevels& z) noexcept;
  void enclose_by_ellipsoid(const WindowLevels& z) noexcept;
  double ball(const WindowLevels& z) noexcept;
  void prove() noexcept;
  void all_members(const VectorRef& c0, const MatrixRef& P, const MatrixRef& Psi);

  Matrix A_, Q_;
  std::vector<BankSource> sources_;
  int s_, outputs_ = 0;
  bool started_ = false;
  std::vector<BankMember> members_;  // the first alive_ live
  std::size_t alive_ = 0;
  std::size_t alive_before_ = 0;  // the last update
  PastDependence past_;
  std::vector<std::vector<int>> sets_;  // that members leave out, by their number
  std::unique_ptr<detail::ShapeFrame> frame_;
  std::vector<char> taken_;  // numbers that some member has
  Vector weight_;            // of the coordinates, for free directions
  Matrix room_, shape_, sum_;
  Vector h_, Ph_, k_, Psih_, v_, seen_;
  WindowWitness witness_;
};

/// Theorem B2, design time: what a living member's error never exceeds once the start has decayed, whatever s
/// attackers do: n numbers per coordinate and the 2-norm (last); infinite when (A, C without some 2s sources)
/// is not detectable: then no certificate stays bounded. Every row is taken to arrive in each step. z1:
/// levels of the bank; z2, zc at delta / C(sources, s). @throws InvalidInput, also for more than `limit`
/// pairs of sets
GARRISON_EXPORT Vector bank_steady(const MatrixRef& A, const MatrixRef& Q,
                                   const std::vector<BankSource>& sources, int s, const WindowLevels& z,
                                   int limit = 100000);
/// The same of the half widths (n) of the box around all living members: each reaches zc deviations further.
GARRISON_EXPORT Vector bank_steady_width(const MatrixRef& A, const MatrixRef& Q,
                                         const std::vector<BankSource>& sources, int s, const WindowLevels& z,
                                         int limit = 100000);

}  // namespace garrison::certificate
