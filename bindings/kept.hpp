// SPDX-License-Identifier: Apache-2.0
// Objects that can be kept: from the arguments of its constructor follow an object's code (repr), its pickle
// and its copies.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

/// "garrison.Model(A=[[0.9]], C=[[[1.0]]])"; arrays as lists, numbers with all their digits, functions and
/// classes by module and name. What has no code is shown as Python does, without its address: equal on every
/// run.
std::string as_code(const std::string& maker, const pybind11::dict& arguments);

/// Equal in value: entry by entry in arrays, lists, tuples and dicts; nan is nan, and 0 is -0. What cannot be
/// compared differs.
bool same(pybind11::handle a, pybind11::handle b);
/// A number that is the same for all that is the same.
Py_hash_t alike(pybind11::handle value);

/// `arguments(object)` gives the constructor's arguments as a dict and `make(dict)` an equal object.
template <class Class, class Arguments, class Make>
void keep(Class& bound, Arguments arguments, Make make) {
  bound.def(pybind11::pickle(arguments, make));
  bound.def("__copy__", [](pybind11::object self) { return self; });  // immutable
  bound.def(
      "__deepcopy__", [](pybind11::object self, const pybind11::dict&) { return self; },
      pybind11::arg("memo"));
}

/// Equality and hash by value.
template <class T, class Class, class Same, class Hash>
void compare(Class& bound, const Same& same, const Hash& hash) {
  bound.def(
      "__eq__",
      [same](const T& self, const pybind11::object& other) -> pybind11::object {
        if (!pybind11::isinstance<T>(other))
          return pybind11::reinterpret_borrow<pybind11::object>(Py_NotImplemented);
        return pybind11::bool_(same(self, other.cast<const T&>()));
      },
      pybind11::arg("other"));
  bound.def("__hash__", [hash](const T& self) { return pybind11::hash(hash(self)); });
}

/// The same of the arguments that make an equal object.
template <class T, class Class, class Arguments>
void compare_arguments(Class& bound, Arguments arguments) {
  compare<T>(
      bound, [arguments](const T& a, const T& b) { return same(arguments(a), arguments(b)); },
      [arguments](const T& x) { return pybind11::int_(alike(arguments(x))); });
}

/// All of it for a class whose constructor takes `arguments(object)` by name; `maker` is what Python calls
/// it.
template <class T, class Class, class Arguments>
void keep_as_code(Class& bound, const std::string& maker, Arguments arguments) {
  const pybind11::handle type = bound;
  keep(bound, arguments, [type](const pybind11::dict& given) { return type(**given).template cast<T>(); });
  bound.def("__repr__", [maker, arguments](const T& x) { return as_code(maker, arguments(x)); });
  compare_arguments<T>(bound, arguments);
}

template <class T, class M>
struct KeptField {
  const char* name;
  M T::* member;
};

/// Results are made of their fields, by name, pickled by them, and equal when these are; `maker` is what
/// Python calls the class.
template <class T, class Class, class... M>
void keep_fields(Class& bound, const std::string& maker, KeptField<T, M>... fields) {
  const auto make = [fields...](M... values) {
    T x;
    ((x.*(fields.member) = std::move(values)), ...);
    return x;
  };
  bound.def(pybind11::init(make), pybind11::kw_only(), pybind11::arg(fields.name)...);
  const auto state = [fields...](const T& x) {
    pybind11::dict all;
    ((all[fields.name] = x.*(fields.member)), ...);
    return all;
  };
  keep(bound, state, [fields...](const pybind11::dict& given) {
    T x;
    ((x.*(fields.member) = given[fields.name].template cast<M>()), ...);
    return x;
  });
  bound.def("__repr__", [maker, state](const T& x) { return as_code(maker, state(x)); });
  compare_arguments<T>(bound, state);
}
