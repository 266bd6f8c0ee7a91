// SPDX-License-Identifier: Apache-2.0
// Structural analysis: patterns, matchings, components, classes of agents, substitutes.
#include "bindings.hpp"
#include "convert.hpp"
#include "garrison/analysis/modes.hpp"
#include "garrison/analysis/structure/strong_subgraph.hpp"
#include "garrison/analysis/structure/substitution.hpp"
#include "kept.hpp"

using namespace garrison;
using namespace garrison::structure;

namespace {

using Edges = std::vector<std::pair<int, int>>;
using Ints = py::array_t<int, py::array::c_style | py::array::forcecast>;

std::vector<int> sorted(std::vector<int> v) {
  std::sort(v.begin(), v.end());
  return v;
}

py::array_t<int> numbers(std::vector<int> v) {
  const auto size = static_cast<py::ssize_t>(v.size());
  return owned(std::move(v), {size});
}

py::list list_of(const std::string& which, py::handle given) {
  const char* const expected = "a state, None, or a list of states";
  if (py::isinstance<py::str>(given) || py::isinstance<py::dict>(given))
    refuse(which, convert::shown(given), expected);
  return convert::listed(which, given, expected);
}

/// measured: per agent a state, None, or a list of states.
Sensors sensors_from(const py::iterable& measured) {
  Sensors all;
  for (const auto& one : measured) {
    const std::string which = "measured[" + std::to_string(all.size()) + "]";
    std::vector<int> states;
    if (convert::scalar(one)) {
      if (!one.is_none()) states.push_back(convert::small(which, one));
    } else {
      for (const auto& state : list_of(which, one)) states.push_back(convert::small(which, state));
    }
    all.push_back(std::move(states));
  }
  return all;
}

std::vector<int> states_from(const py::iterable& measured) {
  std::vector<int> all;
  for (const auto& one : measured)
    all.push_back(one.is_none() ? -1 : convert::small("measured[" + std::to_string(all.size()) + "]", one));
  return all;
}

py::object state_or_none(int state) { return state < 0 ? py::none() : py::object(py::int_(state)); }

AgentClass class_from(const std::string& name) {
  for (const AgentClass c : {AgentClass::alpha, AgentClass::beta, AgentClass::gamma})
    if (name == name_of(c)) return c;
  refuse("types", name, "alpha, beta or gamma");
}

std::vector<std::string> names_of(const std::vector<AgentClass>& types) {
  std::vector<std::string> all;
  for (const AgentClass c : types) all.emplace_back(name_of(c));
  return all;
}

std::vector<bool> bools(const std::vector<char>& flags) { return {flags.begin(), flags.end()}; }

py::dict from_observability(const Observability& o) {
  return py::dict(py::arg("observable") = o.holds(), py::arg("output_connected") = o.output_connected,
                  py::arg("rank_condition") = o.rank_condition);
}

py::object from_picks(const Picks& p) {
  if (!p.exists) return py::none();
  py::list picks;
  for (const Pick& one : p.picks)
    picks.append(one.group < 0 ? py::object(py::make_tuple(one.agent, one.state))
                               : py::object(py::make_tuple(one.agent, one.state, one.group)));
  return py::dict(py::arg("cost") = p.cost, py::arg("picks") = picks);
}

/// The arguments of its constructor.
py::dict arguments(const Pattern& pattern) {
  Edges entries;
  for (int j = 0; j < pattern.columns(); ++j)
    for (const int i : pattern.column(j)) entries.emplace_back(j, i);
  return py::dict(py::arg("rows") = pattern.rows(), py::arg("columns") = pattern.columns(),
                  py::arg("entries") = entries);
}

void bind_pattern(py::module_& s) {
  py::class_<Pattern> pattern(s, "Pattern",
                              numpydoc(R"(Zero pattern of a matrix: which entries are not zero. Immutable.

rows, columns : int | >= 0.
entries : sequence of (column, row) pairs | Which are not zero; of a system matrix, (j, i) is the link j ->
  i.
! InvalidInput | An index out of range, or more than memory holds.)")
                                  .c_str());
  pattern
      .def(py::init([](int rows, int columns, const Edges& entries) {
             require_memory("rows x columns", std::to_string(rows) + " x " + std::to_string(columns),
                            4.0 * (static_cast<double>(rows) + columns));
             return Pattern(rows, columns, entries);
           }),
           py::arg("rows"), py::arg("columns"), py::arg("entries"))
      .def_static(
          "of",
          [](const MatrixRef& matrix, double tolerance) {
            require_range("tolerance", tolerance, 0.0);
            return Pattern::of(matrix, tolerance);
          },
          py::arg("matrix"), py::arg("tolerance") = 0.0,
          numpydoc(R"(The pattern of a dense matrix.

matrix : (m, n) array | Finite.
tolerance : float | Entries with |value| > tolerance are not zero; >= 0.
< Pattern
! InvalidInput | A number that is not finite, or tolerance < 0.)")
              .c_str())
      .def_static(
          "csc",
          [](int rows, const Ints& indptr, const Ints& indices) {
            return Pattern(rows, std::vector<int>(indptr.data(), indptr.data() + indptr.size()),
                           std::vector<int>(indices.data(), indices.data() + indices.size()));
          },
          py::arg("rows"), py::arg("indptr"), py::arg("indices"),
          numpydoc(R"(From compressed columns, as scipy.sparse.csc_array has them, without its numbers.

rows : int | >= 0.
indptr : (columns + 1,) int array | Where each column begins.
indices : int array | Row of every entry, column by column.
< Pattern
! InvalidInput | Arrays that do not fit.)")
              .c_str())
      .def_property_readonly("rows", &Pattern::rows, "How many.")
      .def_property_readonly("columns", &Pattern::columns, "How many.")
      .def_property_readonly("entries", &Pattern::entries, "How many may be other than zero.")
      .def("transposed", &Pattern::transposed, "The pattern of the transposed matrix.");
  keep_as_code<Pattern>(pattern, "garrison.structure.Pattern", &arguments);
  s.def(
      "maximum_matching",
      [](const Pattern& p) {
        const auto m = [&] {
          const py::gil_scoped_release no_gil;
          return maximum_matching(p);
        }();
        return py::make_tuple(m.size, numbers(m.row_of), numbers(m.column_of));
      },
      py::arg("pattern"),
      numpydoc(R"(The largest set of entries of which no two share a row or column.

pattern : Pattern | Of a matrix (m, n).
< (int, (n,) int array, (m,) int array) | Size, row of each column, column of each row; -1 = unmatched.)")
          .c_str());
  s.def(
      "strong_components",
      [](const Pattern& p) {
        auto c = [&] {
          const py::gil_scoped_release no_gil;
          return strong_components(p);
        }();
        return py::make_tuple(c.count, numbers(std::move(c.of)));
      },
      py::arg("pattern"),
      numpydoc(R"(Strong components of the digraph with links column -> row.

pattern : Pattern | Of a square matrix (n, n).
< (int, (n,) int array) | How many, and the component of each vertex.
! InvalidInput | Not square.)")
          .c_str());
  s.def(
      "dulmage_mendelsohn",
      [](const Pattern& p) {
        auto d = [&] {
          const py::gil_scoped_release no_gil;
          return dulmage_mendelsohn(p);
        }();
        return py::dict(py::arg("structural_rank") = d.structural_rank(),
                        py::arg("hor_rows") = numbers(std::move(d.hor_rows)),
                        py::arg("hor_cols") = numbers(std::move(d.hor_cols)),
                        py::arg("sq_rows") = numbers(std::move(d.sq_rows)),
                        py::arg("sq_cols") = numbers(std::move(d.sq_cols)),
                        py::arg("ver_rows") = numbers(std::move(d.ver_rows)),
                        py::arg("ver_cols") = numbers(std::move(d.ver_cols)),
                        py::arg("block_start") = numbers(std::move(d.block_start)));
      },
      py::arg("pattern"),
      numpydoc(
          R"(Dulmage-Mendelsohn decomposition: coarse parts (hor: more columns than rows, sq: matched, ver: more rows
than columns), and the square part in fine blocks.

pattern : Pattern | Of any matrix.
< dict | structural_rank; int arrays hor_rows, hor_cols, sq_rows, sq_cols, ver_rows, ver_cols; block_start:
  block b holds sq_rows and sq_cols [block_start[b], block_start[b+1]).)")
          .c_str());
}

