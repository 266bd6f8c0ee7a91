// SPDX-License-Identifier: Apache-2.0
// Identification of a model from records, and the central Kalman filter.
#include <cmath>

#include "bindings.hpp"
#include "garrison/analysis/identify.hpp"
#include "kept.hpp"

using namespace garrison;

void bind_fit(py::module_& m) {
  const FitOptions standard;
  py::class_<FitOptions> options(m, "FitOptions", "What a model was identified with; see garrison.fit.");
  using O = FitOptions;
  keep_fields<O>(options, "garrison._core.FitOptions", KeptField{"factors", &O::factors},
                 KeptField{"harmonics", &O::harmonics}, KeptField{"period", &O::period},
                 KeptField{"root", &O::root}, KeptField{"factor", &O::factor});
  options.def_readonly("factors", &O::factors)
      .def_readonly("harmonics", &O::harmonics)
      .def_readonly("period", &O::period, "samples")
      .def_readonly("root", &O::root)
      .def_readonly("factor", &O::factor)
      .def_readonly("standardise", &O::standardise);
  py::class_<Identified> identified(m, "Identified",
                                    "A model identified from clean records; use garrison.fit.");
  using I = Identified;
  keep_fields<I>(identified, "garrison._core.Identified", KeptField{"options", &I::options},
                 KeptField{"season", &I::season}, KeptField{"scale", &I::scale},
                 KeptField{"weight", &I::weight}, KeptField{"A", &I::A}, KeptField{"C", &I::C},
                 KeptField{"share", &I::share}, KeptField{"process_covariance", &I::process_covariance},
                 KeptField{"measurement_variance", &I::measurement_variance},
                 KeptField{"process_bound", &I::process_bound},
                 KeptField{"measurement_bound", &I::measurement_bound});
  identified.def_readonly("options", &I::options)
      .def_readonly("season", &Identified::season, "(1 + 2 harmonics, N)")
      .def_readonly("scale", &Identified::scale, "(N,): anomaly / scale = measurement")
      .def_readonly("weight", &Identified::weight, "(N,): of a measurement in the least squares of the state")
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
         double factor, std::optional<bool> standardise) {
        if (harmonics < 0) refuse("fit.harmonics", std::to_string(harmonics), "a number >= 0");
        if (const std::int64_t least = 2 * std::int64_t{harmonics} + 2; raw.rows() < least)
          refuse("fit.harmonics",
                 std::to_string(harmonics) + " with " + std::to_string(raw.rows()) + " records",
                 "at least " + std::to_string(least) + " records", "use more records, or fewer harmonics");
        if (!(period > 0.0) || !std::isfinite(period))
          refuse("fit.period", text(period), "a number of samples > 0");
        return identify(raw, first, {factors, harmonics, period, root, factor, standardise});
      },
      py::arg("raw"), py::arg("first"), py::kw_only(), py::arg("factors") = standard.factors,
      py::arg("harmonics") = standard.harmonics, py::arg("period") = standard.period,
      py::arg("root") = standard.root, py::arg("factor") = standard.factor,
      py::arg("standardise") = standard.standardise, "Fit a model to clean records (T, N), nan = missing.");
}
