// SPDX-License-Identifier: Apache-2.0
// Identification of a model from records, and the central Kalman filter.
#include "bindings.hpp"
#include "garrison/analysis/identify.hpp"
#include "garrison/filters/central_kalman.hpp"

using namespace garrison;

void bind_fit(py::module_& m) {
  const FitOptions standard;
  py::class_<Identified>(m, "Identified", "A model identified from clean records; use garrison.fit.")
      .def_readonly("season", &Identified::season, "(1 + 2 harmonics, N)")
      .def_readonly("scale", &Identified::scale, "(N,): anomaly / scale = measurement")
      .def_readonly("A", &Identified::A, "(n, n)")
      .def_readonly("C", &Identified::C, "(N, n), rows of unit length")
      .def_readonly("share", &Identified::share, "(n,): part of the variance that each factor carries")
      .def_readonly("process_covariance", &Identified::process_covariance, "(n, n)")
      .def_readonly("measurement_variance", &Identified::measurement_variance, "(N,)")
      .def_readonly("process_bound", &Identified::process_bound)
      .def_readonly("measurement_bound", &Identified::measurement_bound, "(N,)")
      .def(
          "measurements",
          [](const Identified& i, const MatrixRef& raw, std::int64_t first) {
            return measurements(i, raw, first);
          },
          py::arg("raw"), py::arg("first"), "Measurements (T, N) of other records under this model.")
      .def(
          "reference_states",
          [](const Identified& i, const MatrixRef& measured) { return reference_states(i, measured); },
          py::arg("measured"), "Least-squares states (T, n) of clean measurements of the same time.");
  m.def(
      "identify",
      [](const MatrixRef& raw, std::int64_t first, int factors, int harmonics, double period, bool root,
         double factor) {
        require_range("fit.harmonics", harmonics, 0.0,
                      std::max(0.0, 0.5 * static_cast<double>(raw.rows()) - 1.0));
        require_range("fit.period", period, std::numeric_limits<double>::min());
        return identify(raw, first, {factors, harmonics, period, root, factor});
      },
      py::arg("raw"), py::arg("first"), py::kw_only(), py::arg("factors") = standard.factors,
      py::arg("harmonics") = standard.harmonics, py::arg("period") = standard.period,
      py::arg("root") = standard.root, py::arg("factor") = standard.factor,
      "Fit a model to clean records (T, N), nan = missing.");
  m.def(
      "central_kalman",
      [](const Model& model, const MatrixRef& y, const VectorRef& x0, double start_variance) {
        require_range("start_variance", start_variance, 0.0);
        return central_kalman(model, y, x0, start_variance);
      },
      py::arg("model"), py::arg("measurements"), py::arg("x0"), py::arg("start_variance"),
      "Estimates (T + 1, n) of a central Kalman filter.");
}
