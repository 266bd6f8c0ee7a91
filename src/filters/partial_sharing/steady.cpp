// SPDX-License-Identifier: Apache-2.0
// The limit of the local Riccati recursion (11).
#include <optional>

#include "core/solvers.hpp"
#include "garrison/filters/partial_sharing/setting.hpp"

namespace garrison::partial_sharing {
namespace {

constexpr int kDoublings = 48;
constexpr int kPolish = 4000;

/// P -> A P (I + G P)^-1 A' + Q over 1, 2, 4, .. steps, until P_0 has come to rest. Only a good start: the
/// recursion itself finishes. Empty when P grows without limit.
std::optional<Matrix> doubled(const Setting& s, const Matrix& H, const Matrix& R) {
  const Matrix I = Matrix::Identity(s.A.rows(), s.A.rows());
  Matrix A = s.A;
  Matrix G = Matrix::Zero(I.rows(), I.rows());
  if (H.rows() > 0) {
    const Matrix white = whitener(R, 0) * H;
    G = white.transpose() * white;
  }
  Matrix Q = s.Q;
  Matrix P = s.P0;
  const double scale = 1.0 + s.P0.cwiseAbs().maxCoeff() + s.Q.cwiseAbs().maxCoeff();
  for (int k = 0; k < kDoublings; ++k) {
    const Matrix next = A * P * (I + G * P).partialPivLu().solve(A.transpose()) + Q;
    if (!next.allFinite() || next.cwiseAbs().maxCoeff() > 1e14 * scale) return std::nullopt;
    const double change = (next - P).cwiseAbs().maxCoeff();
    P = (next + next.transpose()) / 2.0;
    if (change <= 1e-15 * P.cwiseAbs().maxCoeff()) return P;
    const auto inner = (I + Q * G).partialPivLu();
    const Matrix B = inner.solve(A);
    const Matrix QA = inner.solve(Q) * A.transpose();
    const Matrix GB = G * B;
    G += A.transpose() * GB;
    Q += A * QA;
    A = A * B;
    G = (G + G.transpose()).eval() / 2.0;
    Q = (Q + Q.transpose()).eval() / 2.0;
  }
  return std::nullopt;
}

std::optional<LocalGains> limit(const Setting& s, int agent) {
  const auto i = static_cast<std::size_t>(agent);
  const auto start = doubled(s, s.H[i], s.R[i]);
  if (!start) return std::nullopt;
  LocalRecursion recursion(s, agent);
  recursion.restart(*start);
  LocalGains gains;
  for (int k = 0; k < kPolish; ++k) {
    double change = 0.0;
    gains = recursion.step(&change);
    if (change <= kConverged) break;
  }
  return gains;
}

}  // namespace

LocalGains steady_gains(const Setting& setting, int agent) {
  if (auto gains = limit(setting, agent)) return *std::move(gains);
  refuse(
      "agent " + std::to_string(agent), "a recursion (11) that does not settle",
      "one that does, for a steady state",
      "a pair (A, H) that is not detectable needs a sensor of what does not decay, which neighbours do not "
      "replace; a mode that stays and that no process noise drives needs some");
}

std::vector<LocalGains> steady_gains(const Setting& setting) {
  std::vector<LocalGains> all;
  for (int i = 0; i < setting.agents(); ++i) all.push_back(steady_gains(setting, i));
  return all;
}

std::vector<int> undetectable_agents(const Setting& setting) {
  std::vector<int> all;
  for (int i = 0; i < setting.agents(); ++i)
    if (!limit(setting, i)) all.push_back(i);
  return all;
}

}  // namespace garrison::partial_sharing
