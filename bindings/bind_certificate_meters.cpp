// SPDX-License-Identifier: Apache-2.0
// Meters of a static plant, ranges to anchors, numbers that came over several paths.
#include <optional>
#include <tuple>

#include "certificate.hpp"
#include "garrison/certificate/memory/byzantine.hpp"
#include "garrison/certificate/memory/meters.hpp"
#include "garrison/certificate/memory/range_row.hpp"

using namespace garrison;
using namespace garrison::certificate;

using Ids = std::vector<int>;

void bind_certificate_meters(py::module_& m) {
  py::class_<Meters>(m, "Meters", "What a static set of meters withstands.")
      .def_readonly("leverage", &Meters::leverage, "(sources,)")
      .def_readonly("critical", &Meters::critical, "sources nobody checks")
      .def_readonly("bound", &Meters::bound,
                    "share of the information that k sources hold at most, k = 0..12")
      .def_readonly("removable", &Meters::removable, "any so many may be missing (a lower bound)")
      .def_property_readonly("liars", &Meters::liars, "any so many may lie and are contradicted");
  m.def(
      "meters", [](const MatrixRef& H, const Ids& source) { return meters(H, source); }, py::arg("H"),
      py::arg("source") = Ids(),
      numpydoc(R"(What a static set of meters withstands.

H : (rows, n) array | Divided by the deviations, reference removed.
source : sequence of int | Of each row; empty = its position.
< Meters
! InvalidInput | Shapes do not fit, or the rows do not determine the state.)")
          .c_str());
  py::class_<SmallestAttack>(m, "SmallestAttack", "The smallest set of meters that can lie unseen.")
      .def_readonly("size", &SmallestAttack::size, "None: none found")
      .def_readonly("example", &SmallestAttack::example, "Such a set of meters; empty = none was found.")
      .def_readonly("searched", &SmallestAttack::searched,
                    "no smaller one than this, or as large, for certain");
  m.def("smallest_undetectable", &smallest_undetectable, py::arg("H"), py::arg("most"),
        py::arg("tries") = 1e7, py::call_guard<py::gil_scoped_release>(),
        numpydoc(R"(Exact search for the smallest set of meters that can lie unseen.

H : (rows, n) array | As of meters; no row of zeros.
most : int | Largest set that is looked for, >= 1.
tries : float | Sets that are looked at before the search ends.
< SmallestAttack
! InvalidInput | Shapes do not fit, or a number is out of range.)")
            .c_str());
  m.def(
      "range_row",
      [](const VectorRef& p, const VectorRef& c0, double rho) {
        const auto row = range_row(p, c0, rho);
        return row ? std::optional(std::tuple(row->h, row->offset, row->remainder)) : std::nullopt;
      },
      py::arg("p"), py::arg("c0"), py::arg("rho"),
      numpydoc(R"(A distance to a known point as a row of the regression: |x - p| = offset + h x within bias.

p : (n,) array | The point.
c0 : (n,) array | Centre of a ball that is proved to hold x.
rho : float | Its radius, >= 0.
< (h, offset, bias) or None | None when the ball reaches p.
! InvalidInput | Sizes that differ, or a number out of range.)")
          .c_str());
  m.def("accepted", &accepted, py::arg("paths"), py::arg("liars"),
        numpydoc(R"(Whether a flooded number is its owner's; the budget of the certificates is then s + liars.

paths : sequence of sequences of int | (owner, relay, ..) of each that brought the same number.
liars : int | Agents that may lie, >= 0.
< bool
! InvalidInput | liars < 0, an empty path, or paths of different owners.)")
            .c_str());
}
