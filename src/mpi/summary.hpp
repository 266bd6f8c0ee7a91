// SPDX-License-Identifier: Apache-2.0
// Errors of one sample over all agents, with bits that do not depend on the number of ranks.
#pragma once

#include <span>

#include "mpi/public_order.hpp"

namespace garrison::mpi {

/// ||estimate - truth|| over all agents. Quantiles are upper ends of bins of 1 %, from 1e-12 to 1e12; NaN or
/// infinite where some estimate is.
struct Summary {
  double mean = 0.0;
  double largest = 0.0;
  double median = 0.0;
  double q95 = 0.0;
};

/// `estimates`: n numbers per agent of this rank's range of `order`. All ranks call it; the result is that of
/// all of them on rank 0.
Summary summary_of(const PublicOrder& order, std::span<const double> estimates,
                   std::span<const double> truth);

}  // namespace garrison::mpi
