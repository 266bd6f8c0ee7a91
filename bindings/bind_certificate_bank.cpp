// SPDX-License-Identifier: Apache-2.0
// Banks of filters, and the other rules for boxes: cells, intersections, one observer's table.
#include <optional>

#include "certificate.hpp"
#include "garrison/certificate/memory/bank.hpp"
#include "garrison/certificate/memory/cells.hpp"
#include "garrison/certificate/memory/observer_table.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

using Ids = std::vector<int>;
using Sources = std::vector<BankSource>;

Sources sources_of(const std::vector<std::pair<Matrix, Vector>>& given) {
  Sources sources;
  for (const auto& [C, R] : given) sources.push_back({C, R});
  return sources;
}
using Given = std::vector<std::pair<Matrix, Vector>>;

void bind_bank(py::module_& m) {
  py::class_<Bank>(
      m, "Bank",
      "B: one Kalman filter per set of s sources left out; the attacked set never changes. sources: a "
      "list of (C (k, n),\nvariances (k,)).")
      .def(py::init([](const MatrixRef& A, const MatrixRef& Q, const Given& sources, int s, int limit) {
             return Bank(A, Q, sources_of(sources), s, limit);
           }),
           py::arg("A"), py::arg("Q"), py::arg("sources"), py::arg("s"), py::arg("limit") = 5000,
           "A, Q (n, n). Raises InvalidInput, also when C(sources, s) > limit.")
      .def("start_gaussian", &Bank::start_gaussian, py::arg("c0"), py::arg("P0"),
           "x - c0 ~ N(0, P0) before the first update. Raises InvalidInput.")
      .def("restart", &Bank::restart, py::arg("region"),
           "All members anew from a Region that contains x. Raises InvalidInput without an answer.")
      .def(
          "start_set",
          [](Bank& b, const VectorRef& c0, const MatrixRef& P0, double r0) {
            // The ellipsoid is what is read; the ball only says that there is an answer.
            b.restart(Region{c0, 0.0, {}, P0, r0});
          },
          py::arg("c0"), py::arg("P0"), py::arg("r0"),
          "(x - c0)' P0^-1 (x - c0) <= r0^2 before the first update. Raises InvalidInput.")
      .def("start_unknown", &Bank::start_unknown,
           "All members anew with nothing known of x: no region before the rows of all living members have\n"
           "determined it.")
      .def(
          "update",
          [](Bank& b, const VectorRef& y, double z1, double z2, double zc, const std::optional<Matrix>& A,
             const std::optional<Vector>& u, const std::optional<Matrix>& Q,
             const std::optional<Given>& sources, bool predict) {
            const Sources now = sources_of(sources.value_or(Given()));
            const BankStep step{A ? &*A : nullptr, u ? &*u : nullptr, Q ? &*Q : nullptr,
                                sources ? &now : nullptr, predict};
            return b.checked_update(y, {z1, z2, zc, kNaN}, step);
          },
          py::arg("y"), py::arg("z1"), py::arg("z2"), py::arg("zc"), py::kw_only(), py::arg("A") = py::none(),
          py::arg("u") = py::none(), py::arg("Q") = py::none(), py::arg("sources") = py::none(),
          py::arg("predict") = true,
          "One step. y: all outputs one after the other, nan = missing; A, Q, sources: where they differ "
          "from the\n"
          "design's; u (n,): known input. Returns a WindowWitness; raises InvalidInput.")
      .def(
          "merge", [](Bank& b, int most, double z2) { b.merge(most, {0.0, z2, 0.0, kNaN}); }, py::arg("most"),
          py::arg("z2"), "At most `most` members from now on, each leaving out more. Raises InvalidInput.")
      .def_property_readonly(
          "dependence",
          [](const Bank& b) {
            const Dependence found = b.dependence();
            return py::make_tuple(found.evidence, found.source, found.correlation, found.pairs);
          },
          "(evidence, source, correlation, pairs): what the innovations of all living members say against "
          "white noise, of\nwhich evidence ever exceeds e with probability at most exp(-e); -inf where "
          "nothing "
          "was compared.")
      .def_property_readonly(
          "count", [](const Bank& b) { return b.members().size(); }, "living members")
      .def_property_readonly(
          "left_out",
          [](const Bank& b) {
            std::vector<Ids> sets;
            for (const BankMember& member : b.members()) sets.push_back(member.left_out);
            return sets;
          },
          "per living member: the sources it does not read");
  m.def(
      "bank_steady",
      [](const MatrixRef& A, const MatrixRef& Q, const Given& sources, int s, double z1, double z2, double zc,
         int limit) { return bank_steady(A, Q, sources_of(sources), s, {z1, z2, zc, kNaN}, limit); },
      py::arg("A"), py::arg("Q"), py::arg("sources"), py::arg("s"), py::arg("z1"), py::arg("z2"),
      py::arg("zc"), py::arg("limit") = 100000,
      "B2, design time: (n + 1,): per coordinate and in the 2-norm (last), what a living member's error "
      "never exceeds;\n"
      "inf: not detectable without some 2s sources. z2, zc at delta / C(sources, s). Raises InvalidInput.");
  m.def(
      "bank_steady_width",
      [](const MatrixRef& A, const MatrixRef& Q, const Given& sources, int s, double z1, double z2, double zc,
         int limit) { return bank_steady_width(A, Q, sources_of(sources), s, {z1, z2, zc, kNaN}, limit); },
      py::arg("A"), py::arg("Q"), py::arg("sources"), py::arg("s"), py::arg("z1"), py::arg("z2"),
      py::arg("zc"), py::arg("limit") = 100000,
      "B2, design time: (n,): half widths that the box of a bank never exceeds; the rest as in bank_steady.");
}

