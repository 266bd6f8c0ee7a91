// SPDX-License-Identifier: Apache-2.0
// Analysis that needs no run: subsets, observability, the theorems of the saturation filter.
#include "bindings.hpp"
#include "budget.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/analysis/subsets.hpp"
#include "garrison/filters/saturation/coordinates.hpp"
#include "garrison/filters/saturation/design.hpp"
#include "garrison/filters/saturation/theorems.hpp"
#include "garrison/kernel/chebyshev.hpp"
#include "kept.hpp"

using namespace garrison;

namespace {

void bind_subsets(py::module_& m) {
  py::class_<SubsetBound> bound(
      m, "SubsetBound",
      "Result of a search over the s removed sensors; the true value lies in [lower, upper].\n"
      "Safe in theorems: lower of lambda0, upper of varpi and tau0.");
  using B = SubsetBound;
  keep_fields<B>(bound, "garrison.SubsetBound", KeptField{"lower", &B::lower}, KeptField{"upper", &B::upper},
                 KeptField{"exact", &B::exact}, KeptField{"removed", &B::removed},
                 KeptField{"nodes", &B::nodes}, KeptField{"method", &B::method});
  bound.def_readonly("lower", &SubsetBound::lower)
      .def_readonly("upper", &SubsetBound::upper)
      .def_readonly("exact", &SubsetBound::exact, "The search finished.")
      .def_readonly("removed", &SubsetBound::removed, "Worst set found, sorted.")
      .def_readonly("nodes", &SubsetBound::nodes)
      .def_readonly("method", &SubsetBound::method);
  const SubsetLimits limits;
  m.def(
      "lambda0",
      [](const MatrixRef& C, int s, std::int64_t max_nodes, double max_seconds) {
        require_range("max_nodes", static_cast<double>(max_nodes), 1.0);
        require_range("max_seconds", max_seconds, 0.0, kInfinity);
        return lambda0(C, s, {max_nodes, max_seconds});
      },
      py::arg("C"), py::arg("s"), py::arg("max_nodes") = limits.max_nodes,
      py::arg("max_seconds") = limits.max_seconds,
      "(6) of the saturation paper: least lambda_min(sum C_i'C_i) over all sets of N - s rows of C, (N, n).");
  m.def(
      "varpi", [](const MatrixRef& C, const MatrixRef& A, int s) { return varpi(C, A, s); }, py::arg("C"),
      py::arg("A"), py::arg("s"),
      "Theorem 3: largest ||(I - (1/N) sum C_i'C_i) A|| over sets of N - s rows.");
  m.def(
      "tau0", [](const MatrixRef& C, const MatrixRef& A, int s) { return tau0(C, A, s); }, py::arg("C"),
      py::arg("A"), py::arg("s"), "Theorem 5: largest (1/N) ||[C_i'C_i A]|| over sets of N - s rows.");
  m.def("lambda0_orthogonal", &lambda0_orthogonal, py::arg("C"), py::arg("s"),
        "Closed form of lambda0 for rows that are parallel or orthogonal; None for others.");
  m.def("observable", &observable, py::arg("A"), py::arg("C"),
        "(A, C) is observable, C (m, n). Raises InvalidInput where rounding of the numbers decides and one "
        "cannot "
        "tell;\nstructure.visibility says how far that is.");
  m.def("surely_observable", &surely_observable, py::arg("A"), py::arg("C"),
        "The same, False where one cannot tell.");
  m.def(
      "s_sparse_observable",
      [](const MatrixRef& A, const MatrixRef& C, int s, double seconds) {
        return within_budget(seconds, [&] { return s_sparse_observable(A, C, s); });
      },
      py::arg("A"), py::arg("C"), py::arg("s"), py::arg("seconds") = 30.0,
      "(A, kept rows) is observable whichever s rows of C are lost. Raises InvalidInput where seconds do not "
      "suffice.");
  m.def(
      "one_step_sparse_observable",
      [](const MatrixRef& C, int s) {
        require_range("s", s, 0.0, static_cast<double>(C.rows()));
        return one_step_sparse_observable(C, s);
      },
      py::arg("C"), py::arg("s"), "Any N - s rows of C span the state; s in 0..N.");
}

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
  s.def("feasibility_margin", &feasibility_margin, py::arg("setting"));
  s.def("minimal_rounds", py::overload_cast<const Setting&, double>(&minimal_rounds), py::arg("setting"),
        py::arg("gamma"),
        "Fewest plain rounds for which some threshold satisfies (9); None when no number is enough.");
  s.def("normA_max_exact", &normA_max_exact, py::arg("setting"));
  s.def("eps_paper", &eps_paper, py::arg("setting"));
  s.def("condition11", &condition11, py::arg("setting"));
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

void bind_analysis(py::module_& m) {
  bind_subsets(m);
  m.def(
      "chebyshev_contraction",
      [](double gamma, int rounds) {
        constexpr int most = 1'000'000;  // as many as a filter takes
        if (!(gamma >= 0.0 && gamma <= 1.0)) refuse("gamma", text(gamma), "a number in [0, 1]");
        if (rounds < 0 || rounds > most)
          refuse("rounds", std::to_string(rounds), "0.." + std::to_string(most));
        return chebyshev_contraction(gamma, rounds);
      },
      py::arg("gamma"), py::arg("rounds"),
      "What `rounds` Chebyshev-filtered rounds (0..1e6) leave of a disagreement that one plain round shrinks "
      "to\n"
      "`gamma`, in [0, 1].");
  auto s = m.def_submodule("saturation", "Theorems, conditions and design of the saturation filter.");
  bind_setting(s);
  bind_theorems(s);
  bind_coordinates(s);
}
