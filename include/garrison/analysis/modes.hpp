// SPDX-License-Identifier: Apache-2.0
// Numeric observability and detectability, mode by mode (Popov, Belevitch, Hautus).
#pragma once

#include <complex>
#include <vector>

#include "garrison/core/model.hpp"

namespace garrison {

/// Eigenvalues lambda of A with |lambda| >= least for which [lambda I - A; C] lacks rank: modes that no
/// sensor shows. least = 0: (A, C) is observable when there is none; least = 1: detectable. C may have no
/// row. A pivot below `tolerance` times the largest counts as zero.
GARRISON_EXPORT std::vector<std::complex<double>> unseen_modes(const MatrixRef& A, const MatrixRef& C,
                                                               double least, double tolerance = 1e-9);

/// Agents whose sensor alone can lie along an unstable mode that nobody else sees: no detector of any kind
/// can find such an attack (notes on the structural paper, section 2). Sorted.
GARRISON_EXPORT std::vector<int> undetectable_agents(const Model& model, double tolerance = 1e-9);

}  // namespace garrison
