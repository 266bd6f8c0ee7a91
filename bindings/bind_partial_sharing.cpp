// SPDX-License-Identifier: Apache-2.0
// Analysis and attack design of the partial-sharing filter.
#include "bindings.hpp"
#include "garrison/filters/partial_sharing/attack.hpp"
#include "garrison/filters/partial_sharing/errors.hpp"
#include "kept.hpp"

using namespace garrison;
using namespace garrison::partial_sharing;

namespace {

void require_steps(const char* which, int steps) {
  constexpr int most = 1'000'000;  // minutes of matrix products; the steady states are there for the limit
  if (steps < 0 || steps > most) refuse(which, std::to_string(steps), "0.." + std::to_string(most));
}

/// A setting with its steady gains, which are computed when first needed.
class Analysis {
 public:
  Analysis(const Model& model, const Network& network, const FilterHandle& f)
      : setting(make_setting(params_of<PartialSharing>(f), model,
                             (require_same_size(model, network), network))) {}
  const std::vector<LocalGains>& steady() const {
    if (gains_.empty()) gains_ = steady_gains(setting);
    return gains_;
  }
  /// Checked attack covariance; empty for None.
  Matrix attack(const std::optional<Matrix>& Sigma, const std::optional<std::vector<int>>& byzantine) const {
    for (const int agent : byzantine.value_or(std::vector<int>()))
      require_range("byzantine", agent, 0.0, setting.agents() - 1.0);
    if (!Sigma) return {};
    std::vector<int> everybody;
    for (int i = 0; i < setting.agents(); ++i) everybody.push_back(i);
    check_attack(setting, *Sigma, byzantine.value_or(everybody));
    return *Sigma;
  }

  Setting setting;

