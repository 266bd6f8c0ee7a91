// SPDX-License-Identifier: Apache-2.0
// Known inputs, and baselines that see measurements as they come.
#include "bindings.hpp"
#include "budget.hpp"
#include "convert.hpp"
#include "garrison/core/discretise.hpp"
#include "garrison/core/response.hpp"
#include "garrison/filters/central_kalman.hpp"
#include "garrison/filters/extended_kalman.hpp"
#include "known.hpp"

using namespace garrison;

namespace {

Known known_of(const Matrix& inputs, const py::dict& series) {
  const auto found = series_of(series);
  return {inputs, found == nullptr ? Series{} : *found};
}

Vector vector_from(const char* which, const py::object& value) {
  const auto array = convert::array(which, value);
  return Eigen::Map<const Vector>(array.data(), array.size());
}

/// The user's functions, called with the GIL; an empty one where there is none.
NonlinearPlant plant_of(const py::function& f, const py::function& h, const py::object& f_jacobian,
                        const py::object& h_jacobian, const py::dict& process_covariance,
                        const Matrix& measurement_variances) {
  NonlinearPlant plant;
  plant.f = [f](const Vector& x, const Vector& u, int t) {
    const py::gil_scoped_acquire gil;
    return vector_from("f", f(x, u, t));
  };
  plant.h = [h](const Vector& x, int t) {
    const py::gil_scoped_acquire gil;
    return vector_from("h", h(x, t));
  };
  if (!f_jacobian.is_none())
    plant.f_jacobian = [f_jacobian](const Vector& x, const Vector& u, int t) {
      const py::gil_scoped_acquire gil;
      return convert::eigen(convert::matrix("f_jacobian", f_jacobian(x, u, t)));
    };
  if (!h_jacobian.is_none())
    plant.h_jacobian = [h_jacobian](const Vector& x, int t) {
      const py::gil_scoped_acquire gil;
      return convert::eigen(convert::matrix("h_jacobian", h_jacobian(x, t)));
    };
  const auto over_time = series_of(process_covariance);
  plant.process_covariances = over_time->process_covariance;
  if (plant.process_covariances.size() == 1) {
    plant.process_covariance = plant.process_covariances.front();
    plant.process_covariances.clear();
  }
  if (measurement_variances.rows() == 1)
    plant.measurement_variance = measurement_variances.row(0);
  else
    plant.measurement_variances = measurement_variances;
  return plant;
}

void bind_kalman(py::module_& m) {
  m.def(
      "central_kalman",
      [](const Model& model, const MatrixRef& y, const VectorRef& x0, double start_variance, double gate,
         double huber, const Matrix& inputs, const py::dict& series) {
        require_range("start_variance", start_variance, 0.0);
        const Known known = known_of(inputs, series);
        return within_budget(
            kInfinity, [&] { return central_kalman(model, y, x0, start_variance, {gate, huber}, known); });
      },
      py::arg("model"), py::arg("measurements"), py::arg("x0"), py::arg("start_variance"),
      py::arg("gate") = 0.0, py::arg("huber") = kInfinity, py::arg("inputs") = Matrix(),
      py::arg("series") = py::dict(), "Estimates (T + 1, n) of a central Kalman filter.");
  m.def(
      "local_kalman",
      [](const Model& model, const Network& network, const MatrixRef& y, const MatrixRef& start,
         double start_variance, double gate, double huber, const Matrix& inputs, const py::dict& series) {
        require_range("start_variance", start_variance, 0.0);
        const Known known = known_of(inputs, series);
        return within_budget(kInfinity, [&] {
          return local_kalman(model, network, y, start.transpose(), start_variance, {gate, huber}, known);
        });
      },
      py::arg("model"), py::arg("network"), py::arg("measurements"), py::arg("start"),
      py::arg("start_variance"), py::arg("gate") = 0.0, py::arg("huber") = kInfinity,
      py::arg("inputs") = Matrix(), py::arg("series") = py::dict(),
      "Estimates (T + 1, n) of every agent's own Kalman filter, a list.");
  m.def(
      "extended_kalman",
      [](const py::function& f, const py::function& h, const MatrixRef& y, const VectorRef& x0,
         const MatrixRef& P0, const py::dict& process_covariance, const Matrix& measurement_variance,
         const MatrixRef& inputs, const py::object& f_jacobian, const py::object& h_jacobian, double gate,
         double huber) {
        const NonlinearPlant plant =
            plant_of(f, h, f_jacobian, h_jacobian, process_covariance, measurement_variance);
        return within_budget(kInfinity,
                             [&] { return extended_kalman(plant, y, x0, P0, inputs, {gate, huber}); });
      },
      py::arg("f"), py::arg("h"), py::arg("measurements"), py::arg("x0"), py::arg("P0"),
      py::arg("process_covariance"), py::arg("measurement_variance"), py::arg("inputs"),
      py::arg("f_jacobian") = py::none(), py::arg("h_jacobian") = py::none(), py::arg("gate") = 0.0,
      py::arg("huber") = kInfinity, "Estimates (T + 1, n) of an extended Kalman filter.");
}

}  // namespace

