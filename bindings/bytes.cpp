// SPDX-License-Identifier: Apache-2.0
#include "bytes.hpp"

std::vector<std::byte> from_python(const py::object& given, const char* which) {
  // A NumPy scalar has a buffer, too, but is a number.
  if (!PyObject_CheckBuffer(given.ptr()) || PyIndex_Check(given.ptr()))
    garrison::refuse(which, py::str(py::type::of(given).attr("__name__")).cast<std::string>(), "bytes");
  const auto view = py::bytes(py::module_::import("builtins").attr("bytes")(given));
  const auto content = static_cast<std::string_view>(view);
  const auto* first = reinterpret_cast<const std::byte*>(content.data());
  return {first, first + content.size()};
}
