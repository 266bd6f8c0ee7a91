// SPDX-License-Identifier: Apache-2.0
// Analysis that needs no run: subsets, observability, contraction.
#include "bindings.hpp"
#include "budget.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/analysis/subsets.hpp"
#include "garrison/kernel/chebyshev.hpp"
#include "kept.hpp"

using namespace garrison;

namespace {

void bind_subsets(py::module_& m) {
  py::class_<SubsetBound> bound(
      m, "SubsetBound",
      numpydoc(
          R"(Result of a search over the s removed sensors; the true value lies in [lower, upper]. Safe in theorems:
lower of lambda0, upper of varpi and tau0.

lower, upper : float | The value lies between them.
exact : bool | The search finished.
removed : sequence of int | Worst set found, sorted.
nodes : int | Sets, parts of sets, or cones of directions, that were looked at.
method : str | How it was found, in words.)")
          .c_str());
  using B = SubsetBound;
  keep_fields<B>(bound, "garrison.SubsetBound", KeptField{"lower", &B::lower}, KeptField{"upper", &B::upper},
                 KeptField{"exact", &B::exact}, KeptField{"removed", &B::removed},
                 KeptField{"nodes", &B::nodes}, KeptField{"method", &B::method});
  bound.def_readonly("lower", &SubsetBound::lower, "The value is at least this.")
      .def_readonly("upper", &SubsetBound::upper, "And at most this; equal to lower: exact.")
      .def_readonly("exact", &SubsetBound::exact, "The search finished.")
      .def_readonly("removed", &SubsetBound::removed, "Worst set found, sorted.")
      .def_readonly("nodes", &SubsetBound::nodes,
                    "Sets, parts of sets, or cones of directions, that were looked at.")
      .def_readonly("method", &SubsetBound::method, "How it was found, in words.");
  const SubsetLimits limits;
  m.def(
      "lambda0",
      [](const MatrixRef& C, int s, std::int64_t max_nodes, double max_seconds) {
        require_range("max_nodes", static_cast<double>(max_nodes), 1.0);
        require_range("max_seconds", max_seconds, 0.0, kInfinity);
        return within_budget(kInfinity, [&] { return lambda0(C, s, {max_nodes, max_seconds}); });
      },
      py::arg("C"), py::arg("s"), py::arg("max_nodes") = limits.max_nodes,
      py::arg("max_seconds") = limits.max_seconds,
      numpydoc(R"((6) of the saturation paper: least lambda_min(sum C_i'C_i) over all sets of N - s rows of C.

C : (N, n) array | One row per sensor.
s : int | Rows that are left out, 0..N.
max_nodes : int | The search ends after so many sets, >= 1, with an interval (with up to two states, or three and
  more than 20 rows: after as much work as so many looks at all rows).
max_seconds : float | Or after so many seconds, >= 0.
< SubsetBound | Its `lower` is safe in every theorem.
! InvalidInput | A number out of range, or not finite.)")
          .c_str());
  m.def(
      "varpi",
      [](const MatrixRef& C, const MatrixRef& A, int s) {
        return within_budget(kInfinity, [&] { return varpi(C, A, s); });
      },
      py::arg("C"), py::arg("A"), py::arg("s"),
      "Theorem 3: largest ||(I - (1/N) sum C_i'C_i) A|| over sets of N - s rows.");
  m.def(
      "tau0",
      [](const MatrixRef& C, const MatrixRef& A, int s) {
        return within_budget(kInfinity, [&] { return tau0(C, A, s); });
      },
      py::arg("C"), py::arg("A"), py::arg("s"),
      "Theorem 5: largest (1/N) ||[C_i'C_i A]|| over sets of N - s rows.");
  m.def("lambda0_orthogonal", &lambda0_orthogonal, py::arg("C"), py::arg("s"),
        "Closed form of lambda0 for rows that are parallel or orthogonal; None for others.");
  m.def("observable", &observable, py::arg("A"), py::arg("C"),
        numpydoc(R"(Whether (A, C) is observable.

A : (n, n) array | Of the plant.
C : (m, n) array | All rows.
< bool
! InvalidInput | Shapes do not fit, or rounding of the numbers decides and one cannot tell;
  structure.visibility says how far that is.)")
            .c_str());
  m.def("surely_observable", &surely_observable, py::arg("A"), py::arg("C"),
        "The same, False where one cannot tell.");
  m.def(
      "s_sparse_observable",
      [](const MatrixRef& A, const MatrixRef& C, int s, double seconds) {
        return within_budget(seconds, [&] { return s_sparse_observable(A, C, s); });
      },
      py::arg("A"), py::arg("C"), py::arg("s"), py::arg("seconds") = 30.0,
      numpydoc(R"(Whether (A, kept rows) is observable whichever s rows of C are lost.

A : (n, n) array | Of the plant.
C : (N, n) array | One row per sensor.
s : int | Rows that are lost, 0..N.
seconds : float | Time that the search may take.
< bool
! InvalidInput | A number out of range, rounding decides, or `seconds` do not suffice.)")
          .c_str());
  m.def(
      "one_step_sparse_observable",
      [](const MatrixRef& C, int s) {
        require_range("s", s, 0.0, static_cast<double>(C.rows()));
        return one_step_sparse_observable(C, s);
      },
      py::arg("C"), py::arg("s"),
      numpydoc(R"(Whether any N - s rows of C span the state.

C : (N, n) array | One row per sensor.
s : int | Rows that are lost, 0..N.
< bool
! InvalidInput | A number out of range, or not finite.)")
          .c_str());
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
}