void bind_system(py::module_& s) {
  py::class_<System> system(
      s, "System",
      numpydoc(
          R"(Structure of a system matrix, worked out once. States are numbered from 0; a pattern entry (j, i) is the
link j -> i. Methods take `measured`: per agent the state that it measures, a list of states, or None.

pattern : Pattern | Square.
! InvalidInput | Not square.)")
          .c_str());
  keep_as_code<System>(system, "garrison.structure.System",
                       [](const System& x) { return py::dict(py::arg("pattern") = x.pattern()); });
  system.def(py::init<Pattern>(), py::arg("pattern"))
      .def_property_readonly("states", &System::states, "How many, n.")
      .def_property_readonly(
          "structural_rank", [](const System& x) { return x.parts().structural_rank(); },
          "Rank of A for almost all values of its entries.")
      .def_property_readonly(
          "parts",
          [](const System& x) {
            const auto& d = x.parts();
            return py::dict(
                py::arg("hor_rows") = sorted(d.hor_rows), py::arg("hor_cols") = sorted(d.hor_cols),
                py::arg("ver_rows") = sorted(d.ver_rows), py::arg("ver_cols") = sorted(d.ver_cols),
                py::arg("sq_rows") = sorted(d.sq_rows), py::arg("sq_cols") = sorted(d.sq_cols));
          },
          "Coarse Dulmage-Mendelsohn parts, sorted.")
      .def_property_readonly("contraction_union", &System::contraction_union,
                             "States of all contractions, sorted; does not depend on the matching.")
      .def_property_readonly(
          "contraction_components",
          [](const System& x) { return contraction_components(x.pattern(), x.parts()); },
          "Overlapping contractions joined; does not depend on the matching.")
      .def_property_readonly(
          "components", [](const System& x) { return x.components().lists(); },
          "Strong components, lists of states, parents first.")
      .def_property_readonly("parent_components", &System::parent_components,
                             "Components that no link leaves.")
      .def(
          "in_contraction",
          [](const System& x, int state) {
            if (state < 0 || state >= x.states())
              refuse("state", std::to_string(state), "a state of the system");
            return x.in_contraction(state);
          },
          py::arg("state"),
          numpydoc(R"(Whether the state is in some contraction: a set of more columns than rows.

state : int | 0..n-1.
< bool
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "in_parent",
          [](const System& x, int state) {
            if (state < 0 || state >= x.states())
              refuse("state", std::to_string(state), "a state of the system");
            return x.in_parent(state);
          },
          py::arg("state"),
          numpydoc(R"(Whether the state is in a strong component that no link leaves.

state : int | 0..n-1.
< bool
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "observability",
          [](const System& x, const py::iterable& m) {
            return from_observability(x.observability(sensors_from(m)));
          },
          py::arg("measured"),
          numpydoc(R"(Structural observability and its two conditions.

measured : sequence of int, list of int or None | What each agent measures.
< dict | observable, output_connected, rank_condition: bools.
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "classes",
          [](const System& x, const py::iterable& m) { return names_of(x.classes(sensors_from(m))); },
          py::arg("measured"),
          numpydoc(R"(Class of each agent, by what it measures (section II-B of the structural paper).

measured : sequence of int, list of int or None | What each agent measures.
< list of str | alpha (it measures a state of a contraction), beta (one of a parent component) or gamma
  (neither), per agent.
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "necessary",
          [](const System& x, const py::iterable& m) { return bools(x.necessary(sensors_from(m))); },
          py::arg("measured"),
          numpydoc(R"(Which agents cannot be missed: structurally observable, but not without this one.

measured : sequence of int, list of int or None | What each agent measures.
< list of bool | Per agent.
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "substitutes",
          [](const System& x, const py::iterable& m) { return x.substitutes(sensors_from(m)); },
          py::arg("measured"),
          numpydoc(R"(What each agent could measure instead.

measured : sequence of int, list of int or None | What each agent measures.
< list of lists of int | States, per agent.
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "contraction_of_measured",
          [](const System& x, const py::iterable& m) { return x.contraction_of_measured(sensors_from(m)); },
          py::arg("measured"),
          numpydoc(
              R"(The contraction of each measured state. Empty unless there are as many alpha agents, measuring one state
each, as the structural rank lacks.

measured : sequence of int, list of int or None | What each agent measures.
< dict | Measured state -> states of its contraction, sorted.
! InvalidInput | There is no such state.)")
              .c_str())
      .def(
          "class_candidates",
          [](const System& x, const py::iterable& m, int agent, const std::string& type) {
            const auto measured = states_from(m);
            if (agent < 0 || agent >= static_cast<int>(measured.size()))
              refuse("agent", std::to_string(agent), "0.." + std::to_string(measured.size() - 1));
            return x.class_candidates(measured, static_cast<std::size_t>(agent), class_from(type));
          },
          py::arg("measured"), py::arg("agent"), py::arg("type"),
          numpydoc(R"(Other states of an agent's class.

measured : sequence of int or None | The one state that each agent measures.
agent : int | Which agent, 0..
type : str | "alpha", "beta" or "gamma".
< list of int
! InvalidInput | There is no such agent, state or class.)")
              .c_str())
      .def(
          "mitigate",
          [](const System& x, const py::iterable& m, const std::vector<int>& alarms,
             const std::optional<std::vector<std::string>>& types, const std::string& choice,
             const std::optional<Matrix>& cost) {
            if (choice != "class" && choice != "exact") refuse("choice", choice, "class or exact");
            std::vector<AgentClass> kinds = x.classes(sensors_from(m));
            if (types) {
              kinds.clear();
              for (const auto& t : *types) kinds.push_back(class_from(t));
            }
            const auto done =
                mitigate(x, states_from(m), kinds, alarms,
                         choice == "class" ? Choice::by_class : Choice::exact, cost.value_or(Matrix()));
            py::list now;
            for (const int state : done.measured) now.append(state_or_none(state));
            py::list log;
            for (const auto& l : done.log)
              log.append(py::make_tuple(l.agent, std::string(name_of(l.type)), state_or_none(l.before),
                                        state_or_none(l.after)));
            return py::make_tuple(now, log);
          },
          py::arg("measured"), py::arg("alarms"), py::arg("types") = py::none(), py::arg("choice") = "exact",
          py::arg("cost") = py::none(),
          numpydoc(R"(Algorithm 1: alarmed agents measure another state, one after the other.

measured : sequence of int or None | The one state that each agent measures.
alarms : sequence of int | Alarmed agents.
types : sequence of str, optional | Class of each agent; default: `classes`.
choice : str | "class" as printed, or "exact", the cheapest state that keeps the system structurally
  observable.
cost : (agents, states) array, optional | Of measuring a state; default: all alike.
< (list, list) | The new measured states, and (agent, type, before, after) of every change.
! InvalidInput | There is no such agent, state or class, or a wrong size.)")
              .c_str());
}

void bind_networks(py::module_& s) {
  s.def(
      "distributed_observability",
      [](const Pattern& A, const py::iterable& m, const Matrix& W, const Matrix& U) {
        return from_observability(distributed_observability(A, sensors_from(m), W, U));
      },
      py::arg("A"), py::arg("measured"), py::arg("W"), py::arg("U"),
      numpydoc(
          R"(Structural observability of the pattern pair (W kron A, D_C): by every agent, from what it hears.

A : Pattern | Of the system matrix, n states.
measured : sequence of int, list of int or None | What each of the N agents measures.
W : (N, N) array | Whose estimates agents mix: entries that are not 0.
U : (N, N) array | Whose measurements agents get: entries that are not 0.
< dict | observable, output_connected, rank_condition: bools.
! InvalidInput | Shapes do not fit.)")
          .c_str());
  s.def(
      "cheapest_per_class",
      [](const MatrixRef& cost, const std::vector<std::vector<int>>& classes) {
        return from_picks(cheapest_per_class(cost, classes));
      },
      py::arg("cost"), py::arg("classes"),
      numpydoc(R"(Remark 9: the cheapest agents, one per class of states.

cost : (agents, states) array | Of measuring a state; inf = impossible.
classes : sequence of sequences of int | States of each class.
< dict or None | cost, and picks, (agent, state, class) tuples; None when there is no such choice.
! InvalidInput | There is no such state, or a cost is negative or nan.)")
          .c_str());
  s.def(
      "cheapest_rank_sensors",
      [](const Pattern& A, const MatrixRef& cost) { return from_picks(cheapest_rank_sensors(A, cost)); },
      py::arg("A"), py::arg("cost"),
      numpydoc(R"(The cheapest sensors that restore the structural rank.

A : Pattern | Of the system matrix, n states.
cost : (agents, n) array | Of measuring a state; inf = impossible.
< dict or None | cost, and picks, (agent, state) pairs; None when there are none.
! InvalidInput | A wrong size, or a cost is negative or nan.)")
          .c_str());
  s.def(
      "cheapest_strong_subgraph",
      [](int agents, const Edges& edges, const std::vector<double>& weights, long long max_nodes) {
        require_range("max_nodes", static_cast<double>(max_nodes), 1.0);
        require_memory("agents", std::to_string(agents), 100.0 * agents);
        const auto found = cheapest_strong_subgraph(agents, edges, weights, max_nodes);
        return py::dict(py::arg("exists") = found.exists, py::arg("edges") = found.edges,
                        py::arg("cost") = found.cost, py::arg("lower_bound") = found.lower_bound,
                        py::arg("exact") = found.exact);
      },
      py::arg("agents"), py::arg("edges"), py::arg("weights"), py::arg("max_nodes") = 2'000'000,
      numpydoc(
          R"(Cheapest strongly connected network from given links. The problem is NP-hard: nothing cheaper than
lower_bound exists.

agents : int | >= 1.
edges : sequence of (from, to) pairs | Links that can be had.
weights : sequence of float | Cost of each, >= 0.
max_nodes : int | Choices that are looked at before the search ends, >= 1.
< dict | exists; edges, cost; lower_bound; exact: whether max_nodes sufficed for cost = lower_bound.
! InvalidInput | A number out of range, or sizes that differ.)")
          .c_str());
  s.def("unseen_modes", &unseen_modes, py::arg("A"), py::arg("C"), py::arg("least") = 0.0,
        numpydoc(R"(Eigenvalues of A that the rows of C do not surely show; see visibility.

A : (n, n) array | Of the plant.
C : (m, n) array | Rows; there may be none.
least : float | Eigenvalues of smaller modulus are left out; >= 0.
< list of complex
! InvalidInput | Shapes do not fit, or a number is not finite.)")
            .c_str());
  s.def(
      "visibility",
      [](const MatrixRef& A, const MatrixRef& C, double least) {
        const Visibility v = visibility(A, C, least);
        const char* sight = v.sight == Sight::seen ? "seen" : v.sight == Sight::unseen ? "unseen" : "unclear";
        return py::dict(py::arg("sight") = sight, py::arg("distance") = v.distance,
                        py::arg("nearest") = v.nearest, py::arg("unseen") = v.unseen,
                        py::arg("unclear") = v.unclear, py::arg("text") = v.text());
      },
      py::arg("A"), py::arg("C"), py::arg("least") = 0.0,
      numpydoc(R"(What the rows of C show of the modes of A. Units and coordinates do not matter.

A : (n, n) array | Of the plant.
C : (m, n) array | Rows; there may be none.
least : float | Modes of smaller modulus are left out; >= 0.
< dict | sight: "seen", "unseen" or "unclear"; distance, relative, to the nearest pair with an unseen mode,
  and that mode in nearest; eigenvalues in unseen and unclear; text, all of it in words.
! InvalidInput | Shapes do not fit, or a number is not finite.)")
          .c_str());
  s.def("undetectable_agents", &undetectable_agents, py::arg("model"),
        numpydoc(R"(Agents whose sensor alone can lie along an unstable mode that nobody else sees.

model : Model | Any.
< list of int | Sorted.)")
            .c_str());
}

}  // namespace

void bind_structure(py::module_& m) {
  auto s =
      m.def_submodule("structure", "Structural analysis: what follows from the zeros of a system alone.");
  bind_pattern(s);
  bind_system(s);
  bind_networks(s);
}
