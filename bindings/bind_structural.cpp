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
      numpydoc(
          R"(Model, graphs and noise of the structural filter's analysis, in the paper's letters. Agents have one scalar
measurement each; a relay has a row of zeros.

A : (n, n) array | Of the plant.
C : (N, n) array | Row i is c_i'.
W : (N, N) array | Mixing weights of the estimates, >= 0, rows sum to 1.
U : (N, N) array | Of 0 and 1: [i, j] = 1 when i receives y_j; the diagonal is 1.
E : (n, n) array, optional | Covariance of the process noise.
R : (N, N) array, optional | Covariance of the measurement noise.
! InvalidInput | Shapes do not fit, or W or U is no such matrix.)")
          .c_str());
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
      numpydoc(R"(The setting that a Structural filter is designed for on this model and network.

model : Model | One output per agent, with covariances.
network : Network | Of the same agents.
filter : Filter | A garrison.filters.Structural.
< Setting
! InvalidInput | They do not fit each other.)")
          .c_str());
}

void bind_errors(py::module_& m) {
  m.def("error_radius", &error_radius, py::arg("setting"), py::arg("K"),
        numpydoc(R"(rho(Ahat) of (5): errors stay bounded exactly when it is below 1.

setting : Setting | A, C, W and U are read.
K : sequence of N (n, n) arrays | Gains.
< float | Per sample.
! InvalidInput | A bad setting or gains that do not fit.)")
            .c_str());
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
      numpydoc(R"(Exact stationary moments of errors and residuals.

setting : Setting | With E and R.
K : sequence of N (n, n) arrays | Gains.
lags : int | Covariances of residuals are given up to this lag, >= 0.
< dict | rho; Q (N n, N n), covariance of the stacked error, its Q_norm and Q_agent_traces (N,);
  covariances, lags + 1 arrays (N, N) of residuals; residual_std and innovation_std (N,); dc_gain (N, N) and
  dc_error (N n, N), steady residuals and errors per unit of a constant attack.
! InvalidInput | A bad setting, or rho(Ahat) >= 1: there is no steady state.)")
          .c_str());
  m.def("step_response", &step_response, py::arg("setting"), py::arg("K"), py::arg("agent"), py::arg("rows"),
        numpydoc(R"(Noise-free residuals to a unit step on the measurement of one agent.

setting : Setting | A, C, W and U are read.
K : sequence of N (n, n) arrays | Gains.
agent : int | Who is attacked, 0..N-1.
rows : int | Samples, >= 0.
< (rows, N) array | Residuals, from the first sample of the attack on.
! InvalidInput | A bad setting, or a number out of range.)")
            .c_str());
  m.def(
      "isolation_ratios", &isolation_ratios, py::arg("setting"), py::arg("K"),
      numpydoc(
          R"((18): how much an attack on j moves the residual of i, by that of j itself, in its first sample.

setting : Setting | C and U are read.
K : sequence of N (n, n) arrays | Gains.
< (N, N) array | Row i, column j; 0 on the diagonal, inf where the denominator is 0.
! InvalidInput | A bad setting or gains that do not fit.)")
          .c_str());
  m.def("predictions", &predictions, py::arg("setting"), py::arg("estimates"),
        numpydoc(R"(sum_j W_ij A xhat_j of every agent.

setting : Setting | A and W are read.
estimates : (N, n) array | xhat of the last sample.
< (N, n) array
! InvalidInput | Shapes do not fit.)")
            .c_str());
  m.def(
      "covariance_bound",
      [](const Setting& s, const GainMatrices& K, bool printed) {
        return from_bound(covariance_bound(s, K, printed));
      },
      py::arg("setting"), py::arg("K"), py::arg("printed") = false,
      numpydoc(R"((10) and (16), bounds on the covariance of the stacked error.

setting : Setting | With E and R.
K : sequence of N (n, n) arrays | Gains.
printed : bool | Take the paper's noise term, which does not hold.
< dict | a1, a2, b, Rbar_norm, bound and Q1; inf when |Ahat|_2 >= 1.
! InvalidInput | A bad setting.)")
          .c_str());
}

