// SPDX-License-Identifier: Apache-2.0
// The spectrum of a huge network by SLEPc, where it is linked.
#pragma once

#include "mpi/mpi_exchange.hpp"
#include "partition/spectrum.hpp"

namespace garrison::mpi {

bool has_slepc();
/// @throws InvalidInput where it is not
void require_slepc();

/// lambda_max by Krylov-Schur, lambda_2 by LOBPCG with algebraic multigrid, which needs few iterations where
/// Lanczos needs thousands of products (`most` of each); the last digits depend on the number of ranks. All
/// ranks together; of a connected network. @throws InvalidInput where SLEPc
/// is not linked or gives up
partition::Spectrum slepc_spectrum(const partition::Region& region, MpiExchange& exchange, int most);

}  // namespace garrison::mpi
