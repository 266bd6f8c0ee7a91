// SPDX-License-Identifier: Apache-2.0
// A quick yes to "is (A, C) observable?". Internal.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison::detail {

/// True only where visibility(A, C, 0) is sure to say `seen`; false means nothing. Costs n products and one
/// QR decomposition, no eigenvalues. Let |[A; C]| <= 1 and d = |[A - z I; C] v| for a unit vector v, d <=
/// 1e-3; then |z| <= 1 + d and C A^k v = z^k C v + sum over j < k of z^(k-1-j) C A^j (A v - z v), so that |O
/// v| <= 1.2 n^1.5 d for O = [C; CA; ...; CA^(n-1)]: every pair with an unseen mode is at least sigma_min(O)
/// / (1.2 n^1.5) away.
bool clearly_observable(const Matrix& A, const Matrix& C);

}  // namespace garrison::detail
