// SPDX-License-Identifier: Apache-2.0
// Vehicles: their model, and the analysis of the platoon paper.
#include "bindings.hpp"
#include "garrison/filters/platoon/bounds.hpp"
#include "garrison/filters/platoon/detector.hpp"
#include "garrison/filters/platoon/loop.hpp"
#include "garrison/filters/platoon/partition.hpp"
#include "garrison/filters/platoon/theorems.hpp"
#include "garrison/filters/platoon/world.hpp"
#include "kept.hpp"

using namespace garrison;
using namespace garrison::platoon;

namespace {

py::tuple pair(const Interval& i) { return py::make_tuple(i.lo, i.hi); }

void bind_setting(py::module_& p) {
  py::class_<Setting> setting(p, "Setting",
                              numpydoc(R"(What Assumptions 1 and 2 and the observer's tuning say.

vehicles : int | N >= 2 L + 1, at least 3.
range : int | L >= 1: vehicles hear those at most L places away.
period : float | T > 0, s.
attacked : int | b, most absolute sensors attacked, 1..L.
eps : float | Bound on the process noise (m and m/s), >= 0.
mu : float | Bound on the measurement noise (m and m/s), >= 0.
q : float | Bound on the initial error (m and m/s), > 0.
varpi : float | 1/varpi is the gain of vehicles outside V_1; in (1, ||A||/(||A|| - 1)).
beta : float | Static threshold, or beta_{i,0} of (25), > 0.
adaptive : bool | Threshold of (25); False: beta throughout.
! InvalidInput | A number out of range.)")
                                  .c_str());
  setting
      .def(py::init([](int vehicles, int range, double period, int attacked, double eps, double mu, double q,
                       double varpi, double beta, bool adaptive) {
             const Setting s{vehicles, range, period, attacked, eps, mu, q, varpi, beta, adaptive};
             require(s);
             return s;
           }),
           py::kw_only(), py::arg("vehicles"), py::arg("range"), py::arg("period"), py::arg("attacked"),
           py::arg("eps"), py::arg("mu"), py::arg("q"), py::arg("varpi") = 2.0, py::arg("beta"),
           py::arg("adaptive") = true)
      .def_property_readonly(
          "norm_A", [](const Setting& s) { return norm_A(s); },
          "||A|| of A = (1 T; 0 1): T/2 + sqrt(1 + T^2/4).")
      .def_property_readonly(
          "mubar", [](const Setting& s) { return mubar(s); }, "(8)")
      .def_property_readonly(
          "beta0", [](const Setting& s) { return beta0(s); }, "(20), with mubar")
      .def_property_readonly("k0", [](const Setting& s) { return k0(s); }, "(25)");
  keep_as_code<Setting>(setting, "garrison.platoon.Setting", [](const Setting& s) {
    return py::dict(py::arg("vehicles") = s.vehicles, py::arg("range") = s.range,
                    py::arg("period") = s.period, py::arg("attacked") = s.attacked, py::arg("eps") = s.eps,
                    py::arg("mu") = s.mu, py::arg("q") = s.q, py::arg("varpi") = s.varpi,
                    py::arg("beta") = s.beta, py::arg("adaptive") = s.adaptive);
  });
}

template <auto function>
void bind_of_omega(py::module_& p, const char* name, const char* doc) {
  p.def(
      name,
      [](const Setting& s, double omega) {
        require_range("omega", omega, std::numeric_limits<double>::min());
        return function(s, omega);
      },
      py::arg("setting"), py::arg("omega"), doc);
}

/// What theorems 1 and 2 know of a vehicle: counts of sensors, and the distance to the next vehicle of V_1.
Known known(const Setting& s, int free_in_reach, int proved, int distance) {
  require_range("free_in_reach", free_in_reach, 0.0, 2.0 * s.range);
  require_range("proved", proved, 0.0, s.attacked);
  require_range("distance", distance, 1.0, s.vehicles);
  return {free_in_reach, proved, distance};
}

void bind_theorems(py::module_& p) {
  bind_of_omega<&beta1_bar>(p, "beta1_bar",
                            numpydoc(R"(Least threshold of (20).

setting : Setting | All but beta.
omega : float | > 0; the theorems take it below 1.
< float
! InvalidInput | omega is not > 0.)")
                                .c_str());
  bind_of_omega<&beta2_bar>(p, "beta2_bar",
                            numpydoc(R"(Largest threshold of (20).

setting : Setting | All but beta.
omega : float | > 0; the theorems take it below 1.
< float
! InvalidInput | omega is not > 0.)")
                                .c_str());
  bind_of_omega<&proposition2>(
      p, "proposition2",
      numpydoc(R"(Whether (23) holds: equivalent to 0 < beta1_bar < beta2_bar (docs/filters/platoon.md#e6).

setting : Setting | All but beta.
omega : float | > 0; the theorems take it below 1.
< bool
! InvalidInput | omega is not > 0.)")
          .c_str());
  bind_of_omega<&f3>(p, "f3",
                     numpydoc(R"(f_3 of (24).

setting : Setting | All of it.
omega : float | > 0; the theorems take it below 1.
< float
! InvalidInput | omega is not > 0.)")
                         .c_str());
  bind_of_omega<&f4>(p, "f4",
                     numpydoc(R"(f_4 of (24).

setting : Setting | All of it.
omega : float | > 0; the theorems take it below 1.
< float
! InvalidInput | omega is not > 0.)")
                         .c_str());
  p.def(
      "omega_interval", [](const Setting& s) { return pair(omega_interval(s)); }, py::arg("setting"),
      numpydoc(R"(All omega with 0 < beta1_bar < beta2_bar.

setting : Setting | All but beta.
< (float, float) | An open interval; nan when there is none.)")
          .c_str());
  p.def(
      "beta_interval", [](const Setting& s) { return pair(beta_interval(s)); }, py::arg("setting"),
      numpydoc(R"(All thresholds that Theorem 1 admits for some omega.

setting : Setting | All but beta.
< (float, float) | nan when there is none.)")
          .c_str());
  p.def(
      "beta_interval_safe", [](const Setting& s) { return pair(beta_interval_safe(s)); }, py::arg("setting"),
      numpydoc(R"(All thresholds with which the bound that holds contracts.

setting : Setting | All but beta.
< (float, float) | nan when there is none.)")
          .c_str());
  p.def("safe_limit", &safe_limit, py::arg("setting"),
        numpydoc(R"(Limit of the bound that holds, nobody identified.

setting : Setting | All of it.
< float | On the error of every vehicle (m and m/s); nan when it grows for ever.)")
            .c_str());
  p.def("best_threshold", &best_threshold, py::arg("setting"),
        numpydoc(R"(Threshold of beta_interval_safe with the least safe_limit under the adaptive rule.

setting : Setting | All but beta.
< float
! DesignInfeasible | There is none.)")
            .c_str());
  p.def(
      "theorem1",
      [](const Setting& s, int free_in_reach, int proved, int distance) {
        const auto b = theorem1(s, known(s, free_in_reach, proved, distance));
        return py::dict(py::arg("k_star") = b.k_star, py::arg("Q") = b.Q, py::arg("m") = b.m,
                        py::arg("alpha1") = b.alpha1, py::arg("alpha2") = b.alpha2,
                        py::arg("alpha3") = b.alpha3);
      },
      py::arg("setting"), py::kw_only(), py::arg("free_in_reach") = 0, py::arg("proved") = 0,
      py::arg("distance") = 1,
      numpydoc(R"(Theorem 1, (21) and (22) as printed; safe_limit is the bound that holds.

setting : Setting | All of it.
free_in_reach : int | |S_{i,1}|, sensors in reach known to be free, 0..2 L.
proved : int | |S^a_i|, sensors proved to be attacked, 0..b.
distance : int | |j_i - i|, places to the next vehicle of V_1, 1..N.
< dict | k_star, Q, m, and alpha1, alpha2, alpha3: asymptotic bounds (m and m/s).
! InvalidInput | A number out of range.)")
          .c_str());
  p.def(
      "theorem2",
      [](const Setting& s, int free_in_reach, int proved, int distance) {
        const auto b = theorem2(s, known(s, free_in_reach, proved, distance));
        return py::dict(py::arg("k0") = b.k0, py::arg("h1") = b.h1, py::arg("h2") = b.h2,
                        py::arg("alpha1") = b.alpha1, py::arg("alpha2") = b.alpha2,
                        py::arg("alpha3") = b.alpha3);
      },
      py::arg("setting"), py::kw_only(), py::arg("free_in_reach") = 0, py::arg("proved") = 0,
      py::arg("distance") = 1,
      numpydoc(R"(Theorem 2, (26), with 2L + 1 - b in h1, as (D.2) has it.

setting : Setting | All of it.
free_in_reach : int | |S_{i,1}|, sensors in reach known to be free, 0..2 L.
proved : int | |S^a_i|, sensors proved to be attacked, 0..b.
distance : int | |j_i - i|, places to the next vehicle of V_1, 1..N.
< dict | k0, h1, h2, and alpha1, alpha2, alpha3: asymptotic bounds (m and m/s).
! InvalidInput | A number out of range.)")
          .c_str());
}

void bind_loop(py::module_& p) {
  p.def("grounded_eigenvalues", &grounded_eigenvalues, py::arg("vehicles"),
        numpydoc(R"(Eigenvalues of the grounded Laplacian L_g.

vehicles : int | N >= 1.
< list of N float | Upwards.
! InvalidInput | vehicles < 1.)")
            .c_str());
  p.def(
      "assumption4", &assumption4, py::arg("vehicles"), py::arg("period"), py::arg("gs"), py::arg("gv"),
      numpydoc(
          R"(Assumption 4: gv > T gs > 0 and T^2 gs - 2 T gv > -4/sigma_max(L_g); the string's own loop is stable exactly
then.

vehicles : int | N >= 1.
period : float | T > 0, s.
gs : float | Gain on positions, 1/s^2.
gv : float | Gain on velocities, 1/s.
< bool
! InvalidInput | A number out of range, or not finite.)")
          .c_str());
  p.def(
      "loop_factors",
      [](int vehicles, double period, double gs, double gv) {
        const auto f = loop_factors(vehicles, period, gs, gv);
        return py::dict(py::arg("rho") = f.rho, py::arg("M_max") = f.M_max, py::arg("M_min") = f.M_min,
                        py::arg("kappa") = f.kappa, py::arg("xi") = f.xi, py::arg("l1") = f.l1);
      },
      py::arg("vehicles"), py::arg("period"), py::arg("gs"), py::arg("gv"),
      numpydoc(R"(Factors of Lemma 2 for P_0 of (31), by 2 x 2 blocks.

vehicles : int | N >= 1.
period : float | T > 0, s.
gs : float | Gain on positions, 1/s^2.
gv : float | Gain on velocities, 1/s.
< dict | rho (spectral radius of P_0), M_max, M_min, kappa, xi as printed, and l1, the sharper factor; all
  but rho nan when P_0 is not Schur.
! InvalidInput | A number out of range, or not finite.)")
          .c_str());
  p.def(
      "theorem4",
      [](int vehicles, double period, double gs, double gv, double eps, double alpha) {
        const auto b = theorem4(vehicles, period, gs, gv, eps, alpha);
        return py::dict(py::arg("eta") = b.eta, py::arg("eta_safe") = b.eta_safe, py::arg("bound") = b.bound,
                        py::arg("bound_safe") = b.bound_safe, py::arg("bound_sharp") = b.bound_sharp,
                        py::arg("spacing") = b.spacing);
      },
      py::arg("vehicles"), py::arg("period"), py::arg("gs"), py::arg("gv"), py::arg("eps"), py::arg("alpha"),
      numpydoc(R"(Limsup of phi (4), the mean deviation from the formation.

vehicles : int | N >= 1.
period : float | T > 0, s.
gs : float | Gain on positions, 1/s^2.
gv : float | Gain on velocities, 1/s.
eps : float | Bound on the process noise (m and m/s), >= 0.
alpha : float | Limsup of every vehicle's estimation error, >= 0.
< dict | eta and bound as printed; eta_safe and bound_safe with the corrected (31)
  (docs/filters/platoon.md#e5); bound_sharp with the sharper factor; spacing, of |gap - desired gap| (m).
! InvalidInput | A number out of range, or not finite.)")
          .c_str());
}

void require_vehicle(int vehicle, int vehicles) {
  require_range("vehicles", vehicles, 1.0);
  require_range("vehicle", vehicle, 0.0, vehicles - 1.0);
}

void bind_pieces(py::module_& p) {
  p.def(
      "in_V1",
      [](int vehicle, int vehicles, int range) {
        require_vehicle(vehicle, vehicles);
        require_range("range", range, 1.0);
        return in_V1(vehicle, vehicles, range);
      },
      py::arg("vehicle"), py::arg("vehicles"), py::arg("range"),
      numpydoc(R"((5): whether a vehicle hears 2 L others.

vehicle : int | 0..N-1.
vehicles : int | N >= 1.
range : int | L >= 1.
< bool
! InvalidInput | A number out of range.)")
          .c_str());
  p.def("nearest", &nearest, py::arg("vehicle"), py::arg("vehicles"),
        numpydoc(R"((30): the vehicles next to one; -1 stands for the reference, on both sides.

vehicle : int | -1 (the reference)..N-1.
vehicles : int | N >= 1.
< list of int
! InvalidInput | A number out of range.)")
            .c_str());
  p.def(
      "runs",
      [](std::vector<int> labels) {
        std::sort(labels.begin(), labels.end());
        return py::make_tuple(runs(labels), count_runs(labels));
      },
      py::arg("labels"),
      numpydoc(
          R"(Maximal runs of successive labels, and the left side of (29): at least how many attacked sensors they take.

labels : sequence of int | In any order.
< (list of lists of int, int))")
          .c_str());
  p.def(
      "gain",
      [](double beta, double eta_s, double eta_v, bool attacked, bool free) {
        require_range("beta", beta, std::numeric_limits<double>::min(), kInfinity);
        require_range("eta_s", std::abs(eta_s), 0.0);
        require_range("eta_v", std::abs(eta_v), 0.0);
        return gain(beta, length(eta_s, eta_v), attacked, free);
      },
      py::arg("beta"), py::arg("eta_s"), py::arg("eta_v"), py::kw_only(), py::arg("attacked") = false,
      py::arg("free") = false,
      numpydoc(R"((14): what is used of one innovation.

beta : float | Threshold, > 0; may be inf.
eta_s, eta_v : float | The innovation: position (m) and velocity (m/s), finite.
attacked : bool | The sensor is proved to be attacked: 0.
free : bool | It is known to be free: 1.
< float | 0..1.
! InvalidInput | A number out of range.)")
          .c_str());
  p.def(
      "best_source",
      [](int vehicle, int vehicles, int range, const std::vector<int>& free, bool by_bound,
         const std::vector<double>& alpha) {
        require_vehicle(vehicle, vehicles);
        require_range("range", range, 1.0);
        for (const int id : free) require_range("free", id, 0.0, vehicles - 1.0);
        if (alpha.size() != static_cast<std::size_t>(vehicles))
          refuse("alpha", amount(alpha.size(), "number"), "one per vehicle");
        BestSource best(by_bound);
        for (int j = 0; j < vehicles; ++j) {
          const bool candidate = (std::abs(j - vehicle) <= range && in_V1(j, vehicles, range)) ||
                                 std::find(free.begin(), free.end(), j) != free.end();
          if (j != vehicle && candidate)
            best.offer(j, std::abs(j - vehicle), alpha[static_cast<std::size_t>(j)]);
        }
        return best.id();
      },
      py::arg("vehicle"), py::arg("vehicles"), py::arg("range"), py::arg("free"), py::kw_only(),
      py::arg("by_bound"), py::arg("alpha"),
      numpydoc(R"(j_i of (13): the vehicle from which one without enough sensors in reach takes its estimate.

vehicle : int | 0..N-1.
vehicles : int | N.
range : int | L >= 1.
free : sequence of int | Vehicles whose sensors are known to be free.
by_bound : bool | Of two that are equally near take the one with the smaller alpha, else the lower one.
alpha : (N,) floats | Bound on the error of every vehicle.
< int | -1 when there is none.
! InvalidInput | A number out of range.)")
          .c_str());
}

}  // namespace

void bind_platoon(py::module_& m) {
  py::module_ p = m.def_submodule(
      "platoon", "Vehicles in a string: model and analysis. Ids 0..N-1 are the paper's 1..N.");
  p.def(
      "model", &model, py::arg("vehicles"), py::arg("period"), py::arg("inputs") = false,
      numpydoc(
          R"(Model of vehicles in a string. Outputs per vehicle: absolute position (m) and velocity (m/s), which can be
attacked; the same relative to the vehicle ahead, which cannot (not of vehicle 0).

vehicles : int | N >= 3.
period : float | Between samples, s, > 0.
inputs : bool | One output more, for recorded data: the input applied from this sample on (nan = what the
  filter commanded).
< Model
! InvalidInput | A number out of range.)")
          .c_str());
  p.attr("DISTURBANCES") = kDisturbances;
  bind_setting(p);
  bind_theorems(p);
  bind_loop(p);
  bind_pieces(p);
}
