// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/rdkf/ipopt_step.hpp"

#ifdef GARRISON_HAS_IPOPT
#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <mutex>
#endif

namespace garrison::rdkf {

void require_ipopt() {
  if (!ipopt_available())
    refuse(
        "solver", "\"ipopt\" in a build without it", "\"exact\"",
        "to have Ipopt, install it (on Debian: apt-get install coinor-libipopt-dev) and build garrison again "
        "with -DGARRISON_IPOPT=ON");
}

#ifndef GARRISON_HAS_IPOPT

bool ipopt_available() { return false; }
Step solve_ipopt(const MatrixRef&, const MatrixRef&, const VectorRef&, const Price&, double*) noexcept {
  return {kNaN, -1};
}

#else

bool ipopt_available() { return true; }

namespace {

using Ipopt::Index;
using Ipopt::Number;

class SmoothedStep final : public Ipopt::TNLP {
 public:
  SmoothedStep(const MatrixRef& Q, const MatrixRef& M, const VectorRef& b, const Price& price, double* x)
      : Q_(Q), M_(M), b_(b), price_(price), x_(x), x0_(Eigen::Map<const Vector>(x, Q.rows())) {}

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jacobian, Index& nnz_hessian,
                    IndexStyleEnum& style) override {
    n = static_cast<Index>(Q_.rows());
    m = nnz_jacobian = 0;
    nnz_hessian = n * (n + 1) / 2;
    style = TNLP::C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* low, Number* high, Index, Number*, Number*) override {
    std::fill_n(low, n, -2e19);
    std::fill_n(high, n, 2e19);
    return true;
  }
  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    std::copy_n(x0_.data(), n, x);
    return true;
  }
  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    const Eigen::Map<const Vector> at(x, n);
    const Vector e = at - x0_;
    value = price_.lambda * length(at) + e.dot(Q_ * e);
    return true;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    const Eigen::Map<const Vector> at(x, n);
    Eigen::Map<Vector>(gradient, n) =
        2.0 * (Q_ * (at - x0_)) - price_.lambda / length(at) * (M_.transpose() * (b_ - M_ * at));
    return true;
  }
  bool eval_g(Index, const Number*, bool, Index, Number*) override { return true; }
  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index*, Index*, Number*) override { return true; }
  bool eval_h(Index n, const Number* x, bool, Number weight, Index, const Number*, bool, Index, Index* row,
              Index* column, Number* value) override {
    Index k = 0;
    if (value == nullptr) {
      for (Index j = 0; j < n; ++j)
        for (Index i = j; i < n; ++i, ++k) {
          row[k] = i;
          column[k] = j;
        }
      return true;
    }
    const Eigen::Map<const Vector> at(x, n);
    const double s = length(at);
    const Vector Mr = M_.transpose() * (b_ - M_ * at);
    const Matrix H = 2.0 * Q_ + price_.lambda / s * (M_.transpose() * M_) -
                     price_.lambda / (s * s * s) * (Mr * Mr.transpose());
    for (Index j = 0; j < n; ++j)
      for (Index i = j; i < n; ++i) value[k++] = weight * H(i, j);
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    std::copy_n(x, n, x_);
  }

 private:
  double length(const VectorRef& x) const {
    return std::sqrt((b_ - M_ * x).squaredNorm() + price_.smoothing * price_.smoothing);
  }
  Matrix Q_;
  Matrix M_;
  Vector b_;
  Price price_;
  double* x_;
  Vector x0_;
};

}  // namespace

Step solve_ipopt(const MatrixRef& Q, const MatrixRef& M, const VectorRef& b, const Price& price,
                 double* x) noexcept {
  static std::mutex one_at_a_time;  // the linear solver below Ipopt keeps global state
  if (price.lambda == 0.0 || M.rows() == 0) return {price.lambda == 0.0 ? kInfinity : 0.0, 0};
  const Vector x0 = Eigen::Map<const Vector>(x, Q.rows());
  Price smooth = price;
  if (!(smooth.smoothing > 0.0)) smooth.smoothing = kIpoptSmoothing;
  try {
    const std::lock_guard lock(one_at_a_time);
    const Ipopt::SmartPtr<Ipopt::IpoptApplication> solver = new Ipopt::IpoptApplication(false);
    solver->Options()->SetIntegerValue("print_level", 0);
    solver->Options()->SetStringValue("sb", "yes");
    solver->Options()->SetNumericValue("tol", 1e-10);
    solver->Options()->SetIntegerValue("max_iter", 500);
    if (solver->Initialize() != Ipopt::Solve_Succeeded) return {kNaN, -1};
    const Ipopt::SmartPtr<Ipopt::TNLP> problem = new SmoothedStep(Q, M, b, smooth, x);
    const auto status = solver->OptimizeTNLP(problem);
    const Eigen::Map<Vector> result(x, Q.rows());
    const bool usable = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level ||
                        status == Ipopt::Search_Direction_Becomes_Too_Small;
    if (usable && result.allFinite())
      return {(b - M * result).norm() / price.lambda, solver->Statistics()->IterationCount()};
  } catch (...) {
    // reported as a failure
  }
  Eigen::Map<Vector>(x, Q.rows()) = x0;
  return {kNaN, -1};
}

#endif

}  // namespace garrison::rdkf
