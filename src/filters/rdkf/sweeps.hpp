// SPDX-License-Identifier: Apache-2.0
// Equation (5) as a recursion: one sweep over the network, and sweeps until they settle.
#pragma once

#include <vector>

#include "analysis/extended.hpp"
#include "garrison/filters/rdkf/steady_state.hpp"

namespace garrison::rdkf {

/// Sweeps after which a recursion that still changes is left to Newton's method.
inline constexpr int kQuickSweeps = 400;

/// A P_j A' + Sw
Matrix predicted(const Setting& s, std::size_t j, const Matrix& P);

/// (1/d_i) sum over N_i of Pbar_j^-1 for every agent.
std::vector<Matrix> fused(const Setting& s, const std::vector<Matrix>& P);

/// (Q + M'M)^-1 from a root of Q^-1, row by row of M (Potter): where M is huge, because measurements have
/// hardly any noise, the sum would hold nothing of Q.
Matrix updated(const Matrix& Q, const Matrix& M);
detail::Extended updated(const detail::Extended& Q, const Matrix& M);

std::vector<Matrix> sweep(const Setting& s, const std::vector<Matrix>& P);

/// C_i' Sv_i^-1 C_i
std::vector<Matrix> measured(const Setting& s);

/// Sweeps until the change is below `tolerance`, or where rounding keeps it; false: still changing after
/// `most`.
bool settle(const Setting& s, const std::vector<Matrix>& seen, double tolerance, int most, Borders& borders,
            SteadyState& out);
/// The same for a network without other parts.
bool settle(const Setting& s, const std::vector<Matrix>& seen, double tolerance, int most, SteadyState& out);

}  // namespace garrison::rdkf
