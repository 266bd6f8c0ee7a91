// SPDX-License-Identifier: Apache-2.0
// Meters of a static plant, ranges to anchors, numbers that came over several paths.
#include <optional>
#include <tuple>

#include "certificate.hpp"
#include "garrison/certificate/memory/byzantine.hpp"
#include "garrison/certificate/memory/meters.hpp"
#include "garrison/certificate/memory/range_row.hpp"
#include "garrison/certificate/memory/sparse_meters.hpp"

using namespace garrison;
using namespace garrison::certificate;

using Ids = std::vector<int>;

namespace {

SparseMeters of_entries(const std::pair<int, int>& shape, const Ids& rows, const Ids& columns,
                        const VectorRef& values, const Ids& source, int dense) {
  const auto [m, n] = shape;
  if (m < 1 || n < 1) refuse("shape", std::to_string(m) + " x " + std::to_string(n), "at least 1 x 1");
  if (rows.size() != columns.size() || static_cast<Eigen::Index>(rows.size()) != values.size())
    refuse("rows, columns, values",
           std::to_string(rows.size()) + ", " + std::to_string(columns.size()) + " and " +
               amount(values.size(), "number"),
           "as many of each");
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k] < 0 || rows[k] >= m || columns[k] < 0 || columns[k] >= n)
      refuse("rows, columns", std::to_string(rows[k]) + ", " + std::to_string(columns[k]),
             "within " + std::to_string(m) + " x " + std::to_string(n));
    entries.emplace_back(rows[k], columns[k], values(static_cast<Eigen::Index>(k)));
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> H(m, n);
  H.setFromTriplets(entries.begin(), entries.end());
  return sparse_meters(H, source, dense);
}

void bind_sparse_meters(py::module_& m) {
  py::class_<SparseMeters>(m, "SparseMeters", "What a large static set of meters withstands.")
      .def_readonly("unseen", &SparseMeters::unseen,
                    "states of which it is not sure that the rows determine them; the rest is then empty")
      .def_readonly("least", &SparseMeters::least,
                    "the smallest eigenvalue of H'H is at least this, with rows of length 1")
      .def_readonly("leverage", &SparseMeters::leverage, "(rows,), with rows of length 1; nan: no time")
      .def_readonly("critical", &SparseMeters::critical, "sources nobody checks")
      .def_readonly("complete", &SparseMeters::complete, "every row was looked at")
      .def_readonly("fewest", &SparseMeters::fewest, "no fewer rows are needed to lie unseen, for certain")
      .def_readonly("most", &SparseMeters::most, "so many can; as `fewest`: exact")
      .def_readonly("example", &SparseMeters::example, "`most` rows that can");
  m.def("sparse_meters", &of_entries, py::arg("shape"), py::arg("rows"), py::arg("columns"),
        py::arg("values"), py::arg("source") = Ids(), py::arg("dense") = 4000,
        py::call_guard<py::gil_scoped_release>(),
        numpydoc(R"(What a large static set of meters withstands, H by its entries.
Parts of H that have no state in common with the rest are searched one by one. Ends with its budget.

shape : (int, int) | Rows and states of H, both >= 1.
rows, columns : sequences of int | Where H is not 0; entries at one place add up.
values : (k,) array | What stands there, divided by the deviations, reference removed.
source : sequence of int | Of each row; empty = its position.
dense : int | Parts of up to so many rows are searched exactly, larger ones give bounds; >= 0.
< SparseMeters
! InvalidInput | Sizes do not fit, a place is outside of the shape, or a number is not finite.)")
            .c_str());
}

}  // namespace

void bind_certificate_meters(py::module_& m) {
  bind_sparse_meters(m);
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
