// SPDX-License-Identifier: Apache-2.0
// Messages between agents.
#include "bytes.hpp"
#include "convert.hpp"
#include "garrison/wire/letter.hpp"

using namespace garrison;
using wire::Letter;

namespace {

py::object value_of(const wire::FieldInfo& info, const wire::FieldValue& value) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    auto copy = *numbers;
    const auto size = static_cast<py::ssize_t>(copy.size());
    return owned(std::move(copy), {size});
  }
  if (const auto* number = std::get_if<double>(&value)) return py::float_(*number);
  if (const auto* flag = std::get_if<bool>(&value)) return py::bool_(*flag);
  if (const auto* count = std::get_if<int>(&value)) return py::int_(*count);
  const auto& labels = std::get<wire::Labels>(value);
  if (info.kind == FieldKind::set) return py::cast(labels.ids);
  return py::make_tuple(labels.ids, labels.complement);
}

std::vector<double> numbers_of(const std::string& which, const py::object& given, bool may_be_absent) {
  const auto array = convert::array(which, given, "a list of numbers");
  for (py::ssize_t k = 0; k < array.size(); ++k)
    if (const double x = array.data()[k]; !(std::abs(x) < kHuge) && !(may_be_absent && std::isnan(x)))
      refuse(which, text(x), "finite numbers of size below " + text(kHuge),
             "an agent does not send others, and refuses them");
  return {array.data(), array.data() + array.size()};
}

std::vector<int> ids_of(const std::string& which, const py::object& given) {
  std::vector<int> ids;
  for (const py::handle one : given) ids.push_back(convert::small(which, one));
  return ids;
}

wire::FieldValue field_value(const wire::FieldInfo& info, const py::object& given) {
  const std::string which = "message field " + info.name;
  const bool list = py::hasattr(given, "__iter__") && !py::isinstance<py::str>(given);
  switch (info.kind) {
    case FieldKind::numbers:
    case FieldKind::sparse:
      return numbers_of(which, given, info.kind == FieldKind::sparse);
    case FieldKind::optional:
      return convert::number(which, given);
    case FieldKind::flag:
      return convert::flag(which, given);
    case FieldKind::count:
      return convert::small(which, given);
    case FieldKind::set:
      if (!list) refuse(which, convert::shown(given), "a list of agents");
      return wire::Labels{ids_of(which, given), false};
    case FieldKind::labels:
      break;
  }
  if (!py::isinstance<py::tuple>(given) || py::len(given) != 2)
    refuse(which, convert::shown(given), "(ids, complement)");
  const auto pair = py::reinterpret_borrow<py::tuple>(given);
  return wire::Labels{ids_of(which, pair[0]), convert::flag(which, pair[1])};
}

}  // namespace

void bind_messages(py::module_& m) {
  py::class_<Letter>(
      m, "Message",
      "A message between agents of the same design; compares by value.\n\n"
      "What an agent sends is a list of fields: numbers, optional numbers (nan = absent), flags, counts\n"
      "and sets. sender, sample and round are the driver's, not the agent's.")
      .def_property_readonly(
          "family", [](const Letter& l) { return l.family; }, "Name of the filter that sent it.")
      .def_property_readonly(
          "sender", [](const Letter& l) { return l.envelope.sender; }, "Number of the agent.")
      .def_property_readonly(
          "sample", [](const Letter& l) { return l.envelope.sample; }, "Of which sample.")
      .def_property_readonly(
          "round", [](const Letter& l) { return l.envelope.round; }, "For which round of the sample, 0..")
      .def_property_readonly(
          "fields",
          [](const Letter& l) {
            py::dict all;
            const auto values = l.values();
            for (std::size_t k = 0; k < values.size(); ++k)
              all[py::str(l.fields[k].name)] = value_of(l.fields[k], values[k]);
            return all;
          },
          "Name -> value of every field: arrays, nan where a number is absent, bool, int, list of agents; a "
          "set of\n"
          "labels as (ids, complement).")
      .def_property_readonly(
          "body", [](const Letter& l) { return to_python(l.body); },
          "The bytes that travel, without sender, sample and round.")
      .def(
          "replace",
          [](const Letter& l, const std::string& field, const py::object& value) {
            std::vector<std::string> known;
            for (const auto& info : l.fields) known.push_back(info.name);
            const auto at = std::find(known.begin(), known.end(), field);
            if (at == known.end()) refuse_unknown("message of " + l.family, field, known);
            return l.with(field, field_value(l.fields[static_cast<std::size_t>(at - known.begin())], value));
          },
          py::arg("field"), py::arg("value"),
          numpydoc(R"(The same message with another value in one field: a lie.

field : str | Name of a field, as in `fields`.
value : array, float, bool or set of int | Of the kind and size that the field has.
< Message
! InvalidInput | No such field, or a value that does not fit it.)")
              .c_str())
      .def(
          "to_bytes", [](const Letter& l) { return to_python(l.to_bytes()); },
          "Everything, to be kept or sent by other means; see from_bytes.")
      .def_static(
          "from_bytes",
          [](const py::object& data) { return Letter::from_bytes(from_python(data, "message")); },
          py::arg("data"),
          numpydoc(R"(The message that to_bytes() wrote.

data : bytes | All of it.
< Message
! InvalidInput | Anything else.)")
              .c_str())
      .def(
          "__eq__",
          [](const Letter& l, const py::object& other) {
            return py::isinstance<Letter>(other) && l == other.cast<const Letter&>();
          },
          py::arg("other"))
      .def("__hash__", [](const Letter& l) { return py::hash(to_python(l.to_bytes())); })
      .def("__repr__",
           [](const Letter& l) {
             return "garrison.Message.from_bytes(bytes.fromhex(\"" + hex(l.to_bytes()) + "\"))";
           })
      .def("__str__",
           [](const Letter& l) {
             return "Message of " + l.family + " from agent " + std::to_string(l.envelope.sender) +
                    ", sample " + std::to_string(l.envelope.sample) + ", round " +
                    std::to_string(l.envelope.round) + ", " + amount(l.body.size(), "byte");
           })
      .def(py::pickle([](const Letter& l) { return to_python(l.to_bytes()); },
                      [](const py::bytes& b) { return Letter::from_bytes(from_python(b, "message")); }));
}
