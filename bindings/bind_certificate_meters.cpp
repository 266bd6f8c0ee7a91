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
      "H (rows, n), divided by the deviations, reference removed; source (rows,). Raises InvalidInput.");
  py::class_<SmallestAttack>(m, "SmallestAttack", "The smallest set of meters that can lie unseen.")
      .def_readonly("size", &SmallestAttack::size, "None: none found")
      .def_readonly("example", &SmallestAttack::example, "Such a set of meters; empty = none was found.")
      .def_readonly("searched", &SmallestAttack::searched,
                    "no smaller one than this, or as large, for certain");
  m.def("smallest_undetectable", &smallest_undetectable, py::arg("H"), py::arg("most"),
        py::arg("tries") = 1e7, py::call_guard<py::gil_scoped_release>(),
        "Exact search up to `most` meters, given up after `tries` sets. Raises InvalidInput.");
  m.def(
      "range_row",
      [](const VectorRef& p, const VectorRef& c0, double rho) {
        const auto row = range_row(p, c0, rho);
        return row ? std::optional(std::tuple(row->h, row->offset, row->remainder)) : std::nullopt;
      },
      py::arg("p"), py::arg("c0"), py::arg("rho"),
      "(h, offset, bias): |x - p| = offset + h x within bias for x in the proved ball (c0, rho); None when "
      "it reaches p.");
  m.def("accepted", &accepted, py::arg("paths"), py::arg("liars"),
        "Whether a flooded number is its owner's, for paths (owner, relay, ..) that brought the same one; "
        "the budget is "
        "then\ns + liars. Raises InvalidInput.");
}
