// SPDX-License-Identifier: Apache-2.0
#include "mpi/slepc_spectrum.hpp"

#include "garrison/core/error.hpp"

#ifdef GARRISON_HAS_SLEPC
#include <slepceps.h>

#include <vector>

#include "mpi/together.hpp"
#include "partition/ghost_numbers.hpp"
#include "partition/laplacian.hpp"
#endif

namespace garrison::mpi {

#ifndef GARRISON_HAS_SLEPC

bool has_slepc() { return false; }

void require_slepc() {
  refuse("--slepc", "a garrison-mpi without SLEPc", "one that was built with it",
         "leave it out, or build with libslepc-real-dev installed and -DGARRISON_SLEPC=ON");
}

partition::Spectrum slepc_spectrum(const partition::Region&, MpiExchange&, int) {
  require_slepc();
  return {};
}

#else

namespace {

void must(PetscErrorCode code) {
  if (code != 0) refuse("--slepc", "PETSc error " + std::to_string(code), "none", "leave it out");
}

/// PETSc and SLEPc from here to the end of the block.
class Slepc {
 public:
  Slepc() {
    must(SlepcInitializeNoArguments());
    must(PetscPopSignalHandler());                                  // Ctrl-C ends the job as ever
    must(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));  // told by us
  }
  Slepc(const Slepc&) = delete;
  Slepc& operator=(const Slepc&) = delete;
  ~Slepc() { SlepcFinalize(); }
};

/// The Laplacian plus `shift` times the identity, rows in the order of ranks and places.
class LaplacianMatrix {
 public:
  LaplacianMatrix(const partition::Region& region, MpiExchange& exchange, double shift) {
    const auto own = static_cast<PetscInt>(region.own);
    PetscInt end = 0;
    MPI_Scan(&own, &end, 1, MPIU_INT, MPI_SUM, MPI_COMM_WORLD);
    std::vector<PetscInt> number(static_cast<std::size_t>(region.places()));
    for (PetscInt k = 0; k < own; ++k) number[static_cast<std::size_t>(k)] = end - own + k;
    partition::GhostNumbers<PetscInt>(region, exchange).fetch(number);
    std::vector<PetscInt> here, there;  // entries of each row in columns of this rank and of others
    for (int place = 0; place < region.own; ++place) {
      const auto k = static_cast<std::size_t>(place);
      PetscInt away = 0;
      for (std::size_t e = region.first[k]; e < region.first[k + 1]; ++e)
        away += region.heard[e] >= region.own;
      here.push_back(1 + region.degree(place) - away);
      there.push_back(away);
    }
    must(MatCreateAIJ(PETSC_COMM_WORLD, own, own, region.agents, region.agents, 0, here.data(), 0,
                      there.data(), &matrix_));
    for (int place = 0; place < region.own; ++place) {
      const auto k = static_cast<std::size_t>(place);
      must(MatSetValue(matrix_, number[k], number[k], region.degree(place) + shift, INSERT_VALUES));
      for (std::size_t e = region.first[k]; e < region.first[k + 1]; ++e)
        must(MatSetValue(matrix_, number[k], number[static_cast<std::size_t>(region.heard[e])], -1.0,
                         INSERT_VALUES));
    }
    must(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
    must(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
  }
  LaplacianMatrix(const LaplacianMatrix&) = delete;
  LaplacianMatrix& operator=(const LaplacianMatrix&) = delete;
  ~LaplacianMatrix() { MatDestroy(&matrix_); }
  Mat get() const { return matrix_; }

 private:
  Mat matrix_ = nullptr;
};

struct Pair {
  double value = 0.0;
  double residual = 0.0;
  int iterations = 0;
  bool settled = false;
};

/// One end of the spectrum on the vectors orthogonal to all-ones; `preconditioner`: of the lower one.
Pair end_of(const LaplacianMatrix& laplacian, const LaplacianMatrix* preconditioner, int most) {
  EPS solver = nullptr;
  Vec ones = nullptr;
  must(MatCreateVecs(laplacian.get(), &ones, nullptr));
  must(VecSet(ones, 1.0));
  must(EPSCreate(PETSC_COMM_WORLD, &solver));
  must(EPSSetOperators(solver, laplacian.get(), nullptr));
  must(EPSSetProblemType(solver, EPS_HEP));
  must(EPSSetDeflationSpace(solver, 1, &ones));
  must(EPSSetTolerances(solver, 1e-7, most));
  if (preconditioner != nullptr) {
    ST transform = nullptr;
    KSP solve = nullptr;
    PC multigrid = nullptr;
    must(EPSSetType(solver, EPSLOBPCG));
    must(EPSSetWhichEigenpairs(solver, EPS_SMALLEST_REAL));
    must(EPSSetConvergenceTest(solver, EPS_CONV_REL));
    must(EPSGetST(solver, &transform));
    must(STSetPreconditionerMat(transform, preconditioner->get()));
    must(STGetKSP(transform, &solve));
    must(KSPGetPC(solve, &multigrid));
    must(PCSetType(multigrid, PCGAMG));
  } else {
    must(EPSSetWhichEigenpairs(solver, EPS_LARGEST_REAL));
  }
  must(EPSSolve(solver));
  Pair pair;
  PetscInt found = 0;
  PetscInt iterations = 0;
  must(EPSGetConverged(solver, &found));
  must(EPSGetIterationNumber(solver, &iterations));
  pair.iterations = static_cast<int>(iterations);
  pair.settled = found > 0;
  if (found > 0) {
    must(EPSGetEigenvalue(solver, 0, &pair.value, nullptr));
    must(EPSComputeError(solver, 0, EPS_ERROR_ABSOLUTE, &pair.residual));
  }
  must(EPSDestroy(&solver));
  must(VecDestroy(&ones));
  return pair;
}

}  // namespace

bool has_slepc() { return true; }
void require_slepc() {}

partition::Spectrum slepc_spectrum(const partition::Region& region, MpiExchange& exchange, int most) {
  partition::Spectrum s;
  s.bound = partition::Laplacian(region, exchange).bound();
  const Slepc open;
  const LaplacianMatrix laplacian(region, exchange, 0.0);
  // Multigrid wants a definite matrix: a shift below every lambda_2 of use.
  const LaplacianMatrix definite(region, exchange, 1e-8 * s.bound);
  const Pair low = end_of(laplacian, &definite, most);
  const Pair high = end_of(laplacian, nullptr, most);
  s.lambda2 = low.value;
  s.residual2 = low.residual;
  s.lambda_max = high.value;
  s.residual_max = high.residual;
  s.products = low.iterations + high.iterations;
  s.settled = low.settled && high.settled;
  return s;
}

#endif

}  // namespace garrison::mpi
