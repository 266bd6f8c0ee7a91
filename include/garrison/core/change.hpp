// SPDX-License-Identifier: Apache-2.0
// What of a plant is not the model's in a sample.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison {

/// Matrices of the present sample that differ from the model's; they stay where they are until the next one.
/// Null = as before. Where A changes, certificates move no region of earlier samples along (a bank does), nor
/// where Q does and they rest on it.
struct Change {
  const Matrix* A = nullptr;
  const Matrix* C = nullptr;  ///< what agents see, all C_i on top of each other
  const Matrix* Q = nullptr;  ///< of the process noise, for certificates and gains that follow it
  /// Of the measurement noise, for gains that follow it: lower triangular W_i with W_i R_i W_i' = I
  /// (`whitener`), below each other as Series has the R_i.
  const Matrix* W = nullptr;
  const Matrix* rows = nullptr;  ///< likewise C, of what certificates may rest on: zeros = not on this output
  const Vector* variance = nullptr;  ///< of every output, for certificates
};

}  // namespace garrison
