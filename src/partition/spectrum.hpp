// SPDX-License-Identifier: Apache-2.0
// Both ends of the spectrum of a network that no rank holds: lambda_2 and lambda_max of its Laplacian.
#pragma once

#include <functional>

#include "partition/region.hpp"

namespace garrison::partition {

/// Estimates from inside: lambda2 is never below the second smallest eigenvalue, lambda_max never above the
/// largest (but for rounding). An eigenvalue lies within the residual of each; that it is the one that is
/// meant is likely once both have settled, and proved by nothing.
struct Spectrum {
  double lambda2 = 0.0;
  double lambda_max = 0.0;
  double residual2 = 0.0;
  double residual_max = 0.0;
  double bound = 0.0;    ///< no eigenvalue is above, for certain
  int products = 0;      ///< with the Laplacian
  bool settled = false;  ///< both residuals are small: the error of each is about the square of its residual
                         ///< over the distance to the next eigenvalue
};

/// Lanczos on the vectors orthogonal to all-ones, from a start that the public ids decide, in three vectors'
/// memory; at most `most` >= 1 products. The same bits for any ranks. All ranks together; of a connected
/// network of at least two agents. `looked`: called now and then with what is known, on every rank.
Spectrum laplacian_spectrum(const Region& region, Exchange& exchange, int most,
                            const std::function<void(const Spectrum&)>& looked = {});

}  // namespace garrison::partition
