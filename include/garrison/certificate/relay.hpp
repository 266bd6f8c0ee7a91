// SPDX-License-Identifier: Apache-2.0
// Relay rules (R): bounds that messages carry, through averaging, prediction and choice. Any losses, any
// delays, any weights; the senders are honest unless order_rule is used on top.
#pragma once

#include "garrison/certificate/region.hpp"
#include "garrison/core/error.hpp"

namespace garrison::certificate {

/// A message of a round: its estimate and the bound on that estimate's error, infinity or NaN = none known.
/// x_new = sum of weight_k x_k over the messages that ARRIVED, own included, weights of any sign with sum 1:
/// region with center x_new and radius min(sum |weight_k| b_k, min_k ||x_new - x_k|| + b_k).
/// weights: q >= 1, sum 1 to 1e-9; estimates: n x q, one per column, finite; bounds: q, >= 0.
/// @throws InvalidInput
GARRISON_EXPORT Region averaged(const VectorRef& weights, const MatrixRef& estimates,
                                const VectorRef& bounds);

/// min(sum |weight_k| b_k, min_k distance_k + b_k) step by step, without allocating: add every message that
/// arrived, then ask.
/// Threads: one at a time.
class RelayedBound {
 public:
  /// `distance`: ||x_new - x_k||; `bound`: b_k, infinity or NaN = none.
  void add(double weight, double distance, double bound) {
    if (std::isnan(bound)) bound = kInfinity;
    if (weight != 0.0) sum_ += std::abs(weight) * bound;
    least_ = std::fmin(least_, distance + bound);
  }
  double value() const { return std::fmin(sum_, least_); }

 private:
  double sum_ = 0.0;
  double least_ = kInfinity;
};

/// Bound after predicting and injecting a known innovation: norm_A b + bw + |kappa|. All but kappa >= 0.
/// @throws InvalidInput
GARRISON_EXPORT double after_injection(double norm_A, double b, double bw, double kappa);

/// The better of two regions that both contain x: the smaller radius; `other` when `one` has no answer.
inline const Region& better(const Region& one, const Region& other) {
  return one.radius <= other.radius || !other.answered() ? one : other;
}

}  // namespace garrison::certificate
