// SPDX-License-Identifier: Apache-2.0
// Covariances, constants and the convex step of the resilient distributed Kalman filter.
#include "bindings.hpp"
#include "garrison/filters/rdkf/analysis.hpp"
#include "garrison/filters/rdkf/box_step.hpp"
#include "garrison/filters/rdkf/fresh_step.hpp"
#include "garrison/filters/rdkf/ipopt_step.hpp"
#include "kept.hpp"

using namespace garrison;
using namespace garrison::rdkf;

namespace {

Penalty penalty_of(const std::string& name) {
  const std::vector<std::string> known{"norm", "huber", "l1"};
  if (name == "norm") return Penalty::norm;
  if (name == "huber") return Penalty::huber;
  if (name == "l1") return Penalty::l1;
  if (name == "group") return Penalty::group;
  refuse_unknown("penalty", name, known);
}

/// One problem (8) in whitened form.
py::dict one_step(const MatrixRef& Q, const MatrixRef& M, const VectorRef& b, const VectorRef& x0,
                  double weight, const std::string& penalty, double smoothing, const std::string& solver) {
  const auto n = Q.rows();
  if (M.cols() != n || b.size() != M.rows() || x0.size() != n || Q.cols() != n)
    refuse("step",
           "Q " + std::to_string(n) + " x " + std::to_string(Q.cols()) + ", M " + std::to_string(M.rows()) +
               " x " + std::to_string(M.cols()) + ", b " + std::to_string(b.size()) + ", x0 " +
               std::to_string(x0.size()),
           "Q n x n, M q x n, b q, x0 n");
  require_range("weight (lambda)", weight, 0.0, kInfinity);
  require_range("smoothing", smoothing, 0.0);
  if (!Q.allFinite() || !M.allFinite() || !b.allFinite() || !x0.allFinite())
    refuse("step", "a number that is not finite", "finite numbers");
  const Matrix root = Matrix::Identity(M.rows(), M.rows());
  const Penalty kind = penalty_of(penalty);
  const Price price{weight, smoothing};
  Vector x = x0;
  Step step;
  if (solver == "ipopt") {
    require_ipopt();
    if (kind != Penalty::norm) refuse("penalty", penalty, "norm, with solver \"ipopt\"");
    step = solve_ipopt(Q, M, b, price, x.data());
  } else if (solver != "exact") {
    refuse("solver", "\"" + solver + "\"", "\"exact\" or \"ipopt\"");
  } else if (kind == Penalty::l1) {
    const BoxFactors f = box_factors(root, M, Q);
    std::vector<double> room(f.room());
    step = solve_box(f, weight, b.data(), x.data(), room.data());
  } else {
    step = solve_fresh(Q, M, kind, price, b.data(), x.data());
  }
  const double residual = (b - M * x).norm();
  const double objective = (weight == 0.0 ? 0.0 : weight * residual) + (x - x0).dot(Q * (x - x0));
  return py::dict(py::arg("x") = x, py::arg("mu") = step.mu, py::arg("iterations") = step.iterations,
                  py::arg("residual_norm") = residual, py::arg("objective") = objective);
}

py::dict all_constants(const Setting& s, const SteadyState& steady, double weight,
                       const std::string& penalty) {
  const Constants c = constants(s, steady, weight, penalty_of(penalty));
  return py::dict(
      py::arg("resiliency_bound") = c.resiliency_bound, py::arg("deviation_bound") = c.prior_deviation_bound,
      py::arg("refined_threshold") = c.refined_threshold,
      py::arg("level") =
          py::dict(py::arg("printed") = c.level.printed, py::arg("corrected") = c.level.corrected,
                   py::arg("refined") = c.level.refined),
      py::arg("rate") = c.rate, py::arg("eta") = c.eta, py::arg("dkf_error_radius") = c.dkf_error_radius,
      py::arg("prior_error_radius") = c.prior_error_radius, py::arg("persistent_bound") = c.persistent_bound);
}

}  // namespace