 private:
  mutable std::vector<LocalGains> gains_;
};

py::dict gains_dict(const std::vector<LocalGains>& gains) {
  py::list P, K, C, F;
  for (const LocalGains& g : gains) {
    P.append(g.P);
    K.append(g.K);
    C.append(g.C);
    F.append(g.F);
  }
  return py::dict(py::arg("P") = P, py::arg("K") = K, py::arg("C") = C, py::arg("F") = F);
}

py::dict trajectory_dict(const Trajectory& t) {
  // A map would be handed over as a view of memory that is gone by then.
  const Vector nmse = Eigen::Map<const Vector>(t.nmse.data(), static_cast<Eigen::Index>(t.nmse.size()));
  return py::dict(py::arg("nmse") = nmse, py::arg("P") = t.P);
}

Matrix moments_of(const Analysis& a, const std::string& moments) {
  if (moments == "p_e") return Matrix::Constant(1, 1, a.setting.shared_fraction());
  if (moments == "uniform") return a.setting.selection.moments_uniform();
  if (moments == "cycle") return a.setting.selection.moments_cycle();
  if (moments == "full") return Matrix::Ones(1, 1);
  refuse("moments", "\"" + moments + "\"", "one of: p_e, uniform, cycle, full");
}

struct WorstAttack : AnyAttack {
  WorstCovariance worst;
};

WorstAttack worst_attack(Schedule schedule, WorstCovariance worst) {
  const Matrix rows = worst.covariance.transpose();  // an attack takes its matrix row by row
  WorstAttack w;
  static_cast<AnyAttack&>(w) =
      make_attack("coordinated", std::move(schedule),
                  {{"covariance", std::vector<double>(rows.data(), rows.data() + rows.size())}});
  w.worst = std::move(worst);
  return w;
}

py::dict state_of(const WorstAttack& w) {
  const Schedule& schedule = w.schedule();
  return py::dict(py::arg("start") = schedule.first(), py::arg("agents") = schedule.everyone(),
                  py::arg("stop") = schedule.stop(), py::arg("covariance") = w.worst.covariance,
                  py::arg("form") = w.worst.form, py::arg("direction") = w.worst.direction,
                  py::arg("gain") = w.worst.gain);
}

WorstAttack worst_from(const py::dict& state) {
  WorstCovariance worst;
  worst.byzantine = state["agents"].cast<std::vector<int>>();
  worst.covariance = state["covariance"].cast<Matrix>();
  worst.form = state["form"].cast<Matrix>();
  worst.direction = state["direction"].cast<Vector>();
  worst.gain = state["gain"].cast<double>();
  Schedule schedule(state["start"].cast<std::int64_t>(), worst.byzantine, state["stop"].cast<std::int64_t>());
  return worst_attack(std::move(schedule), std::move(worst));
}

using Sigma = std::optional<Matrix>;
using Agents = std::optional<std::vector<int>>;

void bind_selection(py::module_& s) {
  py::class_<Selection> selection(s, "Selection", "Which entries every agent shares, and when.");
  selection
      .def(py::init([](const Matrix& start, std::int64_t shift) { return Selection(start, shift); }),
           py::arg("start"), py::arg("shift"), "start: (N, m) of zeros and ones; shift: tau.")
      .def_property_readonly("period", &Selection::period, "Samples until all selections repeat.")
      .def_property_readonly("shift", &Selection::shift, "tau mod m.")
      .def_property_readonly("frequency", &Selection::frequency,
                             "(N, m): share of the samples in which each entry is sent.")
      .def("at", &Selection::at, py::arg("k"), "s(k), (N, m).")
      .def("moments_cycle", &Selection::moments_cycle, "Time mean of s s' over one period, (N m, N m).")
      .def("moments_uniform", &Selection::moments_uniform,
           "E{s s'} over independent uniform subsets, (N m, N m).");
  keep_as_code<Selection>(selection, "garrison.partial_sharing.Selection", [](const Selection& x) {
    return py::dict(py::arg("start") = x.at(0), py::arg("shift") = x.shift());
  });
}

void bind_design(py::module_& s) {
  py::class_<WorstAttack, AnyAttack>(s, "WorstAttack",
                                     "A coordinated attack of largest effect; usable wherever an attack is.")
      .def_property_readonly(
          "covariance", [](const WorstAttack& w) { return w.worst.covariance; },
          "(B m, B m), Byzantine agents in ascending order.")
      .def_property_readonly(
          "form", [](const WorstAttack& w) { return w.worst.form; },
          "What any covariance costs: tr(covariance form).")
      .def_property_readonly(
          "direction", [](const WorstAttack& w) { return w.worst.direction; },
          "Unit top eigenvector of the form, largest entry positive.")
      .def_property_readonly(
          "gain", [](const WorstAttack& w) { return w.worst.gain; },
          "What it adds to the NMSE: in the mean of a cycle (steady), or in one step.")
      .def(py::pickle(&state_of, &worst_from));
  s.def(
      "worst_covariance",
      [](const Analysis& a, const std::vector<int>& byzantine, double energy, const std::string& kind,
         std::int64_t start, std::optional<std::int64_t> stop) {
        if (kind != "steady" && kind != "one_step")
          refuse("kind", "\"" + kind + "\"", "one of: steady, one_step");
        if (byzantine.empty()) refuse("agents", "none", "at least one Byzantine agent");
        const WorstCovariance worst =
            kind == "steady" ? worst_steady(a.setting, a.steady(), byzantine, energy)
                             : worst_one_step(a.setting, a.steady(), byzantine, energy, start - 1);
        return worst_attack(Schedule(start, byzantine, stop.value_or(Schedule::kForever)), worst);
      },
      py::arg("analysis"), py::arg("byzantine"), py::arg("energy"), py::arg("kind"), py::arg("start"),
      py::arg("stop"), "Use garrison.attacks.worst_covariance.");
  py::class_<SelectionProblem> problem(
      s, "SelectionProblem",
      "max s'Gs over 0/1 vectors of `blocks` blocks with at most `most` ones each (31)-(36).");
  keep_as_code<SelectionProblem>(
      problem, "garrison.partial_sharing.SelectionProblem", [](const SelectionProblem& x) {
        return py::dict(py::arg("G") = x.G, py::arg("blocks") = x.blocks, py::arg("most") = x.most);
      });
  problem.def(py::init<Matrix, int, int>(), py::arg("G"), py::arg("blocks"), py::arg("most"))
      .def("objective", &SelectionProblem::objective, py::arg("s"), "s'Gs, s (B m,).")
      .def(
          "ascent",
          [](const SelectionProblem& p, const Vector& start, int sweeps, double factor, bool newest,
             bool rounding) {
            const Ascent a = ascent(p, start, sweeps, factor, newest, rounding);
            return py::dict(py::arg("s") = a.s, py::arg("objective") = a.objective,
                            py::arg("rounded") = a.rounded);
          },
          py::arg("start"), py::arg("sweeps"), py::arg("factor") = 2.0, py::arg("newest") = true,
          py::arg("rounding") = false,
          "Algorithm 2. factor 1 is (36) as printed, 2 the true dependence; newest: Gauss-Seidel, else "
          "Jacobi as\n"
          "printed. Only factor 2 with newest is monotone. Keys: s, objective per sweep, rounded.")
      .def(
          "best_of_starts",
          [](const SelectionProblem& p, int starts, std::uint64_t seed) {
            return best_of_starts(p, starts, seed);
          },
          py::arg("starts") = 16, py::arg("seed") = 0,
          "Best fixed point of monotone sweeps from random starts.")
      .def(
          "exact",
          [](const SelectionProblem& p, std::int64_t max_nodes) {
            require_range("max_nodes", static_cast<double>(max_nodes), 1.0);
            const ExactSelection e = exact_selection(p, max_nodes);
            return py::dict(py::arg("s") = e.s, py::arg("objective") = e.objective,
                            py::arg("exact") = e.exact, py::arg("upper") = e.upper,
                            py::arg("nodes") = e.nodes);
          },
          py::arg("max_nodes") = 5'000'000, "Global maximum by branch and bound.");
}

}  // namespace

