// SPDX-License-Identifier: Apache-2.0
#include "functions.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "convert.hpp"
#include "own.hpp"

using namespace garrison;
namespace py = pybind11;

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr const char* kRows = "X has a row per agent: X[:, 0] is the first state of all of them";

std::string shape(const std::vector<py::ssize_t>& sizes) {
  std::string words;
  for (const py::ssize_t size : sizes) words += (words.empty() ? "" : ", ") + std::to_string(size);
  return "(" + words + (sizes.size() == 1 ? ",)" : ")");
}
std::vector<py::ssize_t> sizes_of(const convert::Array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

/// A column per agent as Python has it, a row per agent; a copy, which the function may write into.
py::array_t<double> rows_of(const Matrix& X) {
  return py::array_t<double>(std::vector<py::ssize_t>{X.cols(), X.rows()}, X.data());
}

std::string where(const char* name, const Matrix& X, int t) {
  return std::string(name) + ", t = " + std::to_string(t) + ", X of shape " + shape({X.cols(), X.rows()}) +
         ", a row per agent";
}

/// Numbers of all outputs, `width` for each: all on top of each other, an equal number of rows per agent, or
/// a list with an array per agent.
Rows of_outputs(const std::string& which, py::handle given, const Model& model, py::ssize_t width) {
  const int M = model.total_outputs();
  const int N = model.agents();
  Rows found(M, width);
  const auto tail = [&](std::vector<py::ssize_t> sizes) {
    if (which == "h_jacobian") sizes.push_back(width);
    return sizes;
  };
  const bool listed = py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given);
  if (listed && py::len(given) == static_cast<std::size_t>(N)) {
    for (int i = 0; i < N; ++i) {
      const std::string one = which + "[" + std::to_string(i) + "]";
      const py::object own = given[py::int_(i)];
      const auto array = convert::array(one, own);
      if (array.size() != model.outputs(i) * width)
        refuse(one, shape(sizes_of(array)), shape(tail({model.outputs(i)})),
               "one row per output of this agent");
      std::copy_n(array.data(), array.size(), found.data() + model.offset(i) * width);
    }
    return found;
  }
  const auto array = convert::array(which, given);
  const auto sizes = sizes_of(array);
  const bool equal = N > 0 && M % N == 0;
  if (sizes != tail({M}) && !(equal && sizes == tail({N, M / N})))
    refuse(which, shape(sizes), shape(tail({M})) + ", or a list of " + std::to_string(N) + " arrays",
           "the outputs of agent i at X[i]; " + std::string(kRows));
  std::copy_n(array.data(), array.size(), found.data());
  return found;
}

Matrix moved(const own::Held& f, const Matrix& X, const Vector& u, int t) {
  const py::gil_scoped_acquire gil;
  const auto inputs = own::array_of(u.data(), static_cast<std::size_t>(u.size()));
  const py::object given = own::noted(where("f", X, t), [&] { return (*f)(rows_of(X), inputs, t); });
  const auto array = convert::array("f", given);
  const std::vector<py::ssize_t> expected{X.cols(), X.rows()};
  if (sizes_of(array) != expected) refuse("f", shape(sizes_of(array)), shape(expected), kRows);
  return Eigen::Map<const Matrix>(array.data(), X.rows(), X.cols());
}

Rows observed(const char* name, const own::Held& function, const Matrix& X, int t, const Model& model,
              py::ssize_t width) {
  const py::gil_scoped_acquire gil;
  const py::object given = own::noted(where(name, X, t), [&] { return (*function)(rows_of(X), t); });
  return of_outputs(name, given, model, width);
}

}  // namespace

std::shared_ptr<const Nonlinear> functions_of(const py::dict& given, const Model& model) {
  if (given.empty()) return nullptr;
  auto plant = std::make_shared<Nonlinear>();
  plant->f = [f = own::Held(given["f"])](const Matrix& X, const Vector& u, int t) {
    return moved(f, X, u, t);
  };
  plant->h = [h = own::Held(given["h"]), &model](const Matrix& X, int t) -> Vector {
    return observed("h", h, X, t, model, 1).col(0);
  };
  if (const py::object jacobian = given["h_jacobian"]; !jacobian.is_none())
    plant->h_jacobian = [of = own::Held(jacobian), &model](const Matrix& X, int t) -> Matrix {
      return observed("h_jacobian", of, X, t, model, model.states());
    };
  if (given.contains("linear"))
    for (const py::handle one : given["linear"]) plant->linear.push_back(one.cast<int>());
  return plant;
}
