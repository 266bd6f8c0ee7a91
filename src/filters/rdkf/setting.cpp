// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/setting.hpp"

#include <complex>

#include "core/solvers.hpp"

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

}  // namespace

bool detectable(const MatrixRef& A, const MatrixRef& C) {
  const auto n = A.rows();
  if (A.cols() != n || C.cols() != n)
    refuse("C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()), "as many columns as A has rows");
  const Eigen::VectorXcd modes = Eigen::EigenSolver<Matrix>(A, false).eigenvalues();
  const double scale = std::max(A.norm(), C.rows() > 0 ? C.norm() : 0.0);
  for (const std::complex<double> mode : modes) {
    if (std::abs(mode) < 1.0 - 1e-10) continue;
    // [A - mode I; C] with real and imaginary part side by side: every singular value comes twice.
    const auto m = C.rows();
    const Matrix real = A - mode.real() * Matrix::Identity(n, n);
    const Matrix imaginary = mode.imag() * Matrix::Identity(n, n);
    Matrix pencil = Matrix::Zero(2 * (n + m), 2 * n);
    pencil.topLeftCorner(n, n) = pencil.block(n, n, n, n) = real;
    pencil.topRightCorner(n, n) = imaginary;
    pencil.block(n, 0, n, n) = -imaginary;
    pencil.block(2 * n, 0, m, n) = pencil.bottomRightCorner(m, n) = C;
    const Vector values = Eigen::JacobiSVD<Matrix>(pencil).singularValues();
    if (!(values(2 * n - 1) > 1e-10 * scale)) return false;
  }
  return true;
}

Setting setting(const Model& model, const Network& network) {
  const int N = model.agents();
  if (network.agents() != N)
    refuse("network", std::to_string(network.agents()) + " agents",
           std::to_string(N) + ", because C has one matrix per agent");
  const auto& noise = model.noise();
  if (noise.process_covariance.size() == 0 && noise.agent_process_covariance.empty())
    refuse("process_covariance", "none", "the covariance of w (Sw), n x n, for the Kalman weights");
  if (noise.measurement_covariance.empty() && model.total_outputs() > 0)
    refuse("measurement_covariance", "none", "one covariance (Sv) per agent, for the Kalman weights");
  network.require_connected();
  Setting s;
  s.A = model.A();
  for (int i = 0; i < N; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const std::string agent = std::to_string(i);
    s.C.push_back(model.C(i));
    s.Sw.push_back(noise.agent_process_covariance.empty() ? noise.process_covariance
                                                          : noise.agent_process_covariance[k]);
    require_definite("process_covariance (Sw[" + agent + "])", s.Sw.back());
    if (model.outputs(i) > 0) {
      s.Sv.push_back(noise.measurement_covariance[k]);
      const auto root = require_definite("measurement_covariance (Sv[" + agent + "])", s.Sv.back());
      s.whitener.push_back(root.operatorInverseSqrt());
    } else {
      s.Sv.emplace_back(0, 0);
      s.whitener.emplace_back(0, 0);
    }
    s.M.push_back(s.whitener.back() * s.C.back());
    const auto heard = network.neighbours(i);
    std::vector<int> all(heard.begin(), heard.end());
    all.insert(std::lower_bound(all.begin(), all.end(), i), i);
    s.neighbours.push_back(std::move(all));
  }
  if (!detectable(s.A, model.stacked()))
    refuse("model", "a pair (A, C) that is not detectable: no agent sees some mode that does not decay",
           "a detectable one", "equation (5) has no solution otherwise; add a sensor for that mode");
  return s;
}

}  // namespace garrison::rdkf
