// SPDX-License-Identifier: Apache-2.0
// Coordinates in which the conditions are easier to meet (docs/filters/saturation.md#s-coordinates): ||A||
// and lambda0 depend on the basis of the state, what can be reconstructed from the sensors does not.
#pragma once

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::saturation {

/// Rows of unit length, as all bounds of the paper assume.
struct UnitRows {
  Matrix C;      ///< N x n, rows of length 1
  Vector b_v;    ///< N, noise bounds divided by the row lengths; the common b_v is the largest
  Vector scale;  ///< N, 1/|C_i|: multiply y_i by scale_i before filtering
};
/// `C`: N x n, finite. `b_v`: N noise bounds, finite and >= 0.
/// @throws InvalidInput on a zero row (it measures nothing), a wrong size or a bad number
GARRISON_EXPORT UnitRows normalise_rows(MatrixRef C, VectorRef b_v);

/// The system in coordinates z = T x: z(t+1) = A z(t) + T w(t), scaled y_i = C_i z + scaled v_i.
struct Coordinates {
  Matrix T;  ///< n x n
  Matrix T_inverse;
  Matrix A;        ///< T A T^-1
  UnitRows rows;   ///< C T^-1, renormalised, with the noise bounds that belong to it
  double b_w;      ///< ||T|| b_w
  double stretch;  ///< ||T||: eta0 becomes stretch eta0
  double shrink;   ///< ||T^-1||: an error bound r on z is an error bound shrink r on x
};

/// Any invertible `T`, n x n. `A`: n x n. `C`: N x n without zero rows. `b_w` >= 0. `b_v`: N bounds >= 0.
/// @throws InvalidInput on a wrong size, a bad number or a T that is singular to working precision
Coordinates transform(MatrixRef A, MatrixRef C, double b_w, VectorRef b_v, MatrixRef T);
/// z = diag(tau) x, tau: n numbers > 0. Brings ||A|| of a chain of integrators near 1.
GARRISON_EXPORT Coordinates scale_states(MatrixRef A, MatrixRef C, double b_w, VectorRef b_v, VectorRef tau);
/// T'T = sum of C_i'C_i, T symmetric: spreads the rows of C over all directions, which raises lambda0.
/// @throws InvalidInput also when the sum is singular (some direction of the state is not measured in one
/// step)
GARRISON_EXPORT Coordinates whiten(MatrixRef A, MatrixRef C, double b_w, VectorRef b_v);

}  // namespace garrison::saturation