void bind_rdkf(py::module_& m) {
  auto r =
      m.def_submodule("rdkf", "Covariances, constants and step of the resilient distributed Kalman filter.");
  py::class_<SteadyState> solution(r, "SteadyState", "Solution of (5): one matrix per agent each.");
  using S = SteadyState;
  keep_fields<S>(solution, "garrison._core.rdkf.SteadyState", KeptField{"P", &S::P},
                 KeptField{"Pbar", &S::Pbar}, KeptField{"Q", &S::Q}, KeptField{"sweeps", &S::sweeps},
                 KeptField{"change", &S::change});
  solution.def_readonly("P", &SteadyState::P, "(5), (n, n) per agent")
      .def_readonly("Pbar", &SteadyState::Pbar, "(6)")
      .def_readonly("Q", &SteadyState::Q, "(1/d_i) sum of Pbar_j^-1 over the agent and its neighbours")
      .def_readonly("sweeps", &SteadyState::sweeps)
      .def_readonly("change", &SteadyState::change, "relative change in the last sweep");
  py::class_<Setting>(
      r, "Setting",
      "A model and a network with covariances, connection and detectability checked.\n"
      "Raises InvalidInput where a covariance is missing or not positive definite, the network is not\n"
      "connected, or (A, C) is not detectable.")
      .def(py::init(&setting), py::arg("model"), py::arg("network"))
      .def("sweep", &riccati_sweep, py::arg("P"), "One application of (5) to one (n, n) matrix per agent.")
      .def(
          "steady_state",
          [](const Setting& s, const std::vector<Matrix>& start, double tolerance, int most_sweeps) {
            require_range("tolerance", tolerance, 0.0, 1.0);
            require_range("most_sweeps", most_sweeps, 1.0, 1e7);
            return steady_state(s, {start, tolerance, most_sweeps});
          },
          py::arg("start") = std::vector<Matrix>(), py::arg("tolerance") = SteadyOptions{}.tolerance,
          py::arg("most_sweeps") = SteadyOptions{}.most_sweeps,
          "Solution of (5), from `start` (one matrix per agent; empty = zero). The limit does not depend on "
          "it.");
  r.def("constants", &all_constants, py::arg("setting"), py::arg("steady"), py::arg("weight"),
        py::arg("penalty") = "norm",
        "Bounds, theorem III.3 levels, rates and radii. level['printed'] is not valid.");
  r.def(
      "lyapunov",
      [](const SteadyState& s, const MatrixRef& errors) { return lyapunov(s, errors.transpose()); },
      py::arg("steady"), py::arg("errors"), "max e_i' P_i^-1 e_i for errors (N, n).");
  r.def(
      "scalar_basin",
      [](const Setting& s, const SteadyState& steady, double weight) {
        require_range("weight (lambda)", weight, 0.0, kInfinity);
        return scalar_basin(s, steady, weight);
      },
      py::arg("setting"), py::arg("steady"), py::arg("weight"),
      "One agent, one state: exact radius of convergence without attack.");
  r.def("detectable", &detectable, py::arg("A"), py::arg("C"),
        "Every mode of A that does not decay is seen by some row of C, (m, n).");
  r.def("ipopt_available", &ipopt_available, "This build has the solver \"ipopt\".");
  r.def("step", &one_step, py::arg("Q"), py::arg("M"), py::arg("b"), py::arg("x0"), py::arg("weight"),
        py::kw_only(), py::arg("penalty") = "norm", py::arg("smoothing") = 0.0, py::arg("solver") = "exact",
        "min over x of penalty(b - M x) + (x - x0)'Q(x - x0): (8) with whitened measurements.\n"
        "Q (n, n) positive definite, M (q, n). penalty: norm, huber or l1. Returns x, mu, iterations,\n"
        "residual_norm = |b - M x| and objective (that of penalty norm).");
}
