// SPDX-License-Identifier: Apache-2.0
// Analysis and design of the structural filter.
#include "bindings.hpp"
#include "budget.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/structural/detection.hpp"
#include "garrison/filters/structural/filter.hpp"
#include "garrison/filters/structural/gains.hpp"
#include "kept.hpp"

using namespace garrison;
using namespace garrison::structural;

namespace {

py::dict from_bound(const CovarianceBound& b) {
  return py::dict(py::arg("a1") = b.a1, py::arg("a2") = b.a2, py::arg("b") = b.b,
                  py::arg("Rbar_norm") = b.Rbar_norm, py::arg("bound") = b.bound, py::arg("Q1") = b.Q1);
}

Stationary stationary_of(const Setting& s, const GainMatrices& K, int lags) {
  const py::gil_scoped_release no_gil;
  return stationary(s, K, lags);
}

void bind_setting(py::module_& m) {
  py::class_<Setting> setting(
      m, "Setting",
      "Model, graphs and noise of the structural filter's analysis, in the paper's letters.\n"
      "A (n, n), C (N, n), W and U (N, N), E (n, n), R (N, N).");
  setting
      .def(py::init([](const Matrix& A, const Matrix& C, const Matrix& W, const Matrix& U,
                       const std::optional<Matrix>& E, const std::optional<Matrix>& R) {
             Setting s{A, C, W, U, E.value_or(Matrix()), R.value_or(Matrix())};
             require_graphs(s);
             return s;
           }),
           py::kw_only(), py::arg("A"), py::arg("C"), py::arg("W"), py::arg("U"), py::arg("E") = py::none(),
           py::arg("R") = py::none())
      .def_readonly("A", &Setting::A, "(n, n)")
      .def_readonly("C", &Setting::C, "(N, n), row i = c_i'")
      .def_readonly("W", &Setting::W, "(N, N): mixing weights of the estimates, >= 0, rows sum to 1.")
      .def_readonly("U", &Setting::U, "(N, N) of 0 and 1: [i, j] = 1 when i receives y_j.")
      .def_readonly("E", &Setting::E, "(n, n): covariance of the process noise.")
      .def_readonly("R", &Setting::R, "(N, N): covariance of the measurement noise.");
  keep_as_code<Setting>(setting, "garrison.structural.Setting", [](const Setting& s) {
    py::dict all(py::arg("A") = s.A, py::arg("C") = s.C, py::arg("W") = s.W, py::arg("U") = s.U);
    if (s.E.size() != 0) all["E"] = s.E;
    if (s.R.size() != 0) all["R"] = s.R;
    return all;
  });
  m.def(
      "setting",
      [](const Model& model, const Network& network, const FilterHandle& f) {
        require_same_size(model, network);
        return Structural::setting(params_of<Structural>(f), model, network);
      },
      py::arg("model"), py::arg("network"), py::arg("filter"),
      "The setting that a Structural filter is designed for on this model and network.");
}

void bind_errors(py::module_& m) {
  m.def("error_radius", &error_radius, py::arg("setting"), py::arg("K"), "rho(Ahat) of (5).");
  m.def(
      "stationary",
      [](const Setting& s, const GainMatrices& K, int lags) {
        auto x = stationary_of(s, K, lags);
        Vector traces(s.N());
        for (Eigen::Index i = 0; i < s.N(); ++i)
          traces(i) = x.Q.block(i * s.n(), i * s.n(), s.n(), s.n()).trace();
        const double norm = s.N() * s.n() == 0 ? 0.0 : spectral_radius(x.Q);
        return py::dict(py::arg("rho") = x.rho, py::arg("Q") = x.Q, py::arg("Q_norm") = norm,
                        py::arg("Q_agent_traces") = traces, py::arg("covariances") = x.covariances,
                        py::arg("residual_std") = x.residual_std,
                        py::arg("innovation_std") = x.innovation_std, py::arg("dc_gain") = x.dc_gain,
                        py::arg("dc_error") = x.dc_error);
      },
      py::arg("setting"), py::arg("K"), py::arg("lags") = 0,
      "Exact stationary moments of errors and residuals; refuses rho(Ahat) >= 1.");
  m.def("step_response", &step_response, py::arg("setting"), py::arg("K"), py::arg("agent"), py::arg("rows"),
        "Noise-free residuals (rows, N) to a unit step on y_agent.");
  m.def("isolation_ratios", &isolation_ratios, py::arg("setting"), py::arg("K"), "(18), (N, N).");
  m.def("predictions", &predictions, py::arg("setting"), py::arg("estimates"),
        "sum_j W_ij A xhat_j, (N, n) from (N, n).");
  m.def(
      "covariance_bound",
      [](const Setting& s, const GainMatrices& K, bool printed) {
        return from_bound(covariance_bound(s, K, printed));
      },
      py::arg("setting"), py::arg("K"), py::arg("printed") = false,
      "(10) and (16); printed = True takes the paper's noise term, which does not hold.");
}

void bind_detection(py::module_& m) {
  m.def("kappa", &kappa, py::arg("m"), "erf(m / sqrt 2): 1 - false-alarm rate at m standard deviations.");
  m.def("level_of_false_alarm", &level_of_false_alarm, py::arg("rate"), "m with this false-alarm rate.");
  m.def("false_alarm_of_level", &false_alarm_of_level, py::arg("ratio"),
        "False-alarm rate at which a residual of `ratio` standard deviations is just an alarm.");
  m.def(
      "power",
      [](double mean, double std, double threshold) {
        require_range("mean", mean, -kHuge, kHuge);
        require_range("std", std, 0.0);
        require_range("threshold", threshold, 0.0, kInfinity);
        return power(mean, std, threshold);
      },
      py::arg("mean"), py::arg("std"), py::arg("threshold"), "P(|N(mean, std^2)| >= threshold).");
  m.def("chi_square_level", &chi_square_level, py::arg("degrees"), py::arg("rate"),
        "x with P(chi-square with `degrees` >= x) = rate, 0 < rate < 1, degrees >= 1. Raises InvalidInput.");
  m.def(
      "thresholds",
      [](const Vector& residual_std, double level) {
        for (Eigen::Index i = 0; i < residual_std.size(); ++i)
          require_range("residual_std[" + std::to_string(i) + "]", residual_std(i), 0.0);
        return thresholds(residual_std, level);
      },
      py::arg("residual_std"), py::arg("m"), "m standard deviations of every residual.");
  m.def("thresholds_printed", &thresholds_printed, py::arg("setting"), py::arg("Q1"), py::arg("m"),
        "The paper's (17), for comparison only.");
  m.def(
      "thresholds_root", &thresholds_root, py::arg("setting"), py::arg("Q1"), py::arg("m"),
      "(N,): m sqrt(|c_i|^2 Q1 + R_ii), the root of the printed (17): the right unit, hugely conservative.");
  m.def("alarms", &alarms, py::arg("residuals"), py::arg("threshold"),
        "Agents with |r| >= threshold per row of residuals (T, N); nan is an alarm.");
  m.def(
      "exposure",
      [](const Setting& s, const GainMatrices& K, double false_alarm, double detection) {
        py::list all;
        for (const auto& e : exposure(s, stationary_of(s, K, 0), false_alarm, detection))
          all.append(py::dict(py::arg("smallest_seen") = e.smallest_seen, py::arg("seen_by") = e.seen_by,
                              py::arg("harm_per_unit") = e.harm_per_unit,
                              py::arg("largest_harm") = e.largest_harm));
        return all;
      },
      py::arg("setting"), py::arg("K"), py::arg("false_alarm") = 0.01, py::arg("detection") = 0.99,
      "What a constant attack on each agent can do before it is seen, at steady state: the least size that\n"
      "some agent's test detects with probability `detection` per sample and that agent, the largest steady\n"
      "|mean error| per unit of attack, and that of an attack of just this size.");
  m.def("windows_naive", &windows_naive, py::arg("residuals"), py::arg("residual_std"), py::arg("window"),
        "(T, N): sums of squares over the last `window` residuals (T, N), as if they were independent in "
        "time; nan until it\n"
        "is full.");
  m.def(
      "windows_exact",
      [](const MatrixRef& r, const std::vector<Matrix>& covariances) {
        return windows_exact(r, covariances);
      },
      py::arg("residuals"), py::arg("covariances"), "v'S^-1 v over the last len(covariances) residuals.");
  m.def(
      "template_statistics",
      [](const MatrixRef& r, const std::vector<Matrix>& covariances, const MatrixRef& dc_gain) {
        return template_statistics(r, covariances, dc_gain);
      },
      py::arg("residuals"), py::arg("covariances"), py::arg("dc_gain"),
      "Fit of every full window to the response to an attack on each agent.");
}

void require_sweeps(int most_sweeps, double tolerance) {
  require_range("most_sweeps", most_sweeps, 1.0, 1e7);
  require_range("tolerance", tolerance, 0.0, 1.0);
}

void bind_gains(py::module_& m) {
  m.def(
      "coupled_riccati",
      [](const Setting& s, int most_sweeps, double tolerance) {
        require_sweeps(most_sweeps, tolerance);
        const RiccatiGains g =
            within_budget(kInfinity, [&] { return coupled_riccati(s, most_sweeps, tolerance); });
        return py::dict(py::arg("K") = g.K, py::arg("P") = g.P, py::arg("Pprior") = g.Pprior,
                        py::arg("converged") = g.converged, py::arg("sweeps") = g.sweeps);
      },
      py::arg("setting"), py::arg("most_sweeps") = 20000, py::arg("tolerance") = 1e-14,
      "Gains and covariance bounds of the coupled Riccati recursion.");
  m.def(
      "joint_kalman",
      [](const Setting& s, int most_sweeps, double tolerance) {
        require_sweeps(most_sweeps, tolerance);
        const JointGains g =
            within_budget(kInfinity, [&] { return joint_kalman(s, most_sweeps, tolerance); });
        return py::dict(py::arg("K") = g.K, py::arg("converged") = g.converged, py::arg("sweeps") = g.sweeps);
      },
      py::arg("setting"), py::arg("most_sweeps") = 20000, py::arg("tolerance") = 1e-14,
      "Gains K (N arrays (n, n)) from the joint covariance of all agents, whether they converged, and "
      "sweeps.");
  m.def(
      "projection_gains", &projection_gains, py::arg("setting"),
      "K_i that minimise |(I - K_i D_i) A| (Frobenius norm), N arrays (n, n): closed form, no noise model.");
  m.def(
      "h2_gains",
      [](const Setting& s, const GainMatrices& start, const std::vector<int>& hubs, double epsilon) {
        return within_budget(kInfinity, [&] { return h2_gains(s, start, hubs, epsilon); });
      },
      py::arg("setting"), py::arg("start"), py::arg("hubs") = std::vector<int>{}, py::arg("epsilon") = 0.01,
      "Gains of least tr Q, under the isolation constraint (18) for `hubs`.");
  m.def(
      "design_gains",
      [](const Setting& s, const std::string& method) {
        const Designed d = within_budget(kInfinity, [&] { return design_gains(s, method); });
        return py::dict(py::arg("K") = d.K, py::arg("method") = d.method, py::arg("rho") = d.rho,
                        py::arg("P") = d.P);
      },
      py::arg("setting"), py::arg("method") = "auto",
      "Gains with rho(Ahat) < 1: method \"riccati\", \"kalman\", \"projection\", \"h2\", or \"auto\", the\n"
      "first of riccati, kalman, h2 with which that holds. P bounds cov(e_i) where the coupled Riccati\n"
      "recursion settled, else it is empty. Raises DesignInfeasible with the spectral radius reached.");
  m.def(
      "best_scalar_gain",
      [](double a, const MatrixRef& W) {
        const auto best = best_scalar_gain(a, W);
        return std::pair(best.gain, best.radius);
      },
      py::arg("a"), py::arg("W"), "(k, least spectral radius) where agent 0 alone sees one scalar state.");
}

}  // namespace

void bind_structural(py::module_& m) {
  auto s = m.def_submodule("structural", "Errors, thresholds and gain designs of the structural filter.");
  bind_setting(s);
  bind_errors(s);
  bind_detection(s);
  bind_gains(s);
}
