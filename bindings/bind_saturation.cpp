// SPDX-License-Identifier: Apache-2.0
// The theorems of the saturation filter: setting, conditions, bounds, design, coordinates.
#include "bindings.hpp"
#include "garrison/filters/saturation/coordinates.hpp"
#include "garrison/filters/saturation/design.hpp"
#include "garrison/filters/saturation/theorems.hpp"
#include "garrison/kernel/chebyshev.hpp"
#include "kept.hpp"

using namespace garrison;

namespace {

void bind_setting(py::module_& s) {
  using namespace saturation;
  py::class_<Setting> setting(
      s, "Setting",
      numpydoc(
          R"(Plant, network and tuning, reduced to what the theorems need. All sensors have rows of unit length and start
from the same estimate.

agents : int | N >= 1.
a : float | ||A||, spectral norm, >= 0.
lambda0 : float | (6), or a certified lower bound of it (safe in every theorem), 0..N - s.
contraction : float | g, what the rounds of a sample leave of a disagreement, 0..1.
attacked : int | s, most sensors attacked at a time, 0..N.
beta : float | Threshold, > 0, unit of the measurement; nan where a function does not read it.
eta0 : float | Bound on the initial error, > 0, unit of the state; nan likewise.
b_w : float | ||w(t)|| <= b_w, >= 0.
b_v : float | |v_i(t)| <= b_v of every sensor, >= 0.
sharp : bool | The smaller q0 that is as sound (docs/filters/saturation.md#s6); False: as printed in (8).)")
          .c_str());
  setting.def(py::init([](int agents, double a, double lambda0_value, double contraction, int attacked,
                          double beta, double eta0, double b_w, double b_v, bool sharp) {
                return Setting{agents, a, lambda0_value, contraction, attacked, beta, eta0, b_w, b_v, sharp};
              }),
              py::kw_only(), py::arg("agents"), py::arg("a"), py::arg("lambda0"), py::arg("contraction"),
              py::arg("attacked"), py::arg("beta") = kNaN, py::arg("eta0") = kNaN, py::arg("b_w") = kNaN,
              py::arg("b_v") = kNaN, py::arg("sharp") = false);
  keep_as_code<Setting>(setting, "garrison.saturation.Setting", [](const Setting& x) {
    return py::dict(py::arg("agents") = x.agents, py::arg("a") = x.a, py::arg("lambda0") = x.lambda0,
                    py::arg("contraction") = x.contraction, py::arg("attacked") = x.attacked,
                    py::arg("beta") = x.beta, py::arg("eta0") = x.eta0, py::arg("b_w") = x.b_w,
                    py::arg("b_v") = x.b_v, py::arg("sharp") = x.sharp);
  });
  s.def(
      "constants",
      [](const Setting& x) {
        const auto c = constants(x);
        return py::dict(py::arg("p0") = c.p0, py::arg("q0") = c.q0, py::arg("F_eta0") = c.F_eta0,
                        py::arg("cond9_margin") = c.cond9_margin, py::arg("cond9") = c.cond9);
      },
      py::arg("setting"),
      numpydoc(R"(The constants of (8), and condition (9).

setting : Setting | All of it.
< dict | p0, q0, F_eta0 (F at eta0), cond9_margin, and cond9: whether (9) holds.
! InvalidInput | A bad setting, or a g >= 1.)")
          .c_str());
  s.def(
      "rho_sequence",
      [](const Setting& x, int T) {
        require_memory("T", std::to_string(T), 8.0 * T);
        return rho_sequence(x, T);
      },
      py::arg("setting"), py::arg("T"),
      numpydoc(R"(rho_0 .. rho_T of (7), the bound on the mean error.

setting : Setting | All of it.
T : int | Samples, >= 0.
< list of float | T + 1 numbers, unit of the state.
! InvalidInput | A bad setting, a g >= 1, or T < 0.)")
          .c_str());
  s.def("p_at", &p_at, py::arg("setting"), py::arg("t"),
        numpydoc(R"(p(t) of (10), the bound on the disagreement.

setting : Setting | All of it.
t : int | Sample, >= 0.
< float | Unit of the state.
! InvalidInput | A bad setting, a g >= 1, or t < 0.)")
            .c_str());
  s.def(
      "F",
      [](const Setting& x, double rho) {
        require_range("rho", rho, 0.0);
        return F(x, rho);
      },
      py::arg("setting"), py::arg("rho"),
      numpydoc(R"(F of (8).

setting : Setting | All of it.
rho : float | Bound on the mean error, >= 0.
< float
! InvalidInput | A bad setting, a g >= 1, or rho < 0.)")
          .c_str());
  s.def(
      "fixed_points",
      [](const Setting& x) {
        const auto p = fixed_points(x);
        return std::pair(p.lo, p.hi);
      },
      py::arg("setting"),
      numpydoc(R"(The fixed points of (7).

setting : Setting | All of it.
< (float, float) | The lower and the upper one; nan where there is none.
! InvalidInput | A bad setting, or a g >= 1.)")
          .c_str());
  s.def("feasibility_margin", &feasibility_margin, py::arg("setting"),
        numpydoc(R"(How far (9) is from having no threshold and initial error for this g.

setting : Setting | N, a, lambda0, g and s are read.
< float | Above 0 exactly when there are some; -inf when a g >= 1.
! InvalidInput | A bad setting.)")
            .c_str());
  s.def("minimal_rounds", py::overload_cast<const Setting&, double>(&minimal_rounds), py::arg("setting"),
        py::arg("gamma"),
        numpydoc(R"(Fewest plain rounds for which some threshold satisfies (9).

setting : Setting | N, a, lambda0 and s are read.
gamma : float | Contraction of one round, 0 <= gamma < 1.
< int or None | None when no number of rounds is enough.
! InvalidInput | A bad setting or gamma.)")
            .c_str());
  s.def(
      "normA_max_exact", &normA_max_exact, py::arg("setting"),
      numpydoc(
          R"(Supremum of ||A|| for which some threshold, initial error and rounds satisfy (9): N/(N - lambda0 + s).

setting : Setting | N, lambda0 and s are read.
< float
! InvalidInput | A bad setting.)")
          .c_str());
  s.def("eps_paper", &eps_paper, py::arg("setting"),
        numpydoc(R"(eps in the proof of theorem 2: (9) is feasible for 1 <= ||A|| < 1 + eps.

setting : Setting | N, lambda0 and s are read.
< float | nan unless lambda0 > s.
! InvalidInput | A bad setting.)")
            .c_str());
  s.def("condition11", &condition11, py::arg("setting"),
        numpydoc(R"(Whether lambda0 > s (11), beyond rounding.

setting : Setting | N, lambda0 and s are read.
< bool
! InvalidInput | A bad setting.)")
            .c_str());
  s.def(
      "beta_interval",
      [](const Setting& x) {
        const auto i = beta_interval(x);
        return std::pair(i.lo, i.hi);
      },
      py::arg("setting"),
      numpydoc(R"(The thresholds with (9) for the given initial error.

setting : Setting | All of it but beta.
< (float, float) | Least and largest; nan when there are none.
! InvalidInput | A bad setting.)")
          .c_str());
}

void bind_theorems(py::module_& s) {
  using namespace saturation;
  s.def(
      "theorem_bounds",
      [](const Setting& x, double varpi_value, int T) {
        require_range("varpi", varpi_value, 0.0);
        require_memory("T", std::to_string(T), 32.0 * T);
        const auto b = theorem_bounds(x, varpi_value, T);
        return py::dict(py::arg("cond9") = b.cond9, py::arg("thm1_item1") = b.thm1_item1,
                        py::arg("thm1_item2") = b.thm1_item2, py::arg("thm1_item3") = b.thm1_item3,
                        py::arg("prop2_f") = b.prop2_f, py::arg("cond12_margin") = b.cond12_margin,
                        py::arg("cond12") = b.cond12, py::arg("thm3_item2") = b.thm3_item2,
                        py::arg("thm3_item3") = b.thm3_item3);
      },
      py::arg("setting"), py::arg("varpi"), py::arg("T"),
      numpydoc(R"(Theorems 1 and 3 and proposition 2 with t0 = 1. Entry t - 1 of a list belongs to sample t.

setting : Setting | All of it.
varpi : float | Of theorem 3, or an upper bound of it, >= 0.
T : int | Length of the lists, >= 1.
< dict | cond9, and where it holds thm1_item1 (list), thm1_item2, thm1_item3, prop2_f, cond12_margin,
  cond12, and where that holds thm3_item2 (list), thm3_item3. Bounds on the error of every agent, unit of
  the state; nan or empty where a theorem does not apply.
! InvalidInput | A bad setting, varpi < 0 or T < 1.)")
          .c_str());
  s.def(
      "theorem4",
      [](const Setting& x, int T) {
        require_memory("T", std::to_string(T), 8.0 * T);
        py::list all;
        for (const auto& b : theorem4(x, T))
          all.append(py::dict(py::arg("T") = T, py::arg("d") = b.d, py::arg("rho_T") = b.rho_T,
                              py::arg("qbar") = b.qbar, py::arg("rhobar_limit") = b.rhobar_limit,
                              py::arg("F_star") = b.F_star, py::arg("W") = b.W, py::arg("tight") = b.tight));
        return all;
      },
      py::arg("setting"), py::arg("T"),
      numpydoc(R"(Theorem 4 for d = 0..s proved attackers.

setting : Setting | All of it.
T : int | The sample at which they are proved, >= 0.
< list of dict | T, d, rho_T, qbar, rhobar_limit, F_star, W (as printed) and tight (what the proof gives:
  use this one), each a bound in the unit of the state; empty when (9) fails or a g >= 1.
! InvalidInput | A bad setting, or T < 0.)")
          .c_str());
  s.def(
      "theorem5",
      [](const Setting& x, double tau0_value, double varpi_value) {
        require_range("tau0", tau0_value, 0.0);
        require_range("varpi", varpi_value, 0.0);
        const auto g = theorem5(x, tau0_value, varpi_value);
        Matrix G(2, 2);
        G << g.g11, g.g12, g.g21, g.g22;
        return std::pair(G, g.spectral_radius);
      },
      py::arg("setting"), py::arg("tau0"), py::arg("varpi"),
      numpydoc(
          R"(G of theorem 5: noise-free errors vanish when it is Schur, (9) holds and all s attackers are proved.

setting : Setting | All of it.
tau0, varpi : float | As in theorem 5, or upper bounds, >= 0.
< ((2, 2) array, float) | G and its spectral radius.
! InvalidInput | A bad setting, or a negative number.)")
          .c_str());
  s.def(
      "best_threshold",
      [](const Setting& x, double margin) {
        const auto t = best_threshold(x, margin);
        return py::dict(py::arg("beta") = t.beta, py::arg("bound") = t.bound, py::arg("eta0") = t.eta0,
                        py::arg("beta_lo") = t.admissible.lo, py::arg("beta_hi") = t.admissible.hi);
      },
      py::arg("setting"), py::arg("margin") = kEdgeMargin,
      numpydoc(R"(Threshold with the least certified asymptotic bound.

setting : Setting | All of it but beta.
margin : float | How far above the least admissible threshold it stays, relative, >= 0.
< dict | beta, bound (on the error of every agent as t goes to infinity), eta0 to run with, and beta_lo,
  beta_hi: the admissible thresholds.
! DesignInfeasible | No threshold is admissible, or the bound only falls as beta goes to 0.
! InvalidInput | A bad setting.)")
          .c_str());
  s.def(
      "design",
      [](const Setting& x, double gamma, bool chebyshev, int least, int most, double slack) {
        const auto d = design_rounds_and_threshold(
            x, [&](int L) { return chebyshev ? chebyshev_contraction(gamma, L) : std::pow(gamma, L); }, least,
            most, slack);
        return py::dict(py::arg("rounds") = d.rounds, py::arg("contraction") = d.contraction,
                        py::arg("beta") = d.threshold.beta, py::arg("bound") = d.threshold.bound,
                        py::arg("eta0") = d.threshold.eta0, py::arg("fewest_rounds") = d.fewest_rounds);
      },
      py::arg("setting"), py::arg("gamma"), py::kw_only(), py::arg("chebyshev") = false, py::arg("least") = 1,
      py::arg("most") = 200, py::arg("slack") = 1e-9,
      numpydoc(
          R"(Rounds and threshold that minimise the certified bound: of all rounds in least..most whose bound is at most
(1 + slack) times the best, the fewest.

setting : Setting | All of it but beta and contraction.
gamma : float | Contraction of one round, 0 <= gamma < 1.
chebyshev : bool | Chebyshev-filtered rounds.
least, most : int | Range of the rounds, 1 <= least <= most.
slack : float | What a smaller number of rounds may cost, relative, >= 0.
< dict | rounds, contraction, beta, bound, eta0 as in best_threshold, and fewest_rounds for which (9) has a
  solution.
! DesignInfeasible | As best_threshold, also when `most` rounds are too few.
! InvalidInput | A bad setting, gamma or range.)")
          .c_str());
}

py::dict from_coordinates(const saturation::Coordinates& c) {
  return py::dict(py::arg("T") = c.T, py::arg("A") = c.A, py::arg("C") = c.rows.C,
                  py::arg("b_v") = c.rows.b_v, py::arg("scale") = c.rows.scale, py::arg("b_w") = c.b_w,
                  py::arg("stretch") = c.stretch, py::arg("shrink") = c.shrink);
}

void bind_coordinates(py::module_& s) {
  using namespace saturation;
  s.def(
      "normalise_rows",
      [](const MatrixRef& C, const VectorRef& b_v) {
        const auto rows = normalise_rows(C, b_v);
        return py::dict(py::arg("C") = rows.C, py::arg("b_v") = rows.b_v, py::arg("scale") = rows.scale);
      },
      py::arg("C"), py::arg("b_v"),
      numpydoc(R"(Unit rows, with the noise bounds and the factors for y that belong to them.

C : (N, n) array | One row per sensor, none of them 0.
b_v : (N,) array | Bounds on their noise, >= 0.
< dict | C (N, n), b_v (N,), and scale (N,): multiply y_i by scale_i before filtering.
! InvalidInput | A row of zeros, a wrong size or a bad number.)")
          .c_str());
  s.def(
      "scale_states",
      [](const MatrixRef& A, const MatrixRef& C, double b_w, const VectorRef& b_v, const VectorRef& tau) {
        return from_coordinates(scale_states(A, C, b_w, b_v, tau));
      },
      py::arg("A"), py::arg("C"), py::arg("b_w"), py::arg("b_v"), py::arg("tau"),
      numpydoc(R"(Coordinates z = diag(tau) x. They bring ||A|| of a chain of integrators near 1.

A : (n, n) array | Of the plant.
C : (N, n) array | One row per sensor, none of them 0.
b_w : float | Bound on the process noise, >= 0.
b_v : (N,) array | Bounds on the measurement noise, >= 0.
tau : (n,) array | Factors, > 0.
< dict | T (n, n) with z = T x; A, C, b_w, b_v, scale of the new coordinates; stretch = ||T|| (of initial
  errors) and shrink = ||T^-1|| (of error bounds, back to x).
! InvalidInput | A row of zeros, a wrong size or a bad number.)")
          .c_str());
  s.def(
      "whiten",
      [](const MatrixRef& A, const MatrixRef& C, double b_w, const VectorRef& b_v) {
        return from_coordinates(whiten(A, C, b_w, b_v));
      },
      py::arg("A"), py::arg("C"), py::arg("b_w"), py::arg("b_v"),
      numpydoc(
          R"(Coordinates z = T x with T'T = sum C_i'C_i, T symmetric: the rows of C point in all directions alike, which
raises lambda0.

A : (n, n) array | Of the plant.
C : (N, n) array | One row per sensor, none of them 0.
b_w : float | Bound on the process noise, >= 0.
b_v : (N,) array | Bounds on the measurement noise, >= 0.
< dict | As scale_states.
! InvalidInput | As scale_states, also when the sum is singular.)")
          .c_str());
}

}  // namespace

void bind_saturation(py::module_& m) {
  auto s = m.def_submodule("saturation", "Theorems, conditions and design of the saturation filter.");
  bind_setting(s);
  bind_theorems(s);
  bind_coordinates(s);
}
