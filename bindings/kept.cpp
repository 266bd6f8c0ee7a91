// SPDX-License-Identifier: Apache-2.0
#include "kept.hpp"

namespace py = pybind11;

namespace {

/// Arrays as nested lists, so that their code needs no NumPy.
py::object plain(py::handle value) {
  if (py::hasattr(value, "tolist")) return value.attr("tolist")();
  if (py::isinstance<py::list>(value)) {
    py::list all;
    for (const auto& one : py::reinterpret_borrow<py::list>(value)) all.append(plain(one));
    return all;
  }
  return py::reinterpret_borrow<py::object>(value);
}

}  // namespace

std::string as_code(const std::string& maker, const py::dict& arguments) {
  std::string code = maker + "(";
  bool first = true;
  for (const auto& [name, value] : arguments) {
    code += (first ? "" : ", ") + name.cast<std::string>() + "=" + py::repr(plain(value)).cast<std::string>();
    first = false;
  }
  return code + ")";
}
