// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/relay.hpp"

#include <cmath>

#include "require.hpp"

namespace garrison::certificate {

Region averaged(const VectorRef& weights, const MatrixRef& estimates, const VectorRef& bounds) {
  const Eigen::Index q = weights.size();
  if (q < 1 || estimates.rows() < 1)
    refuse("estimates", detail::shape(estimates), "at least one estimate of one number");
  detail::require_shape("weights", weights, q, 1);
  detail::require_shape("estimates", estimates, estimates.rows(), q);
  if (bounds.size() != q) refuse("bounds", std::to_string(bounds.size()), amount(q, "number"));
  if (!(std::abs(weights.sum() - 1.0) <= 1e-9 * (1.0 + weights.cwiseAbs().sum())))
    refuse("weights", "sum " + text(weights.sum()), "sum 1");
  for (const double b : bounds)
    if (b < 0.0) refuse("bounds", text(b), "numbers >= 0, infinity or NaN = none");
  Region region{estimates * weights, kInfinity, {}};
  RelayedBound bound;
  for (Eigen::Index k = 0; k < q; ++k)
    bound.add(weights(k), (region.center - estimates.col(k)).norm(), bounds(k));
  region.radius = bound.value();
  return region;
}

double after_injection(double norm_A, double b, double bw, double kappa) {
  detail::require_least("norm_A", norm_A, 0.0);
  detail::require_least("b", b, 0.0);
  detail::require_least("bw", bw, 0.0);
  if (!(std::abs(kappa) <= kHuge)) refuse("kappa", text(kappa), "a finite number");
  return norm_A * b + bw + std::abs(kappa);
}

}  // namespace garrison::certificate
