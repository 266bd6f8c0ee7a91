// SPDX-License-Identifier: Apache-2.0
// One agent's certificate, beside its filter: the same for all families, engines and nodes.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "garrison/certificate/online/doubts.hpp"
#include "garrison/certificate/online/evidence.hpp"
#include "garrison/core/certificate_kind.hpp"
#include "garrison/core/error.hpp"

namespace garrison::wire {
class Archive;
}

namespace garrison::certificate {

struct Plan;

/// What lasts of regions from sample to sample.
struct Memory {
  std::int64_t t = 0;
  // The own witness (W) of sample t; radius infinity = too few rows, NaN = refuted.
  std::vector<double> center, box;
  double radius = kInfinity;
  // The ball to relay (R): its centre moved to t, its radius when it was new; age -1 = none.
  std::vector<double> ball;
  double ball_radius = kNaN;
  int age = -1;
  int fresh = 0;  // see Evidence

  template <class V>
  void visit(V& v) {
    v("t", t);
    v("center", center);
    v("box", box);
    v("radius", radius);
    v("ball", ball);
    v("ball_radius", ball_radius);
    v.range("age", age, -1, kMostAge);
    v.range("fresh", fresh, 0, kMostAge);
  }
};

/// A pure state machine, like a filter: `begin` with the measurement, then per round `say`, `hear` what
/// arrived, `end_round`. Behind a table of functions, so that a node without certificates links none of it.
/// Nothing is allocated after construction.
/// Threads: one at a time.
class Certifier {
 public:
  virtual ~Certifier() = default;
  /// Starts anew at the end of sample t: nothing is known.
  virtual void reset(std::int64_t t) noexcept = 0;
  /// Sample t, later than the last one by any number; y: own outputs, anything but finite numbers = missing.
  /// x: the estimate in the first message (`sensed` of core/filter.hpp); null = there is none.
  virtual void begin(std::int64_t t, const double* y, const double* x) noexcept = 0;
  /// What to send in this round; shape_evidence sized `out`.
  virtual void say(int round, Evidence& out) const noexcept = 0;
  /// Whether what is said in this round is said by no bytes.
  virtual bool spares(int round, const Evidence& said) const noexcept = 0;
  virtual void hear(int round, int sender, const Evidence& in) noexcept = 0;
  /// In the first round, of a sender that has put nothing behind this estimate.
  virtual void hear_estimate(int sender, const double* x) noexcept = 0;
  /// Whether that says something.
  virtual bool derives(int sender) const noexcept = 0;
  virtual void end_round(int round) noexcept = 0;
  /// After what was heard of a sample in which the agent took no part.
  virtual void end_sample() noexcept = 0;
  /// Bound on the error of any estimate (n numbers) of the present sample.
  virtual Bound bound(std::span<const double> estimate) const noexcept = 0;
  /// The same per coordinate, n numbers to `out`: |estimate_k - x_k| <= out_k. Infinite where there is none.
  virtual void box(std::span<const double> estimate, std::span<double> out) const noexcept = 0;
  /// Whether the family's own bound holds for as many attacked sources.
  virtual bool counts_family() const noexcept = 0;
  /// Sizes what `sender` sends; allocates the first time.
  virtual void shape_evidence(int sender, Evidence& out) const = 0;
  /// Sources (Plan::source) that are shown to be attacked, ascending: none without a bank. Wrong with at most
  /// `failure`, where the attacked are always the same.
  virtual std::span<const int> proved() const noexcept = 0;
  /// What speaks against the assumptions of the bank: nothing without one.
  virtual Doubts doubts() const noexcept = 0;
  /// Lists what lasts from sample to sample.
  virtual void visit(wire::Archive& archive) = 0;
  /// Goes on from what was read, of sample t; false where that cannot be worked with.
  virtual bool resume(std::int64_t t) noexcept = 0;
};

/// The better of a family's own bound, of the kind that it says (none = published), and the certificate's. A
/// refutation leaves neither; nor does a certificate for more attacked sources leave the family's.
inline Bound least(double family, CertificateKind kind, const Certifier* certifier,
                   std::span<const double> estimate) noexcept {
  const bool has = family < kInfinity && (certifier == nullptr || certifier->counts_family());
  if (kind == CertificateKind::none) kind = CertificateKind::published;
  const Bound own{family, has ? kind : CertificateKind::none};
  if (certifier == nullptr) return own;
  const Bound found = certifier->bound(estimate);
  return has && found.kind != CertificateKind::refuted && !(found.value < family) ? own : found;
}

/// Per coordinate what a bound of any kind and the certificate say, n numbers: at most the bound; as the
/// bound where that is none.
inline void least_box(double bound, const Certifier* certifier, std::span<const double> estimate,
                      std::span<double> out) noexcept {
  if (certifier == nullptr || !(bound < kInfinity)) {
    for (double& one : out) one = bound;
    return;
  }
  certifier->box(estimate, out);
  for (double& one : out) one = one < bound ? one : bound;
}

/// The certifier of agent `id`, whose messages take `rounds` rounds per sample. @throws InvalidInput when it
/// would take more than 1e8 numbers
GARRISON_EXPORT std::unique_ptr<Certifier> make_certifier(std::shared_ptr<const Plan> plan, int id,
                                                          std::span<const int> neighbours, int rounds);

}  // namespace garrison::certificate
