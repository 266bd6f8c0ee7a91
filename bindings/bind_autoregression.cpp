// SPDX-License-Identifier: Apache-2.0
// Models with every station as a state.
#include "bindings.hpp"
#include "garrison/analysis/autoregression.hpp"
#include "garrison/analysis/identify.hpp"
#include "kept.hpp"

using namespace garrison;

void bind_autoregression(py::module_& m) {
  const AutoregressionOptions standard;
  py::class_<Autoregression> found(
      m, "Autoregression", "A vector autoregression in companion form: state z(t), .., z(t - order + 1).");
  found.def_readonly("order", &Autoregression::order, "How many samples of the past count.")
      .def_readonly("A", &Autoregression::A, "(n, n), n = stations times order.")
      .def_readonly("B", &Autoregression::B, "(n, inputs).")
      .def_readonly("residual_covariance", &Autoregression::residual_covariance, "(N, N)")
      .def_readonly("residual_bound", &Autoregression::residual_bound,
                    "Largest residual of the records, a length.")
      .def_readonly("residuals", &Autoregression::residuals, "(T, N), nan where the past is not complete.")
      .def_readonly(
          "held_out", &Autoregression::held_out,
          "Mean log-likelihood of a held-out sample under orders 1, 2, ..; empty where the order was given.")
      .def_readonly("samples", &Autoregression::samples, "Samples with a complete past, on which it rests.");
  keep_fields<Autoregression>(
      found, "garrison._core.Autoregression", KeptField<Autoregression, int>{"order", &Autoregression::order},
      KeptField<Autoregression, Matrix>{"A", &Autoregression::A},
      KeptField<Autoregression, Matrix>{"B", &Autoregression::B},
      KeptField<Autoregression, Matrix>{"residual_covariance", &Autoregression::residual_covariance},
      KeptField<Autoregression, double>{"residual_bound", &Autoregression::residual_bound},
      KeptField<Autoregression, Matrix>{"residuals", &Autoregression::residuals},
      KeptField<Autoregression, std::vector<double>>{"held_out", &Autoregression::held_out},
      KeptField<Autoregression, int>{"samples", &Autoregression::samples});
  m.def(
      "autoregress",
      [](const MatrixRef& z, const MatrixRef& u, int order, int most, double held_out) {
        return autoregress(z, u, {order, most, held_out});
      },
      py::arg("z"), py::arg("u"), py::kw_only(), py::arg("order") = standard.order,
      py::arg("most") = standard.most, py::arg("held_out") = standard.held_out,
      "Fit z(t) = A_1 z(t-1) + .. + B u(t) + e to (T, N) numbers without mean and season, nan = missing; u "
      "(T, p).");
  m.def(
      "identified",
      [](const Autoregression& a, const Matrix& season, int harmonics, double period, bool root,
         double factor,
         double noise) { return identified(a, season, {1, harmonics, period, root, factor, {}}, noise); },
      py::arg("autoregression"), py::arg("season"), py::kw_only(), py::arg("harmonics"), py::arg("period"),
      py::arg("root"), py::arg("factor"), py::arg("noise"), "An autoregression as an Identified model.");
  m.def(
      "anomalies",
      [](const MatrixRef& raw, std::int64_t first, int harmonics, double period, bool root, double factor) {
        Matrix season;
        Matrix rest = anomalies(raw, first, {1, harmonics, period, root, factor, {}}, season);
        return py::make_tuple(std::move(rest), std::move(season));
      },
      py::arg("raw"), py::arg("first"), py::kw_only(), py::arg("harmonics"), py::arg("period"),
      py::arg("root"), py::arg("factor"),
      "(records without their seasonal cycle (T, N), the cycle's coefficients).");
}
