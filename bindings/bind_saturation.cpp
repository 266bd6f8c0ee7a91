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
      "Plant, network and tuning, reduced to what the theorems need. All sensors have rows of unit length\n"
      "and start from the same estimate.");
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
      py::arg("setting"), "(8) and (9).");
  s.def(
      "rho_sequence",
      [](const Setting& x, int T) {
        require_memory("T", std::to_string(T), 8.0 * T);
        return rho_sequence(x, T);
      },
      py::arg("setting"), py::arg("T"), "rho_0 .. rho_T of (7).");
  s.def("p_at", &p_at, py::arg("setting"), py::arg("t"), "p(t) of (10).");
  s.def(
      "F",
      [](const Setting& x, double rho) {
        require_range("rho", rho, 0.0);
        return F(x, rho);
      },
      py::arg("setting"), py::arg("rho"), "F of (8); rho finite and >= 0.");
  s.def(
      "fixed_points",
      [](const Setting& x) {
        const auto p = fixed_points(x);
        return std::pair(p.lo, p.hi);
      },
      py::arg("setting"), "Lower and upper fixed point of (7); nan where there is none.");
  s.def("feasibility_margin", &feasibility_margin, py::arg("setting"),
        "Above 0 exactly when some threshold and initial error satisfy (9) for this g; -inf when a g >= 1. "
        "Reads N, a, lambda0,\n"
        "g, s. Raises InvalidInput.");
  s.def("minimal_rounds", py::overload_cast<const Setting&, double>(&minimal_rounds), py::arg("setting"),
        py::arg("gamma"),
        "Fewest plain rounds for which some threshold satisfies (9); None when no number is enough.");
  s.def("normA_max_exact", &normA_max_exact, py::arg("setting"),
        "Supremum of ||A|| for which some threshold, initial error and rounds satisfy (9): N/(N - lambda0 + "
        "s). Reads N,\n"
        "lambda0, s. Raises InvalidInput.");
  s.def("eps_paper", &eps_paper, py::arg("setting"),
        "eps in the proof of theorem 2: (9) is feasible for 1 <= ||A|| < 1 + eps; nan unless lambda0 > s. "
        "Raises InvalidInput.");
  s.def("condition11", &condition11, py::arg("setting"),
        "Whether lambda0 > s (11), beyond rounding. Raises InvalidInput.");
  s.def(
      "beta_interval",
      [](const Setting& x) {
        const auto i = beta_interval(x);
        return std::pair(i.lo, i.hi);
      },
      py::arg("setting"), "Thresholds with (9) for the given initial error; nan when there are none.");
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
      py::arg("setting"), py::arg("varpi"), py::arg("T"), "Theorems 1 and 3 and proposition 2 with t0 = 1.");
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
      py::arg("setting"), py::arg("T"), "Theorem 4 for d = 0..s proved attackers.");
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
      py::arg("setting"), py::arg("tau0"), py::arg("varpi"), "G of theorem 5 and its spectral radius.");
  s.def(
      "best_threshold",
      [](const Setting& x, double margin) {
        const auto t = best_threshold(x, margin);
        return py::dict(py::arg("beta") = t.beta, py::arg("bound") = t.bound, py::arg("eta0") = t.eta0,
                        py::arg("beta_lo") = t.admissible.lo, py::arg("beta_hi") = t.admissible.hi);
      },
      py::arg("setting"), py::arg("margin") = kEdgeMargin,
      "Threshold with the least certified asymptotic bound.");
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
      "Rounds and threshold that minimise the certified bound: of all rounds in least..most whose bound is\n"
      "at most (1 + slack) times the best, the fewest. gamma is the contraction of one round.");
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
      "Unit rows, with the noise bounds and the factors for y that belong to them.");
  s.def(
      "scale_states",
      [](const MatrixRef& A, const MatrixRef& C, double b_w, const VectorRef& b_v, const VectorRef& tau) {
        return from_coordinates(scale_states(A, C, b_w, b_v, tau));
      },
      py::arg("A"), py::arg("C"), py::arg("b_w"), py::arg("b_v"), py::arg("tau"),
      "Coordinates z = diag(tau) x.");
  s.def(
      "whiten",
      [](const MatrixRef& A, const MatrixRef& C, double b_w, const VectorRef& b_v) {
        return from_coordinates(whiten(A, C, b_w, b_v));
      },
      py::arg("A"), py::arg("C"), py::arg("b_w"), py::arg("b_v"),
      "Coordinates in which sum C_i'C_i was the identity.");
}

}  // namespace

void bind_saturation(py::module_& m) {
  auto s = m.def_submodule("saturation", "Theorems, conditions and design of the saturation filter.");
  bind_setting(s);
  bind_theorems(s);
  bind_coordinates(s);
}
