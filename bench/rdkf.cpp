// SPDX-License-Identifier: Apache-2.0
// The convex step of rdkf: exact with cached and with fresh factors, and through Ipopt's C++ interface.
#include "bench.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/filters/rdkf/fresh_step.hpp"
#include "garrison/filters/rdkf/ipopt_step.hpp"
#include "garrison/filters/rdkf/steady_state.hpp"

using namespace garrison;
using namespace garrison::rdkf;

namespace {

/// Solutions (n x instances; NaN = not solved) and seconds per solve. b, x0: one column per instance; one Q
/// and M for all.
std::pair<Matrix, double> solve_all(const Matrix& Q, const Matrix& M, const Matrix& b, const Matrix& x0,
                                    double lambda, const std::string& how, int repeats) {
  const Matrix root = Matrix::Identity(M.rows(), M.rows());
  const StepFactors cached = step_factors(root, M, Q, Penalty::norm);
  Aligned<double> room(cached.room());
  Matrix x = x0;
  const double begin = cpu_seconds();
  for (int r = 0; r < repeats; ++r)
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
      x.col(k) = x0.col(k);
      double* const at = x.col(k).data();
      if (how == "cached")
        solve(cached, {lambda, 0.0}, b.col(k).data(), at, room.data());
      else if (how == "fresh")
        solve_fresh(Q, M, Penalty::norm, {lambda, 0.0}, b.col(k).data(), at);
      else
        x.col(k) *= solve_ipopt(Q, M, b.col(k), {lambda, kIpoptSmoothing}, at).iterations < 0 ? kNaN : 1.0;
    }
  return {x, (cpu_seconds() - begin) / (repeats * static_cast<double>(b.cols()))};
}

/// Seconds per step of a whole network on one core.
double network_step(const Model& model, const Network& network, const ParamMap& params, const Vector& y,
                    int steps) {
  const auto runner = make_filter("rdkf", params)->prepare(model, network)->runner(1);
  runner->reset(Matrix::Zero(model.states(), model.agents()), nullptr);
  const double begin = cpu_seconds();
  for (int t = 1; t <= steps; ++t) runner->step(t, y.data());
  return (cpu_seconds() - begin) / steps;
}

Model unit_noise(const Matrix& A, const std::vector<Matrix>& C) {
  Noise noise;
  noise.process_covariance = Matrix::Identity(A.rows(), A.rows());
  for (const Matrix& c : C) noise.measurement_covariance.push_back(Matrix::Identity(c.rows(), c.rows()));
  return {A, C, noise};
}

}  // namespace

void bind_rdkf_peers(py::module_& m) {
  m.def("rdkf_ipopt_available", &ipopt_available);
  m.def("rdkf_solve_all", &solve_all, py::arg("Q"), py::arg("M"), py::arg("b"), py::arg("x0"),
        py::arg("weight"), py::arg("how"), py::arg("repeats"));
  m.def(
      "rdkf_network_step",
      [](const Matrix& A, const std::vector<Matrix>& C, const std::vector<Edge>& edges, const Vector& y,
         int steps) {
        return network_step(unit_noise(A, C), Network(static_cast<int>(C.size()), edges), {}, y, steps);
      },
      py::arg("A"), py::arg("C"), py::arg("edges"), py::arg("y"), py::arg("steps"));
  m.def(
      "rdkf_fixed_point",
      [](const Matrix& A, const std::vector<Matrix>& C, const std::vector<Edge>& edges) {
        const Setting s = setting(unit_noise(A, C), Network(static_cast<int>(C.size()), edges));
        const double begin = cpu_seconds();
        const SteadyState steady = steady_state(s);
        return std::make_tuple(steady.P, steady.sweeps, cpu_seconds() - begin);
      },
      py::arg("A"), py::arg("C"), py::arg("edges"));
}
