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
  py::class_<Selection> selection(
      s, "Selection",
      numpydoc(
          R"(Which entries every agent shares, and when: those of sample 0, moved on by tau from sample to sample.

start : (N, m) array | Of zeros and ones: what agents share at k = 0.
shift : int | tau, any whole number.
! InvalidInput | Another entry than 0 and 1.)")
          .c_str());
  selection
      .def(py::init([](const Matrix& start, std::int64_t shift) { return Selection(start, shift); }),
           py::arg("start"), py::arg("shift"))
      .def_property_readonly("period", &Selection::period, "Samples until all selections repeat.")
      .def_property_readonly("shift", &Selection::shift, "tau mod m.")
      .def_property_readonly("frequency", &Selection::frequency,
                             "(N, m): share of the samples in which each entry is sent.")
      .def("at", &Selection::at, py::arg("k"),
           numpydoc(R"(s(k).

k : int | Sample.
< (N, m) array | Of zeros and ones.)")
               .c_str())
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
      py::arg("stop"),
      numpydoc(R"(Use garrison.attacks.worst_covariance.

analysis : Analysis | Of the filter that is attacked.
byzantine : sequence of int | Attacked agents, at least one.
energy : float | Trace of the covariance, >= 0.
kind : str | "steady" or "one_step".
start : int | First sample that is attacked.
stop : int or None | First sample that is not attacked any more; None = never.
< WorstAttack
! InvalidInput | A bad agent, energy or kind, or unstable error dynamics.)")
          .c_str());
  py::class_<SelectionProblem> problem(
      s, "SelectionProblem",
      numpydoc(R"(max s'Gs over 0/1 vectors of `blocks` blocks with at most `most` ones each (31)-(36).

G : (B m, B m) array | Symmetric, positive semidefinite.
blocks : int | B >= 1.
most : int | 0..m.
! InvalidInput | Shapes do not fit, or a number is out of range.)")
          .c_str());
  keep_as_code<SelectionProblem>(
      problem, "garrison.partial_sharing.SelectionProblem", [](const SelectionProblem& x) {
        return py::dict(py::arg("G") = x.G, py::arg("blocks") = x.blocks, py::arg("most") = x.most);
      });
  problem.def(py::init<Matrix, int, int>(), py::arg("G"), py::arg("blocks"), py::arg("most"))
      .def("objective", &SelectionProblem::objective, py::arg("s"),
           numpydoc(R"(s'Gs.

s : (B m,) array | Any numbers.
< float
! InvalidInput | A wrong size.)")
               .c_str())
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
          numpydoc(R"(Algorithm 2. Only factor 2 with newest is monotone.

start : (B m,) array | Zeros and ones to begin with.
sweeps : int | >= 0.
factor : float | 1 is (36) as printed, 2 the true dependence on a block.
newest : bool | Blocks see the newest of the others (Gauss-Seidel), else those of the sweep before (Jacobi,
  as printed).
rounding : bool | Make the `most` largest entries of each block 1 at the end, as printed.
< dict | s (B m,), objective before the first sweep and after each, and rounded, the objective after
  rounding.
! InvalidInput | A wrong size, or a number out of range.)")
              .c_str())
      .def(
          "best_of_starts",
          [](const SelectionProblem& p, int starts, std::uint64_t seed) {
            return best_of_starts(p, starts, seed);
          },
          py::arg("starts") = 16, py::arg("seed") = 0,
          numpydoc(R"(Best fixed point of monotone sweeps from random starts.

starts : int | How many, >= 1.
seed : int | Of the starts, >= 0; equal seeds give equal answers.
< (B m,) array
! InvalidInput | A number out of range.)")
              .c_str())
      .def(
          "exact",
          [](const SelectionProblem& p, std::int64_t max_nodes) {
            require_range("max_nodes", static_cast<double>(max_nodes), 1.0);
            const ExactSelection e = exact_selection(p, max_nodes);
            return py::dict(py::arg("s") = e.s, py::arg("objective") = e.objective,
                            py::arg("exact") = e.exact, py::arg("upper") = e.upper,
                            py::arg("nodes") = e.nodes);
          },
          py::arg("max_nodes") = 5'000'000,
          numpydoc(R"(Global maximum by branch and bound.

max_nodes : int | The search ends after so many parts of sets, >= 1.
< dict | s (B m,) and objective, the best found; exact: whether the search ended; upper, a bound on the
  maximum; nodes looked at.
! InvalidInput | max_nodes < 1.)")
              .c_str());
}

}  // namespace