void bind_partial_sharing(py::module_& m) {
  py::module_ s = m.def_submodule("partial_sharing",
                                  "Analysis of the partial-sharing filter; errata of its paper: "
                                  "docs/filters/partial_sharing.md.");
  bind_selection(s);
  py::class_<Analysis>(
      s, "Analysis",
      "Exact covariances, stability and attacks of a PartialSharing filter on a model and network.\n\n"
      "N agents, m states; network covariances are (N m, N m), agent by agent. k counts samples from\n"
      "0: k = t - 1. Sigma: (N m, N m), zero on regular agents, None = no attack. P_0 and the start\n"
      "belong to k = 0.")
      .def(py::init<const Model&, const Network&, const FilterHandle&>(), py::arg("model"),
           py::arg("network"), py::arg("filter"))
      .def_property_readonly(
          "selection", [](const Analysis& a) { return a.setting.selection; },
          "Which entries are shared when.")
      .def_property_readonly(
          "shared_fraction", [](const Analysis& a) { return a.setting.shared_fraction(); },
          "p_e = l/m, the largest of the agents.")
      .def_property_readonly(
          "bytes_per_step", [](const Analysis& a) { return bytes_per_step(a.setting); },
          "Payload of all messages of one sample.")
      .def(
          "steady_gains", [](const Analysis& a) { return gains_dict(a.steady()); },
          "Limits of (9), (11) per agent: P, K, C, F. Raises InvalidInput for an undetectable agent.")
      .def(
          "gains",
          [](const Analysis& a, int k) {
            require_steps("k", k);
            std::vector<LocalGains> all;
            for (int i = 0; i < a.setting.agents(); ++i) {
              LocalRecursion recursion(a.setting, i);
              for (int step = 0; step < k; ++step) recursion.step();
              all.push_back(recursion.step());
            }
            return gains_dict(all);
          },
          py::arg("k"), "P_i(k) of (11) and the gains of step k: P, K, C, F.")
      .def(
          "error_covariance",
          [](const Analysis& a, int steps, const Sigma& S, std::int64_t k0, const Agents& b, bool common,
             bool iid) {
            require_steps("steps", steps);
            const Matrix attack = a.attack(S, b);
            return trajectory_dict(iid ? error_covariance_iid(a.setting, steps, attack, k0, common)
                                       : error_covariance(a.setting, steps, attack, k0, common));
          },
          py::arg("steps"), py::arg("Sigma") = py::none(), py::arg("k0") = 0,
          py::arg("byzantine") = py::none(), py::arg("common_start") = true,
          py::arg("iid_selections") = false,
          "(29) along Algorithm 1, gains of (11) from P_0 on: nmse (steps + 1,), P at the end.")
      .def(
          "periodic_covariance",
          [](const Analysis& a, const Sigma& S, const Agents& b) {
            return periodic_covariance(a.setting, a.steady(), a.attack(S, b));
          },
          py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(),
          "Exact periodic steady state of (29), one (N m, N m) per phase. Raises InvalidInput when unstable.")
      .def(
          "periodic_mse",
          [](const Analysis& a, const Sigma& S, const Agents& b) {
            Vector all(a.setting.selection.period());
            const auto phases = periodic_covariance(a.setting, a.steady(), a.attack(S, b));
            for (Eigen::Index f = 0; f < all.size(); ++f)
              all(f) = phases[static_cast<std::size_t>(f)].trace() / a.setting.agents();
            return all;
          },
          py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(), "Its MSE = trace / N by phase.")
      .def(
          "local_covariances",
          [](const Analysis& a, const std::string& moments, const Sigma& S, const Agents& b) {
            return local_covariances(a.setting, a.steady(), moments_of(a, moments), a.attack(S, b));
          },
          py::arg("moments"), py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(),
          "(23)-(26) per agent. moments: \"p_e\" is (26) as printed, \"full\" the same with p_e = 1, "
          "\"uniform\" and\n"
          "\"cycle\" are (25) with exact moments over random starts, or on this cycle. Not the true "
          "covariance.")
      .def(
          "mse_local",
          [](const Analysis& a, const std::string& moments, const Sigma& S, const Agents& b) {
            return mse(local_covariances(a.setting, a.steady(), moments_of(a, moments), a.attack(S, b)));
          },
          py::arg("moments"), py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(), "Their (38).")
      .def(
          "recursion8",
          [](const Analysis& a, const Sigma& S, std::int64_t k0, int steps) {
            require_steps("steps", steps);
            const auto all = recursion8(a.setting, a.steady(), a.attack(S, std::nullopt), k0, steps);
            return Vector(Eigen::Map<const Vector>(all.data(), static_cast<Eigen::Index>(all.size())));
          },
          py::arg("Sigma"), py::arg("k0"), py::arg("steps"),
          "MSE' after each update (8) from the steady state on.")
      .def(
          "full_solution",
          [](const Analysis& a, int steps, const Matrix& start, const Matrix& y, const Matrix& delta,
             const Sigma& S, std::int64_t k0, bool common) {
            require_steps("steps", steps);
            const FullSolution f =
                full_solution(a.setting, steps, start, y, delta, a.attack(S, std::nullopt), k0, common);
            return py::dict(py::arg("estimate") = f.estimate, py::arg("trace") = f.trace, py::arg("K") = f.K,
                            py::arg("C") = f.C, py::arg("P") = f.P);
          },
          py::arg("steps"), py::arg("start"), py::arg("y") = Matrix(), py::arg("delta") = Matrix(),
          py::arg("Sigma") = py::none(), py::arg("k0") = 0, py::arg("common_start") = true,
          "(4)-(7) with cross-covariances, for comparison: not always better than Algorithm 1 (note 16).")
      .def(
          "cycle_radius", [](const Analysis& a) { return cycle_radius(a.setting, a.steady()); },
          "Exact stability: below 1 exactly when covariances stay bounded (per sample).")
      .def(
          "gamma_lyapunov", [](const Analysis& a) { return gamma_lyapunov(a.setting, a.steady()); },
          "Certified: no gain up to here lets the Lyapunov function of the errors grow.")
      .def(
          "gamma_star",
          [](const Analysis& a, std::optional<double> fraction) {
            if (fraction) require_range("fraction", *fraction, 0.0, 1.0);
            return gamma_star(a.setting, a.steady(), fraction.value_or(a.setting.shared_fraction()));
          },
          py::arg("fraction") = py::none(),
          "(22), advisory: false as printed, vacuous when 0: docs/filters/partial_sharing.md#m7.")
      .def(
          "lambda_I",
          [](const Analysis& a) {
            std::vector<Matrix> all;
            for (int i = 0; i < a.setting.agents(); ++i)
              all.push_back(lambda_I(a.setting, a.steady()[static_cast<std::size_t>(i)], i));
            return all;
          },
          "Lambda_I per agent, (m, m).")
      .def(
          "decrease_matrix",
          [](const Analysis& a, double gamma, std::int64_t phase) {
            require_range("gamma", gamma, 0.0);
            require_range("phase", static_cast<double>(phase), 0.0, a.setting.selection.period() - 1.0);
            return decrease_matrix(a.setting, a.steady(), gamma, phase);
          },
          py::arg("gamma"), py::arg("phase") = 0, "M(gamma) of note 7 at a phase, (N m, N m).")
      .def(
          "worst",
          [](const Analysis& a, const std::vector<int>& byzantine, double energy,
             std::optional<std::int64_t> k) {
            if (byzantine.empty()) refuse("byzantine", "none", "at least one agent");
            if (k) require_range("k", static_cast<double>(*k), 0.0);
            const WorstCovariance w = k ? worst_one_step(a.setting, a.steady(), byzantine, energy, *k)
                                        : worst_steady(a.setting, a.steady(), byzantine, energy);
            return py::dict(py::arg("form") = w.form, py::arg("direction") = w.direction,
                            py::arg("gain") = w.gain, py::arg("covariance") = w.covariance);
          },
          py::arg("byzantine"), py::arg("energy"), py::arg("k") = py::none(),
          "Worst covariance with trace <= energy: for the periodic steady state, or for step k alone (37).")
      .def(
          "steady_attack_matrix",
          [](const Analysis& a) { return steady_attack_matrix(a.setting, a.steady()); },
          "N of note 13 for all agents: tr(Sigma N) is what any Sigma adds to the cycle-averaged NMSE.")
      .def(
          "spread",
          [](const Analysis& a, const std::vector<int>& byzantine, const Matrix& block) {
            return spread_covariance(a.setting, byzantine, block);
          },
          py::arg("byzantine"), py::arg("block"), "(B m, B m) of the Byzantine agents as (N m, N m).")
      .def(
          "coupling_form",
          [](const Analysis& a, const std::vector<int>& byzantine) {
            return coupling_form(a.setting, a.steady(), byzantine);
          },
          py::arg("byzantine"), "U of (31).")
      .def(
          "top_degree", [](const Analysis& a, int count) { return top_degree(a.setting, count); },
          py::arg("count"), "The agents that most others hear, sorted.");
  bind_design(s);
}
