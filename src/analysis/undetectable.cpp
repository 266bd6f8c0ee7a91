// SPDX-License-Identifier: Apache-2.0
// Agents whose loss ends detectability, from one decomposition per mode instead of one per agent.
#include <algorithm>
#include <optional>

#include "garrison/kernel/hypotenuse.hpp"
#include "splitting.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;
using detail::Complex;
using detail::MatrixOf;
using detail::VectorOf;

/// 1 minus the largest singular value squared of C_i R^-1 below which agent i may be necessary.
constexpr double kSuspect = 1e-6;

struct Rows {
  int agent;
  Index first, count;
};

Matrix without(const Matrix& C, const Rows& rows) {
  Matrix others(C.rows() - rows.count, C.cols());
  others.topRows(rows.first) = C.topRows(rows.first);
  others.bottomRows(C.rows() - rows.first - rows.count) = C.bottomRows(C.rows() - rows.first - rows.count);
  return others;
}

/// With R'R = P'P of the pencil P, leaving out the rows C_i costs rank exactly if |C_i R^-1| = 1.
template <class S>
std::vector<int> necessary(const Matrix& A, const Matrix& C, const detail::Pair& pair,
                           const std::vector<Complex>& modes, const std::vector<Rows>& agents) {
  detail::Splitting<S> seen(detail::rows_scaled(A, C, detail::natural_rate(A)), 1.0);
  if (!seen.run(modes).all_seen()) {  // perhaps only in the units given
    seen = detail::Splitting<S>(pair, 1.0);
    seen.run(modes);
  }
  std::optional<std::size_t> unseen_by_all;  // computed for the first agent that needs it
  std::vector<int> found;
  if (seen.A().rows() == 0) return found;
  std::vector<char> listed(agents.size(), 0);
  const double level = detail::unseen_level(A.rows()) * seen.size();
  for (const Complex mode : modes) {
    const S z = detail::scalar_of<S>(mode);
    const MatrixOf<S> R = detail::triangle<S>(seen.A(), seen.C(), z);
    const MatrixOf<S> G =
        R.adjoint().template triangularView<Eigen::Lower>().solve(seen.C().adjoint()).eval();
    for (std::size_t k = 0; k < agents.size(); ++k) {
      const Rows& rows = agents[k];
      if (listed[k]) continue;
      const auto own = G.middleCols(rows.first, rows.count);
      const Eigen::SelfAdjointEigenSolver<MatrixOf<S>> eigen(MatrixOf<S>(own.adjoint() * own));
      if (!(1.0 - eigen.eigenvalues()(rows.count - 1) <= kSuspect)) continue;
      // The direction that only this agent shows: if the others do not, there is nothing more to compute.
      VectorOf<S> v = own * eigen.eigenvectors().col(rows.count - 1);
      v = R.template triangularView<Eigen::Upper>().solve(v).eval();
      v.normalize();
      VectorOf<S> shown = seen.C() * v;
      shown.segment(rows.first, rows.count).setZero();
      const double residual = hypotenuse((seen.A() * v - z * v).norm(), shown.norm());
      listed[k] = residual <= level;
      if (listed[k]) continue;
      const auto unseen = [&](const Matrix& rows_of_C) {
        const Visibility seen_modes = detail::examine(A, rows_of_C, 1.0);
        return seen_modes.unseen.size() + seen_modes.unclear.size();
      };
      if (!unseen_by_all) unseen_by_all = unseen(C);
      listed[k] = unseen(without(C, rows)) > *unseen_by_all;
    }
  }
  for (std::size_t k = 0; k < agents.size(); ++k)
    if (listed[k]) found.push_back(agents[k].agent);
  return found;
}

std::vector<int> necessary_agents(const Matrix& A, const Matrix& C, const std::vector<Rows>& agents) {
  const auto reached = detail::reach_outputs(A, C);
  std::vector<Index> heard;  // the others nobody sees, with or without any agent
  for (Index j = 0; j < A.rows(); ++j)
    if (reached[static_cast<std::size_t>(j)]) heard.push_back(j);
  if (heard.empty()) return {};
  const Matrix own_A = A(heard, heard);
  const Matrix own_C = C(Eigen::all, heard);
  const double rate = detail::natural_rate(own_A);
  const detail::Pair pair = detail::balanced(own_A, own_C, rate);
  const auto modes = detail::candidate_modes(own_A, pair.A, rate, 1.0);
  const bool real = std::all_of(modes.begin(), modes.end(), [](Complex z) { return z.imag() == 0.0; });
  return real ? necessary<double>(own_A, own_C, pair, modes, agents)
              : necessary<Complex>(own_A, own_C, pair, modes, agents);
}

}  // namespace

std::vector<int> undetectable_agents(const Model& model) {
  std::vector<Rows> agents;
  for (int i = 0; i < model.agents(); ++i)
    if (model.outputs(i) > 0) agents.push_back({i, model.offset(i), model.outputs(i)});
  if (agents.empty()) return {};
  auto [A, C] = detail::in_moderate_units(model.A(), model.stacked());
  std::vector<int> found = necessary_agents(A, C, agents);
  if (!detail::drop_rounding(A, C)) return found;
  // Who is necessary when entries of the size of rounding count for nothing is not surely replaced by them.
  for (const int i : necessary_agents(A, C, agents)) found.push_back(i);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace garrison