void bind_partial_sharing(py::module_& m) {
  py::module_ s = m.def_submodule("partial_sharing",
                                  "Analysis of the partial-sharing filter; errata of its paper: "
                                  "docs/filters/partial_sharing.md.");
  bind_selection(s);
  py::class_<Analysis>(
      s, "Analysis",
      numpydoc(
          R"(Exact covariances, stability and attacks of a PartialSharing filter on a model and network. N agents, m
states; network covariances are (N m, N m), agent by agent. k counts samples from 0: k = t - 1. P_0 and the
start belong to k = 0.

model : Model | With process_covariance and measurement_covariance.
network : Network | Of the same agents.
filter : Filter | A garrison.filters.PartialSharing.
! InvalidInput | They do not fit each other, or a covariance is missing.)")
          .c_str())
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
          py::arg("k"),
          numpydoc(R"(P_i(k) of (11) and the gains of step k.

k : int | 0..1e6.
< dict | P, K, C and F, one array per agent.
! InvalidInput | k is out of range.)")
              .c_str())
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
          numpydoc(R"((29) along Algorithm 1, with the gains of (11) from P_0 on.

steps : int | 0..1e6.
Sigma : (N m, N m) array, optional | Covariance of the attack, zero on regular agents; None = no attack.
k0 : int | First step that is attacked, >= 0.
byzantine : sequence of int, optional | Agents that Sigma may speak of; default all.
common_start : bool | All agents have one initial error, else independent ones.
iid_selections : bool | The mean over selections that are drawn anew in every sample.
< dict | nmse, (steps + 1,) traces of P; and P (N m, N m) at the end.
! InvalidInput | A number out of range, or no covariance.)")
              .c_str())
      .def(
          "periodic_covariance",
          [](const Analysis& a, const Sigma& S, const Agents& b) {
            return periodic_covariance(a.setting, a.steady(), a.attack(S, b));
          },
          py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(),
          numpydoc(R"(Exact periodic steady state of (29).

Sigma : (N m, N m) array, optional | Covariance of the attack, zero on regular agents; None = no attack.
byzantine : sequence of int, optional | Agents that Sigma may speak of; default all.
< list of (N m, N m) arrays | One per sample of the period of the selection.
! InvalidInput | Unstable error dynamics, or no covariance.)")
              .c_str())
      .def(
          "periodic_mse",
          [](const Analysis& a, const Sigma& S, const Agents& b) {
            Vector all(a.setting.selection.period());
            const auto phases = periodic_covariance(a.setting, a.steady(), a.attack(S, b));
            for (Eigen::Index f = 0; f < all.size(); ++f)
              all(f) = phases[static_cast<std::size_t>(f)].trace() / a.setting.agents();
            return all;
          },
          py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(),
          numpydoc(R"(Mean square error of the agents in the periodic steady state, trace / N.

Sigma : (N m, N m) array, optional | Covariance of the attack, zero on regular agents; None = no attack.
byzantine : sequence of int, optional | Agents that Sigma may speak of; default all.
< array | One number per sample of the period of the selection, state^2.
! InvalidInput | Unstable error dynamics, or no covariance.)")
              .c_str())
      .def(
          "local_covariances",
          [](const Analysis& a, const std::string& moments, const Sigma& S, const Agents& b) {
            return local_covariances(a.setting, a.steady(), moments_of(a, moments), a.attack(S, b));
          },
          py::arg("moments"), py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(),
          numpydoc(
              R"((23)-(26) per agent. They drop the correlation of neighbours and are not the true covariance.

moments : str | "p_e" is (26) as printed, "full" the same with p_e = 1, "uniform" and "cycle" are (25) with
  exact moments over random starts, or on this cycle.
Sigma : (N m, N m) array, optional | Covariance of the attack, zero on regular agents; None = no attack.
byzantine : sequence of int, optional | Agents that Sigma may speak of; default all.
< list of N (m, m) arrays
! InvalidInput | Unknown moments, or no covariance.)")
              .c_str())
      .def(
          "mse_local",
          [](const Analysis& a, const std::string& moments, const Sigma& S, const Agents& b) {
            return mse(local_covariances(a.setting, a.steady(), moments_of(a, moments), a.attack(S, b)));
          },
          py::arg("moments"), py::arg("Sigma") = py::none(), py::arg("byzantine") = py::none(),
          numpydoc(R"(Their (38), the mean of their traces.

moments : str | As in local_covariances.
Sigma : (N m, N m) array, optional | As in local_covariances.
byzantine : sequence of int, optional | As in local_covariances.
< float | state^2.
! InvalidInput | As local_covariances.)")
              .c_str())
      .def(
          "recursion8",
          [](const Analysis& a, const Sigma& S, std::int64_t k0, int steps) {
            require_steps("steps", steps);
            const auto all = recursion8(a.setting, a.steady(), a.attack(S, std::nullopt), k0, steps);
            return Vector(Eigen::Map<const Vector>(all.data(), static_cast<Eigen::Index>(all.size())));
          },
          py::arg("Sigma"), py::arg("k0"), py::arg("steps"),
          numpydoc(R"(MSE' after each update (8), from the steady state on.

Sigma : (N m, N m) array or None | Covariance of the attack, zero on regular agents; None = no attack.
k0 : int | First step, >= 0.
steps : int | 0..1e6.
< (steps,) array | state^2.
! InvalidInput | A number out of range, or no covariance.)")
              .c_str())
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
          numpydoc(R"((4)-(7) with cross-covariances, for comparison: not always better than Algorithm 1
(docs/filters/partial_sharing.md#m16).

steps : int | 0..1e6.
start : (N, m) array | Estimates at k = 0.
y : (steps, outputs) array | Measurements of the whole network per step; without it covariances only.
delta : (steps, N m) array | Perturbations per step; default none.
Sigma : (N m, N m) array, optional | Covariance of the attack; None = no attack.
k0 : int | First step that is attacked, >= 0.
common_start : bool | All agents have one initial error, else independent ones.
< dict | estimate, steps + 1 arrays (N, m) of predictions; trace of P per step; K and C of the last step,
  per agent; P (N m, N m) at the end.
! InvalidInput | Shapes do not fit, or a number is out of range.)")
              .c_str())
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
          numpydoc(R"((22), advisory: false as printed, vacuous when 0 (docs/filters/partial_sharing.md#m7).

fraction : float, optional | p_e, 0..1; default: that of the filter.
< float | Gain; inf when nobody hears anybody.
! InvalidInput | A fraction out of range.)")
              .c_str())
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
          py::arg("gamma"), py::arg("phase") = 0,
          numpydoc(R"(M(gamma): where it is positive semidefinite the Lyapunov function of the errors falls
(docs/filters/partial_sharing.md#m7).

gamma : float | Gain, >= 0.
phase : int | Sample of the period of the selection, from 0.
< (N m, N m) array
! InvalidInput | A number out of range.)")
              .c_str())
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
          numpydoc(R"(Worst covariance of a given energy.

byzantine : sequence of int | Attacked agents, at least one.
energy : float | Trace of the covariance, >= 0.
k : int, optional | For step k alone (37); default: for the periodic steady state.
< dict | With B attacked agents: form (B m, B m), what a covariance costs: tr(covariance form); direction (B
  m,); gain, the largest cost; covariance (B m, B m) that reaches it.
! InvalidInput | A bad agent or energy, or unstable error dynamics.)")
              .c_str())
      .def(
          "steady_attack_matrix",
          [](const Analysis& a) { return steady_attack_matrix(a.setting, a.steady()); },
          "N of docs/filters/partial_sharing.md#m13 for all agents: tr(Sigma N) is what any Sigma adds to "
          "the cycle-averaged NMSE.")
      .def(
          "spread",
          [](const Analysis& a, const std::vector<int>& byzantine, const Matrix& block) {
            return spread_covariance(a.setting, byzantine, block);
          },
          py::arg("byzantine"), py::arg("block"),
          numpydoc(R"(A covariance of the attacked agents as one of the network.

byzantine : sequence of int | B attacked agents.
block : (B m, B m) array | Covariance, agents in ascending order.
< (N m, N m) array | Zero elsewhere.
! InvalidInput | A bad agent, or a wrong size.)")
              .c_str())
      .def(
          "coupling_form",
          [](const Analysis& a, const std::vector<int>& byzantine) {
            return coupling_form(a.setting, a.steady(), byzantine);
          },
          py::arg("byzantine"),
          numpydoc(R"(U of (31).

byzantine : sequence of int | B attacked agents.
< (B m, B m) array
! InvalidInput | A bad agent.)")
              .c_str())
      .def(
          "top_degree", [](const Analysis& a, int count) { return top_degree(a.setting, count); },
          py::arg("count"),
          numpydoc(R"(The agents that most others hear; among equals the lower ones.

count : int | 0..N.
< list of int | Sorted.
! InvalidInput | count is out of range.)")
              .c_str());
  bind_design(s);
}
