// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/setting.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "garrison/analysis/modes.hpp"

namespace garrison::rdkf {
namespace {

/// Eigenvalues of a covariance below this part of its scale count as zero.
constexpr double kSingular = 1e-14;

Eigen::SelfAdjointEigenSolver<Matrix> require_definite(const std::string& which, const Matrix& S) {
  Eigen::SelfAdjointEigenSolver<Matrix> eigen(S);
  const double least = eigen.eigenvalues()(0);
  if (!(least > kSingular * S.cwiseAbs().maxCoeff()))
    refuse(which, "least eigenvalue " + text(least), "a positive definite covariance",
           "every measurement and every state needs some noise: add a small multiple of the identity");
  return eigen;
}

/// The covariance of states in units of their own noise: whether it is definite does not depend on units.
Matrix correlations(const Matrix& S) {
  const Vector size = S.diagonal().unaryExpr([](double v) { return v > 0.0 ? 1.0 / std::sqrt(v) : 1.0; });
  return size.asDiagonal() * S * size.asDiagonal();
}

}  // namespace

bool detectable(const MatrixRef& A, const MatrixRef& C) {
  if (A.cols() != A.rows() || C.cols() != A.rows())
    refuse("C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()), "as many columns as A has rows");
  return visibility(A, C, 1.0).all_seen();
}

Setting part_setting(const Model& model, const Network& network) {
  const int N = model.agents();
  if (network.agents() != N)
    refuse("network", amount(network.agents(), "agent"),
           std::to_string(N) + ", because C has one matrix per agent");
  const auto& noise = model.noise();
  if (noise.process_covariance.size() == 0 && noise.agent_process_covariance.empty())
    refuse("process_covariance", "none", "the covariance of w (Sw), n x n, for the Kalman weights");
  if (noise.measurement_covariance.empty() && model.total_outputs() > 0)
    refuse("measurement_covariance", "none", "one covariance (Sv) per agent, for the Kalman weights");
  Setting s;
  s.A = model.A();
  for (int i = 0; i < N; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const std::string agent = std::to_string(i);
    s.C.push_back(model.C(i));
    s.Sw.push_back(noise.agent_process_covariance.empty() ? noise.process_covariance
                                                          : noise.agent_process_covariance[k]);
    require_definite("process_covariance (Sw[" + agent + "])", correlations(s.Sw.back()));
    if (model.outputs(i) > 0) {
      s.Sv.push_back(noise.measurement_covariance[k]);
      const auto root = require_definite("measurement_covariance (Sv[" + agent + "])", s.Sv.back());
      s.whitener.push_back(root.operatorInverseSqrt());
    } else {
      s.Sv.emplace_back(0, 0);
      s.whitener.emplace_back(0, 0);
    }
    s.M.push_back(s.whitener.back() * s.C.back());
    if (!std::isfinite(s.M.back().squaredNorm()))
      refuse("measurement_covariance (Sv[" + agent + "])",
             "numbers so small that what the measurements tell overflows",
             "variances above about 1e-300 of the squares of C", "any that small says the same: take 1e-100");
    const auto heard = network.neighbours(i);
    std::vector<int> all(heard.begin(), heard.end());
    all.insert(std::lower_bound(all.begin(), all.end(), i), i);
    s.neighbours.push_back(std::move(all));
  }
  return s;
}

Setting setting(const Model& model, const Network& network) {
  Setting s = part_setting(model, network);
  network.require_connected();
  const Visibility modes = visibility(s.A, model.stacked(), 1.0);
  if (!modes.all_seen())
    refuse("model", "a pair (A, C) that is not detectable (" + modes.text() + ")",
           "that every mode of modulus >= 1 is seen by some agent",
           "equation (5) has no solution otherwise; add a sensor for that mode");
  return s;
}

}  // namespace garrison::rdkf