void bind_detection(py::module_& m) {
  m.def("kappa", &kappa, py::arg("m"),
        numpydoc(R"(erf(m / sqrt 2): 1 - false-alarm rate at m standard deviations.

m : float | > 0.
< float | 0..1.
! InvalidInput | m is not > 0.)")
            .c_str());
  m.def("level_of_false_alarm", &level_of_false_alarm, py::arg("rate"),
        numpydoc(R"(How many standard deviations have this false-alarm rate.

rate : float | Probability per sample, above 0 and below 1.
< float | m > 0.
! InvalidInput | The rate is out of range.)")
            .c_str());
  m.def("false_alarm_of_level", &false_alarm_of_level, py::arg("ratio"),
        numpydoc(R"(False-alarm rate at which a residual of `ratio` standard deviations is just an alarm.

ratio : float | >= 0.
< float | Probability per sample.
! InvalidInput | ratio < 0.)")
            .c_str());
  m.def(
      "power",
      [](double mean, double std, double threshold) {
        require_range("mean", mean, -kHuge, kHuge);
        require_range("std", std, 0.0);
        require_range("threshold", threshold, 0.0, kInfinity);
        return power(mean, std, threshold);
      },
      py::arg("mean"), py::arg("std"), py::arg("threshold"),
      numpydoc(R"(P(|N(mean, std^2)| >= threshold): how likely the test detects an attack.

mean : float | By which the attack moves the residual.
std : float | Standard deviation of the residual, > 0.
threshold : float | Of the test, >= 0, in the same unit.
< float | Probability per sample.
! InvalidInput | A number out of range.)")
          .c_str());
  m.def("chi_square_level", &chi_square_level, py::arg("degrees"), py::arg("rate"),
        numpydoc(R"(x with P(chi-square >= x) = rate.

degrees : int | Of freedom, >= 1.
rate : float | Above 0 and below 1.
< float
! InvalidInput | A number out of range.)")
            .c_str());
  m.def(
      "thresholds",
      [](const Vector& residual_std, double level) {
        for (Eigen::Index i = 0; i < residual_std.size(); ++i)
          require_range("residual_std[" + std::to_string(i) + "]", residual_std(i), 0.0);
        return thresholds(residual_std, level);
      },
      py::arg("residual_std"), py::arg("m"),
      numpydoc(R"(m standard deviations of every residual.

residual_std : (N,) array | Standard deviations, >= 0.
m : float | > 0.
< (N,) array | In the units of the residuals.
! InvalidInput | A number out of range.)")
          .c_str());
  m.def("thresholds_printed", &thresholds_printed, py::arg("setting"), py::arg("Q1"), py::arg("m"),
        numpydoc(R"(The paper's (17), for comparison only: a variance where a deviation belongs.

setting : Setting | C and R are read.
Q1 : float | Of covariance_bound, >= 0 and finite.
m : float | > 0.
< (N,) array
! InvalidInput | A number out of range.)")
            .c_str());
  m.def("thresholds_root", &thresholds_root, py::arg("setting"), py::arg("Q1"), py::arg("m"),
        numpydoc(
            R"(m sqrt(|c_i|^2 Q1 + R_ii), the root of the printed (17): the right unit, hugely conservative.

setting : Setting | C and R are read.
Q1 : float | Of covariance_bound, >= 0 and finite.
m : float | > 0.
< (N,) array | In the units of the residuals.
! InvalidInput | A number out of range.)")
            .c_str());
  m.def("alarms", &alarms, py::arg("residuals"), py::arg("threshold"),
        numpydoc(R"(Who alarms when: |residual| >= threshold. A residual of nan is an alarm.

residuals : (T, N) array | Of every agent.
threshold : (N,) array | In the same units.
< list of T lists of int | Agents, sorted.
! InvalidInput | Shapes do not fit.)")
            .c_str());
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
      numpydoc(R"(What a constant attack on each agent can do before it is seen, at steady state.

setting : Setting | With E and R.
K : sequence of N (n, n) arrays | Gains with rho(Ahat) < 1.
false_alarm : float | Rate per sample of the tests, above 0 and below 1.
detection : float | Probability per sample that counts as seen, above 0 and below 1.
< list of N dict | smallest_seen, the least size that some agent's test sees; seen_by, that agent;
  harm_per_unit, the largest steady |mean error| per unit of attack; largest_harm, that of an attack of just
  this size.
! InvalidInput | A number out of range, or rho(Ahat) >= 1.)")
          .c_str());
  m.def("windows_naive", &windows_naive, py::arg("residuals"), py::arg("residual_std"), py::arg("window"),
        numpydoc(R"(Sums of squares over the last residuals, as if they were independent in time.

residuals : (T, N) array | Of every agent.
residual_std : (N,) array | Standard deviations, >= 0.
window : int | Samples, >= 1.
< (T, N) array | nan until a window is full.
! InvalidInput | Shapes do not fit, or a number is out of range.)")
            .c_str());
  m.def(
      "windows_exact",
      [](const MatrixRef& r, const std::vector<Matrix>& covariances) {
        return windows_exact(r, covariances);
      },
      py::arg("residuals"), py::arg("covariances"),
      numpydoc(R"(v'S^-1 v over the last residuals v, with their covariance S in time.

residuals : (T, N) array | Of every agent.
covariances : sequence of w (N, N) arrays | Of `stationary`, lags 0..w-1; w is the window.
< (T, N) array | nan until a window is full.
! InvalidInput | Shapes do not fit, or there is no covariance.)")
          .c_str());
  m.def(
      "template_statistics",
      [](const MatrixRef& r, const std::vector<Matrix>& covariances, const MatrixRef& dc_gain) {
        return template_statistics(r, covariances, dc_gain);
      },
      py::arg("residuals"), py::arg("covariances"), py::arg("dc_gain"),
      numpydoc(
          R"(Fit of every full window to the steady response to an attack on each agent; the largest names the agent.

residuals : (T, N) array | Of every agent.
covariances : sequence of w (N, N) arrays | Of `stationary`, lags 0..w-1; w is the window.
dc_gain : (N, N) array | Of `stationary`.
< (T, N) array | nan until a window is full.
! InvalidInput | Shapes do not fit, or there is no covariance.)")
          .c_str());
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
      numpydoc(
          R"(Gains and covariance bounds of the coupled Riccati recursion (docs/filters/structural.md#d-riccati).

setting : Setting | With E and R.
most_sweeps : int | 1..1e7.
tolerance : float | Relative change at which it has converged, 0..1.
< dict | K, P and Pprior: N arrays (n, n), P a bound of cov(e_i) after the measurement and Pprior before it;
  converged (else nothing is certified); sweeps.
! InvalidInput | A bad setting, or a number out of range.)")
          .c_str());
  m.def(
      "joint_kalman",
      [](const Setting& s, int most_sweeps, double tolerance) {
        require_sweeps(most_sweeps, tolerance);
        const JointGains g =
            within_budget(kInfinity, [&] { return joint_kalman(s, most_sweeps, tolerance); });
        return py::dict(py::arg("K") = g.K, py::arg("converged") = g.converged, py::arg("sweeps") = g.sweeps);
      },
      py::arg("setting"), py::arg("most_sweeps") = 20000, py::arg("tolerance") = 1e-14,
      numpydoc(R"(Gains from the joint covariance of all agents.

setting : Setting | With E and R.
most_sweeps : int | 1..1e7.
tolerance : float | Relative change at which it has converged, 0..1.
< dict | K (N arrays (n, n)), converged and sweeps.
! InvalidInput | A bad setting, or a number out of range.)")
          .c_str());
  m.def("projection_gains", &projection_gains, py::arg("setting"),
        numpydoc(R"(K_i that minimise |(I - K_i D_i) A| (Frobenius norm): closed form, no noise model.

setting : Setting | A, C and U are read.
< list of N (n, n) arrays
! InvalidInput | A bad setting.)")
            .c_str());
  m.def(
      "h2_gains",
      [](const Setting& s, const GainMatrices& start, const std::vector<int>& hubs, double epsilon) {
        return within_budget(kInfinity, [&] { return h2_gains(s, start, hubs, epsilon); });
      },
      py::arg("setting"), py::arg("start"), py::arg("hubs") = std::vector<int>{}, py::arg("epsilon") = 0.01,
      numpydoc(R"(Gains of least tr Q, under the isolation constraint (18) for some agents.

setting : Setting | With E and R.
start : sequence of N (n, n) arrays | Gains to begin with; they need not be stable.
hubs : sequence of int | Agents for which (18) is to hold; none = no constraint.
epsilon : float | Of (18), 0 <= epsilon < 1.
< list of N (n, n) arrays | With rho(Ahat) < 1.
! DesignInfeasible | With the spectral radius reached.
! InvalidInput | A bad setting, or a number out of range.)")
          .c_str());
  m.def(
      "design_gains",
      [](const Setting& s, const std::string& method) {
        const Designed d = within_budget(kInfinity, [&] { return design_gains(s, method); });
        return py::dict(py::arg("K") = d.K, py::arg("method") = d.method, py::arg("rho") = d.rho,
                        py::arg("P") = d.P);
      },
      py::arg("setting"), py::arg("method") = "auto",
      numpydoc(R"(Gains with rho(Ahat) < 1.

setting : Setting | With E and R (projection needs none).
method : str | "riccati", "kalman", "projection", "h2", or "auto", the first of riccati, kalman, h2 with
  which that holds.
< dict | K (N arrays (n, n)), method, rho, and P: bounds of cov(e_i) where the coupled Riccati recursion
  settled, else empty.
! DesignInfeasible | With the spectral radius reached.
! InvalidInput | A bad setting, or an unknown method.)")
          .c_str());
  m.def(
      "best_scalar_gain",
      [](double a, const MatrixRef& W) {
        const auto best = best_scalar_gain(a, W);
        return std::pair(best.gain, best.radius);
      },
      py::arg("a"), py::arg("W"),
      numpydoc(R"(The gain with the least spectral radius where agent 0 alone sees one scalar state
(docs/filters/structural.md#d20).

a : float | x(k+1) = a x(k) + noise.
W : (N, N) array | Mixing weights.
< (float, float) | The gain k and that radius.
! InvalidInput | A number that is not finite, or W is not square.)")
          .c_str());
}

}  // namespace

void bind_structural(py::module_& m) {
  auto s = m.def_submodule("structural", "Errors, thresholds and gain designs of the structural filter.");
  bind_setting(s);
  bind_errors(s);
  bind_detection(s);
  bind_gains(s);
}