void bind_known(py::module_& m) {
  py::class_<Response>(
      m, "Response",
      numpydoc(
          R"(What known inputs alone do to a plant: s(t+1) = A s(t) + B u(t), s(0) = 0. With x = z + s, z is a plant
without inputs of which y - C s is measured: an agent driven by hand gets `without` of its measurement, and
its estimate plus `state` is one of x, with the same error and bound (docs/adr/0016).

model : Model | With B.)")
          .c_str())
      .def(py::init<const Model&>(), py::arg("model"))
      .def_property_readonly("state", &Response::state, "s, (n,).")
      .def_property_readonly("sample", &Response::sample, "The present sample, from 0.")
      .def(
          "advance",
          [](Response& r, const Vector& inputs, const std::optional<Matrix>& A,
             const std::optional<Matrix>& B) { r.advance(A.value_or(r.A()), B.value_or(r.B()), inputs); },
          py::arg("inputs"), py::kw_only(), py::arg("A") = py::none(), py::arg("B") = py::none(),
          numpydoc(R"(Moves to the next sample.

inputs : (p,) array | u of this sample, one number per column of B.
A : (n, n) array, optional | Leads to the next sample where the plant changes; default the model's.
B : (n, p) array, optional | Likewise.
! InvalidInput | A wrong size, a number that is not finite, or a response that overflows.)")
              .c_str())
      .def(
          "without",
          [](const Response& r, const Vector& y, const Matrix& C) {
            if (C.rows() != y.size() || C.cols() != r.state().size())
              refuse("C", std::to_string(C.rows()) + " x " + std::to_string(C.cols()),
                     std::to_string(y.size()) + " x " + std::to_string(r.state().size()));
            return Vector(y - C * r.state());
          },
          py::arg("y"), py::arg("C"),
          numpydoc(R"(What a filter without inputs is to get of a measurement: y - C s.

y : (m,) array | The measurement; nan = missing.
C : (m, n) array | Its rows.
< (m,) array
! InvalidInput | Sizes do not fit.)")
              .c_str());
  m.def(
      "driven",
      [](const Matrix& A, const Vector& x, const Matrix& B, const Vector& u) { return driven(A, x, B, u); },
      py::arg("A"), py::arg("x"), py::arg("B"), py::arg("u"), "A x + B u.");
  m.def(
      "discretise",
      [](const Matrix& F, const Matrix& intensity, double period, const Matrix& G) {
        const Discretised found = discretise(F, intensity, period);
        return py::make_tuple(found.A, found.covariance, held_input(F, G, period));
      },
      py::arg("A"), py::arg("process_intensity"), py::arg("period"), py::arg("B"),
      "(A, covariance, B) from sample to sample of dx/dt = A x + B u + white noise, u held in between.");
  bind_kalman(m);
}
