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
      numpydoc(R"(B: one Kalman filter per set of s sources left out; the attacked set never changes.

A : (n, n) array | Of the plant.
Q : (n, n) array | Covariance of the process noise.
sources : sequence of ((k, n) array, (k,) array) | Rows and variances (> 0) of each source.
s : int | Attacked sources, >= 0.
limit : int | Most members; C(sources, s) are needed.
! InvalidInput | Shapes do not fit, no covariance, or too many members.)")
          .c_str())
      .def(py::init([](const MatrixRef& A, const MatrixRef& Q, const Given& sources, int s, int limit) {
             return Bank(A, Q, sources_of(sources), s, limit);
           }),
           py::arg("A"), py::arg("Q"), py::arg("sources"), py::arg("s"), py::arg("limit") = 5000)
      .def("start_gaussian", &Bank::start_gaussian, py::arg("c0"), py::arg("P0"),
           numpydoc(R"(x - c0 ~ N(0, P0) before the first update.

c0 : (n,) array | Finite.
P0 : (n, n) array | Covariance.
! InvalidInput | A wrong size, or no covariance.)")
               .c_str())
      .def("restart", &Bank::restart, py::arg("region"),
           numpydoc(R"(All members anew from a region that contains x.

region : Region | With an answer; it may depend on all data so far.
! InvalidInput | A wrong size, or no answer.)")
               .c_str())
      .def(
          "start_set",
          [](Bank& b, const VectorRef& c0, const MatrixRef& P0, double r0) {
            // The ellipsoid is what is read; the ball only says that there is an answer.
            b.restart(Region{c0, 0.0, {}, P0, r0});
          },
          py::arg("c0"), py::arg("P0"), py::arg("r0"),
          numpydoc(R"((x - c0)' P0^-1 (x - c0) <= r0^2 before the first update.

c0 : (n,) array | Finite.
P0 : (n, n) array | Positive semidefinite.
r0 : float | >= 0.
! InvalidInput | A wrong size, or a number out of range.)")
              .c_str())
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
          numpydoc(R"(Theorem B: one step.

y : array | All outputs one after the other; nan = missing.
z1, z2, zc : float | window_levels(), >= 0.
A, Q : (n, n) array, optional | Where they differ from the design's.
u : (n,) array, optional | Known input.
sources : as in Bank, optional | Where they differ from the design's; of the same sizes.
predict : bool | False: the measurements belong to the same time as those before.
< WindowWitness | Refuted when no member lives: restart then.
! InvalidInput | A wrong size, or a number out of range.)")
              .c_str())
      .def(
          "merge", [](Bank& b, int most, double z2) { b.merge(most, {0.0, z2, 0.0, kNaN}); }, py::arg("most"),
          py::arg("z2"),
          numpydoc(R"(Fewer members from now on, each leaving out more.

most : int | Members that stay at most, >= 1.
z2 : float | As of update; the answer fails with delta(z2) more each time.
! InvalidInput | A number out of range.)")
              .c_str())
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
      numpydoc(R"(B2, design time: what a living member's error never exceeds once the start has decayed.

A : (n, n) array | Of the plant.
Q : (n, n) array | Covariance of the process noise.
sources : as in Bank | Every row is taken to arrive in each step.
s : int | Attacked sources, >= 0.
z1, z2, zc : float | Levels of the bank; z2 and zc at delta / C(sources, s).
limit : int | Most pairs of sets.
< (n + 1,) array | Per coordinate, and in the 2-norm (last); inf: not detectable without some 2s sources.
! InvalidInput | Shapes do not fit, a number out of range, or too many pairs.)")
          .c_str());
  m.def(
      "bank_steady_width",
      [](const MatrixRef& A, const MatrixRef& Q, const Given& sources, int s, double z1, double z2, double zc,
         int limit) { return bank_steady_width(A, Q, sources_of(sources), s, {z1, z2, zc, kNaN}, limit); },
      py::arg("A"), py::arg("Q"), py::arg("sources"), py::arg("s"), py::arg("z1"), py::arg("z2"),
      py::arg("zc"), py::arg("limit") = 100000,
      numpydoc(
          R"(B2, design time: half widths that the box of a bank never exceeds once the start has decayed.

A : (n, n) array | Of the plant.
Q : (n, n) array | Covariance of the process noise.
sources : as in Bank | Every row is taken to arrive in each step.
s : int | Attacked sources, >= 0.
z1, z2, zc : float | Levels of the bank; z2 and zc at delta / C(sources, s).
limit : int | Most pairs of sets.
< (n,) array | inf: not detectable without some 2s sources.
! InvalidInput | As bank_steady.)")
          .c_str());
}

void bind_rules(py::module_& m) {
  m.def(
      "cells",
      [](const std::vector<Region>& regions, int s) {
        const Box box = cells(regions, s);
        return std::pair(box.lo, box.hi);
      },
      py::arg("regions"), py::arg("s"),
      numpydoc(R"(C: per coordinate the hull of the points in all but s of the boxes.

regions : sequence of Region | At least one; of disjoint cells of sources, or of distinct neighbours.
s : int | Regions that may be wrong, >= 0.
< (lo, hi), (n,) arrays | nan: more than s wrong; inf: not enough.
! InvalidInput | No region, sizes that differ, or s < 0.)")
          .c_str());
  m.def(
      "intersection", [](const std::vector<Region>& regions) { return intersection(regions); },
      py::arg("regions"),
      numpydoc(R"(The Region that all of these leave, which hold on the same event.

regions : sequence of Region | At least one.
< Region | Refuted when it is empty.
! InvalidInput | No region, or sizes that differ.)")
          .c_str());
  m.def(
      "order_rule_box",
      [](const std::vector<Region>& regions, const VectorRef& estimate, int f) {
        return order_rule(regions, estimate, f);
      },
      py::arg("regions"), py::arg("estimate"), py::arg("f"),
      numpydoc(R"(Bounds on each |estimate_i - x_i| from regions of which at most f are wrong.

regions : sequence of Region | Of distinct senders.
estimate : (n,) array | Any.
f : int | >= 0.
< (n,) array | inf with f or fewer regions.
! InvalidInput | Sizes that differ, or f < 0.)")
          .c_str());
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
      numpydoc(R"(O: bounds of one observer with clipped innovations, sets that move every step.

A : (n, n) array | Of the plant.
C : (m, n) array | Rows.
L : (n, m) array | Gain.
Gam : (n, q) array | How the process noise enters.
bv : (m,) array | |v| <= bv, >= 0.
s : int | Sources attacked in each step, >= 0.
bw : float | ||w~|| <= bw, >= 0.
start : float | ||e(0)|| <= start, >= 0.
T : int | Last step, >= 1.
lags : int | Lags that are unrolled, >= 1.
source : sequence of m int | Of each row; empty = its position.
< ObserverTable
! InvalidInput | Shapes do not fit, or a number is out of range.)")
          .c_str());
}

}  // namespace

void bind_certificate_bank(py::module_& c) {
  bind_bank(c);
  bind_rules(c);
}
