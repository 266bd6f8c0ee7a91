// SPDX-License-Identifier: Apache-2.0
// Eigen's dense decompositions and products of run-time size, compiled once for the whole library
// (solvers.cpp).
//
// Include this in place of <Eigen/Cholesky>, <Eigen/Eigenvalues>, <Eigen/LU> and <Eigen/SVD>: everything is
// used as ever, but a file that does so compiles in less than half of the time.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

// Names in Eigen::internal are those of 3.4. With another release nothing is declared and every file compiles
// its own.
#if EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4
#ifndef GARRISON_SOLVERS  // empty in solvers.cpp
#define GARRISON_SOLVERS extern
#endif

namespace Eigen {

GARRISON_SOLVERS template class HessenbergDecomposition<MatrixXd>;
GARRISON_SOLVERS template class Tridiagonalization<MatrixXd>;
GARRISON_SOLVERS template class RealSchur<MatrixXd>;
GARRISON_SOLVERS template class EigenSolver<MatrixXd>;
GARRISON_SOLVERS template class SelfAdjointEigenSolver<MatrixXd>;
GARRISON_SOLVERS template class JacobiSVD<MatrixXd>;
GARRISON_SOLVERS template class LLT<MatrixXd>;
GARRISON_SOLVERS template class PartialPivLU<MatrixXd>;

// Templates within those templates: one line for each kind of argument.
GARRISON_SOLVERS template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute(const EigenBase<MatrixXd>&,
                                                                                bool);
GARRISON_SOLVERS template EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute(
    const EigenBase<Ref<const MatrixXd>>&, bool);
GARRISON_SOLVERS template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
GARRISON_SOLVERS template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<Ref<const MatrixXd>>&, int);
GARRISON_SOLVERS template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
GARRISON_SOLVERS template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<Ref<const MatrixXd>>&);

namespace internal {

GARRISON_SOLVERS template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, 0, 0, 1>,
                                             gebp_traits<double, double>::mr, gebp_traits<double, double>::nr,
                                             false, false>;

// <order of A, order of B>, ColMajor = 0, RowMajor = 1
GARRISON_SOLVERS template struct general_matrix_matrix_product<Index, double, 0, false, double, 0, false, 0,
                                                               1>;
GARRISON_SOLVERS template struct general_matrix_matrix_product<Index, double, 0, false, double, 1, false, 0,
                                                               1>;
GARRISON_SOLVERS template struct general_matrix_matrix_product<Index, double, 1, false, double, 0, false, 0,
                                                               1>;
GARRISON_SOLVERS template struct general_matrix_matrix_product<Index, double, 1, false, double, 1, false, 0,
                                                               1>;
GARRISON_SOLVERS template struct general_matrix_vector_product<
    Index, double, const_blas_data_mapper<double, Index, 0>, 0, false, double,
    const_blas_data_mapper<double, Index, 0>, false, 0>;
GARRISON_SOLVERS template struct general_matrix_vector_product<
    Index, double, const_blas_data_mapper<double, Index, 0>, 0, false, double,
    const_blas_data_mapper<double, Index, 1>, false, 0>;
GARRISON_SOLVERS template struct general_matrix_vector_product<
    Index, double, const_blas_data_mapper<double, Index, 1>, 1, false, double,
    const_blas_data_mapper<double, Index, 0>, false, 0>;
GARRISON_SOLVERS template struct general_matrix_vector_product<
    Index, double, const_blas_data_mapper<double, Index, 1>, 1, false, double,
    const_blas_data_mapper<double, Index, 1>, false, 0>;

// <side, triangle, conjugate, order of the triangle, order of the other>
GARRISON_SOLVERS template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, 0, 0, 1>;
GARRISON_SOLVERS template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, 0, 0, 1>;
GARRISON_SOLVERS template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, 1, 0, 1>;
GARRISON_SOLVERS template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, 0, 0, 1>;

}  // namespace internal
}  // namespace Eigen

#endif