void bind_rules(py::module_& m) {
  m.def(
      "cells",
      [](const std::vector<Region>& regions, int s) {
        const Box box = cells(regions, s);
        return std::pair(box.lo, box.hi);
      },
      py::arg("regions"), py::arg("s"),
      "C: (lo, hi), (n,) each: per coordinate the hull of the points in at least len(regions) - s of the "
      "boxes; nan:\n"
      "more than s wrong; inf: not enough. Raises InvalidInput.");
  m.def(
      "intersection", [](const std::vector<Region>& regions) { return intersection(regions); },
      py::arg("regions"),
      "The Region that all of these leave, which hold on the same event; refuted when it is empty.");
  m.def(
      "order_rule_box",
      [](const std::vector<Region>& regions, const VectorRef& estimate, int f) {
        return order_rule(regions, estimate, f);
      },
      py::arg("regions"), py::arg("estimate"), py::arg("f"),
      "(n,): bounds on |estimate_i - x_i| from regions of which at most f are wrong. Raises InvalidInput.");
  py::class_<ObserverTable>(m, "ObserverTable",
                            "Row t = 0..T; infinite from where it overflows or exceeds 1e12.")
      .def_readonly("d", &ObserverTable::d, "(T+1, n+1): |e_i(t)|, and ||e(t)|| (last)")
      .def_readonly("eta", &ObserverTable::eta, "(T+1, m): |C_r A e(t)|")
      .def_readonly("level", &ObserverTable::level, "(T+1, m): where innovations are clipped; row 0 is 0");
  m.def(
      "observer_table",
      [](const MatrixRef& A, const MatrixRef& C, const MatrixRef& L, const MatrixRef& Gam,
         const VectorRef& bv, int s, double bw, double start, int T, int lags,
         const Ids& source) { return observer_table(A, C, L, Gam, bv, source, {s, bw, start, T, lags}); },
      py::arg("A"), py::arg("C"), py::arg("L"), py::arg("Gam"), py::arg("bv"), py::kw_only(), py::arg("s"),
      py::arg("bw"), py::arg("start"), py::arg("T"), py::arg("lags"), py::arg("source") = Ids(),
      "O: bounds of one observer with gain L (n, m) and clipped innovations, sets that move every step. |v| "
      "<= bv (m,),\n"
      "||w~|| <= bw, ||e(0)|| <= start; source (m,): of each row. Raises InvalidInput.");
}

}  // namespace

void bind_certificate_bank(py::module_& c) {
  bind_bank(c);
  bind_rules(c);
}
