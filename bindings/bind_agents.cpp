// SPDX-License-Identifier: Apache-2.0
// Designs, single agents and their messages.
#include "bindings.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/node/log.hpp"
#include "garrison/wire/letter.hpp"

using namespace garrison;
using wire::Letter;

namespace {

py::bytes to_python(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
/// Any object with a buffer of bytes.
std::vector<std::byte> from_python(const py::object& given, const char* which) {
  // A NumPy scalar has a buffer, too, but is a number.
  if (!PyObject_CheckBuffer(given.ptr()) || PyIndex_Check(given.ptr()))
    refuse(which, py::str(py::type::of(given).attr("__name__")).cast<std::string>(), "bytes");
  const auto view = py::bytes(py::module_::import("builtins").attr("bytes")(given));
  const auto content = static_cast<std::string_view>(view);
  const auto* first = reinterpret_cast<const std::byte*>(content.data());
  return {first, first + content.size()};
}

std::string hex(std::span<const std::byte> bytes) {
  return to_python(bytes).attr("hex")().cast<std::string>();
}

/// What an agent in Python is made of, so that it can be pickled: a whole design, or its part of one.
struct PyAgent {
  std::shared_ptr<const Prepared> prepared;  // null: from a part
  std::vector<std::byte> part;
  std::unique_ptr<Agent> agent;
  std::int64_t refused = 0;  // messages whose body was

  Agent* operator->() const { return agent.get(); }
  std::vector<std::byte> file() const { return prepared ? write_part(*prepared, agent->id()) : part; }
  std::vector<std::byte> snapshot() const {
    std::vector<std::byte> bytes(agent->snapshot_bytes());
    if (agent->save(bytes) == 0)
      refuse("agent", "an agent in the middle of a sample", "one between samples",
             "call fuse until all " + std::to_string(agent->rounds()) + " rounds are done");
    return bytes;
  }
};

PyAgent agent_from(const std::shared_ptr<const Prepared>& prepared, int id) {
  return {prepared, {}, prepared->agent(id)};
}
PyAgent agent_from(std::vector<std::byte> part) {
  auto agent = read_part(part);
  return {nullptr, std::move(part), std::move(agent)};
}

/// Counter, size of the part, part, snapshot.
std::vector<std::byte> kept(const PyAgent& a) {
  const std::vector<std::byte> part = a.file();
  const std::vector<std::byte> snapshot = a.snapshot();
  std::vector<std::byte> all(16);
  wire::store(all.data(), static_cast<std::uint64_t>(a.refused));
  wire::store(all.data() + 8, static_cast<std::uint64_t>(part.size()));
  all.insert(all.end(), part.begin(), part.end());
  all.insert(all.end(), snapshot.begin(), snapshot.end());
  return all;
}
PyAgent agent_kept(const std::vector<std::byte>& all) {
  const std::size_t size =
      all.size() < 16 ? 0 : static_cast<std::size_t>(wire::load<std::uint64_t>(all.data() + 8));
  if (all.size() < 16 || size > all.size() - 16) refuse("agent", "damaged bytes", "a pickled agent");
  const auto middle = all.begin() + 16 + static_cast<std::ptrdiff_t>(size);
  PyAgent a = agent_from(std::vector<std::byte>(all.begin() + 16, middle));
  if (a->load(std::vector<std::byte>(middle, all.end())) != Refusal::none)
    refuse("agent", "damaged bytes", "a pickled agent");
  a.refused = static_cast<std::int64_t>(wire::load<std::uint64_t>(all.data()));
  return a;
}

[[noreturn]] void refuse_call(const PyAgent& a, const char* call, Refusal why, std::int64_t t) {
  const std::string at = "sample " + std::to_string(a->sample());
  switch (why) {
    case Refusal::order:
      refuse(call, "a call in round " + std::to_string(a->round()) + " of " + at,
             a->round() < a->rounds() ? "fuse to be called first" : "sense to be called first",
             "this filter needs " + std::to_string(a->rounds()) + " rounds per sample");
    case Refusal::late:
      refuse(call, "t = " + std::to_string(t), "a sample after " + std::to_string(a->sample()),
             "an agent does not go back; use reset(x0, t) to start anew");
    case Refusal::early:
      refuse(call, "t = " + std::to_string(t),
             "at most " + std::to_string(Agent::kMostGap + 1) + " samples after " + at,
             "so much was missed: use reset(x0, t), or listen and join");
    default:
      refuse(call, "a refusal (" + std::string(word(why)) + ")", "a call that fits");
  }
}

Letter letter_of(const PyAgent& a, const std::vector<std::byte>& body, int round) {
  return {std::string(a->family()),
          {a->id(), a->sample(), round},
          a->agents(),
          a->fields(a->id(), a->sample()),
          body};
}

/// Delivers one message, with the reason in words where that is the caller's slip. A message that is late, or
/// that a liar has spoilt, is dropped and counted.
void deliver(PyAgent& a, const Letter& letter) {
  const Envelope& e = letter.envelope;
  const std::string from = "a message from agent " + std::to_string(e.sender);
  if (letter.family != a->family())
    refuse("inbox", "a message of " + letter.family, "messages of " + std::string(a->family()));
  const auto heard = a->neighbours();
  if (!std::binary_search(heard.begin(), heard.end(), e.sender))
    refuse("inbox", from, "messages from neighbours of agent " + std::to_string(a->id()));
  if (letter.fields != a->fields(e.sender, e.sample))
    refuse("inbox", from + " with other fields", "messages of the same design",
           "its agent was made for another model, network or filter");
  switch (const Refusal why = a->deliver(e, letter.body); why) {
    case Refusal::none:
      return;
    case Refusal::duplicate:
      refuse("inbox", "two messages from agent " + std::to_string(e.sender), "one per neighbour and round");
    case Refusal::early:
      refuse("inbox", from + " of sample " + std::to_string(e.sample) + ", round " + std::to_string(e.round),
             "messages of sample " + std::to_string(a->sample()));
    default:
      ++a.refused;
  }
}

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

wire::FieldValue field_value(const wire::FieldInfo& info, const py::object& given) {
  try {
    switch (info.kind) {
      case FieldKind::numbers:
      case FieldKind::sparse:
        return given.cast<std::vector<double>>();
      case FieldKind::optional:
        return given.cast<double>();
      case FieldKind::flag:
        return given.cast<bool>();
      case FieldKind::count:
        return given.cast<int>();
      case FieldKind::set:
        return wire::Labels{given.cast<std::vector<int>>(), false};
      case FieldKind::labels:
        break;
    }
    const auto pair = given.cast<std::pair<std::vector<int>, bool>>();
    return wire::Labels{pair.first, pair.second};
  } catch (const py::cast_error&) {
    refuse("message field " + info.name, py::repr(given).cast<std::string>(),
           "a value like the one it has now");
  }
}

void bind_message(py::module_& m) {
  py::class_<Letter>(
      m, "Message",
      "A message between agents of the same design; compares by value.\n\n"
      "What an agent sends is a list of fields: numbers, optional numbers (nan = absent), flags, counts\n"
      "and sets. sender, sample and round are the driver's, not the agent's.")
      .def_property_readonly("family", [](const Letter& l) { return l.family; })
      .def_property_readonly("sender", [](const Letter& l) { return l.envelope.sender; })
      .def_property_readonly("sample", [](const Letter& l) { return l.envelope.sample; })
      .def_property_readonly("round", [](const Letter& l) { return l.envelope.round; })
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
          py::arg("field"), py::arg("value"), "The same message with another value in one field: a lie.")
      .def(
          "to_bytes", [](const Letter& l) { return to_python(l.to_bytes()); },
          "Everything, to be kept or sent by other means; see from_bytes.")
      .def_static(
          "from_bytes",
          [](const py::object& data) { return Letter::from_bytes(from_python(data, "message")); },
          py::arg("data"), "The message that to_bytes() wrote. Raises InvalidInput for anything else.")
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
                    std::to_string(l.envelope.round) + ", " + std::to_string(l.body.size()) + " bytes";
           })
      .def(py::pickle([](const Letter& l) { return to_python(l.to_bytes()); },
                      [](const py::bytes& b) { return Letter::from_bytes(from_python(b, "message")); }));
}

void bind_agent(py::module_& m) {
  py::class_<PyAgent>(m, "Agent",
                      "One agent on its own: `sense` once per sample, then `fuse` once per round, with the "
                      "same bits as inside\n"
                      "simulate and replay. Time is the caller's: it may start at any sample, and says "
                      "nothing that a gap may have\n"
                      "broken.")
      .def(py::init([](const Model& model, const Network& network, const FilterHandle& filter, int id) {
             return agent_from(filter.filter->prepare(model, network), id);
           }),
           py::arg("model"), py::arg("network"), py::arg("filter"), py::arg("id"))
      .def_static(
          "from_part", [](const py::object& data) { return agent_from(from_python(data, "part")); },
          py::arg("data"), "The agent whose part of a design Prepared.part(id) wrote; nothing is designed.")
      .def_property_readonly("id", [](const PyAgent& a) { return a->id(); })
      .def_property_readonly("family", [](const PyAgent& a) { return std::string(a->family()); })
      .def_property_readonly(
          "rounds", [](const PyAgent& a) { return a->rounds(); }, "Rounds per sample.")
      .def_property_readonly(
          "neighbours",
          [](const PyAgent& a) {
            const auto all = a->neighbours();
            return std::vector<int>(all.begin(), all.end());
          },
          "Agents that it hears.")
      .def_property_readonly(
          "sample", [](const PyAgent& a) { return a->sample(); }, "The sample it is in, or has finished.")
      .def_property_readonly(
          "round", [](const PyAgent& a) { return a->round(); }, "Rounds of this sample that are done.")
      .def(
          "reset",
          [](PyAgent& a, const Vector& x0, std::optional<std::int64_t> t) {
            const std::int64_t at = t.value_or(a->start());
            switch (a->reset(x0, at)) {
              case Refusal::none:
                break;
              case Refusal::size:
                refuse("x0", std::to_string(x0.size()) + " numbers",
                       std::to_string(a->states()) + ", one per state");
              case Refusal::number:
                refuse("x0", "a number that is not finite, or beyond 1e150", "finite numbers");
              default:
                refuse("t", std::to_string(at), "a sample from " + std::to_string(a->start()) + " on",
                       "the estimate x0 is that of sample t");
            }
            a.refused = 0;
          },
          py::arg("x0"), py::arg("t") = py::none(),
          "Start anew with the estimate x0, (n,), of sample t. Without t: at the beginning of a run. At any\n"
          "other t nothing is known of how far x0 is off: there is no bound and no test until the family "
          "can\n"
          "vouch again, and in its next sample the agent sends nothing (None) and takes an estimate from "
          "what\n"
          "its neighbours send.")
      .def(
          "sense",
          [](PyAgent& a, std::int64_t t, const std::vector<double>& y) -> std::optional<Letter> {
            if (y.size() != static_cast<std::size_t>(a->outputs()))
              refuse("y", std::to_string(y.size()) + " numbers",
                     std::to_string(a->outputs()) + ", one per row of C[" + std::to_string(a->id()) + "]");
            std::vector<std::byte> body(a->most_bytes());
            const auto sent = a->sense(t, y, body);
            if (sent.refusal != Refusal::none) refuse_call(a, "sense", sent.refusal, t);
            if (sent.bytes == 0) return std::nullopt;
            body.resize(sent.bytes);
            return letter_of(a, body, 0);
          },
          py::arg("t"), py::arg("y"),
          "Sample t with one number per row of C_i, nan = missing. Returns the first message of this sample; "
          "None where\n"
          "the estimate is of no use (not finite). Samples missed since the last one are made up for, "
          "without\n"
          "measurements and messages.")
      .def(
          "fuse",
          [](PyAgent& a, const std::vector<std::optional<Letter>>& inbox) -> std::optional<Letter> {
            if (a->round() >= a->rounds()) refuse_call(a, "fuse", Refusal::order, a->sample());
            for (const auto& letter : inbox)
              if (letter) deliver(a, *letter);
            std::vector<std::byte> body(a->most_bytes());
            const auto sent = a->fuse(body);
            if (sent.refusal != Refusal::none) refuse_call(a, "fuse", sent.refusal, a->sample());
            if (sent.bytes == 0) return std::nullopt;
            body.resize(sent.bytes);
            return letter_of(a, body, a->round());
          },
          py::arg("inbox"),
          "End the round with the neighbours' messages of it, in any order; leave missing ones out. Messages "
          "of an earlier\n"
          "sample or round are dropped and counted, as are bodies that no agent could have sent. Returns the "
          "next\n"
          "message.")
      .def(
          "join",
          [](PyAgent& a, std::int64_t t, const std::vector<Letter>& inbox) {
            const Refusal why = a->listen(t);
            if (why != Refusal::none) refuse_call(a, "join", why, t);
            for (const Letter& letter : inbox) deliver(a, letter);
            a->join();
          },
          py::arg("t"), py::arg("inbox"),
          "Take over an estimate from what the neighbours sent in the first round of sample t, as an agent "
          "that starts in\n"
          "a running network: its next sample is t + 1.")
      .def(
          "uncover", [](PyAgent& a) { a->uncover(); },
          "Something was missed that only the caller knows of: no bound and no test rests on the past any "
          "more.")
      .def_property_readonly(
          "estimate",
          [](const PyAgent& a) {
            std::vector<double> x(static_cast<std::size_t>(a->states()));
            a->estimate(x);
            const auto size = static_cast<py::ssize_t>(x.size());
            return owned(std::move(x), {size});
          },
          "(n,)")
      .def_property_readonly(
          "accused", [](const PyAgent& a) { return a->accused(); }, "Agents that this one has accused.")
      .def_property_readonly(
          "control", [](const PyAgent& a) { return a->control(); },
          "Control input applied until the next sample; nan if the family has none.")
      .def_property_readonly(
          "dropped", [](const PyAgent& a) { return a.refused; },
          "Messages that were late, or whose body no agent could have sent.")
      .def_property_readonly(
          "resets", [](const PyAgent& a) { return a->resets(); },
          "How often the estimate was of no use and was taken anew from the neighbours.")
      .def_property_readonly("bound", [](const PyAgent& a) { return a->report().bound; })
      .def_property_readonly(
          "bound_kind", [](const PyAgent& a) { return static_cast<int>(a->report().kind); },
          "Value of garrison.BoundKind: where the bound comes from, or why there is none.")
      .def_property_readonly("statistic", [](const PyAgent& a) { return a->report().statistic; })
      .def_property_readonly("threshold", [](const PyAgent& a) { return a->report().threshold; })
      .def_property_readonly("verdict",
                             [](const PyAgent& a) { return static_cast<int>(a->report().verdict); })
      .def(
          "save", [](const PyAgent& a) { return to_python(a.snapshot()); },
          "A snapshot as bytes, between samples only; the agent that loads it goes on with the same bits.")
      .def(
          "load",
          [](PyAgent& a, const py::object& data) {
            const Refusal why = a->load(from_python(data, "snapshot"));
            if (why == Refusal::order) refuse_call(a, "load", why, a->sample());
            if (why != Refusal::none)
              refuse("snapshot", "bytes with a wrong " + std::string(word(why)),
                     "a snapshot of agent " + std::to_string(a->id()) + " of this very design");
          },
          py::arg("data"), "Go on from a snapshot. Raises InvalidInput for one of another agent or design.")
      .def(
          "__eq__",
          [](const PyAgent& a, const py::object& other) {
            if (!py::isinstance<PyAgent>(other)) return false;
            const auto& b = other.cast<const PyAgent&>();
            return a->round() == a->rounds() && b->round() == b->rounds() && a.snapshot() == b.snapshot() &&
                   a.file() == b.file();
          },
          py::arg("other"))
      .def("__hash__", [](const PyAgent& a) { return py::hash(to_python(a.file())); })
      .def("__repr__",
           [](const PyAgent& a) {
             return "<Agent " + std::to_string(a->id()) + " of " + std::string(a->family()) + ", sample " +
                    std::to_string(a->sample()) + ">";
           })
      .def(py::pickle([](const PyAgent& a) { return to_python(kept(a)); },
                      [](const py::bytes& b) { return agent_kept(from_python(b, "agent")); }));
}

void bind_log(py::module_& m) {
  m.def(
      "replay_log",
      [](const py::object& log) {
        const node::LogReplay r = node::replay_log(from_python(log, "log"));
        py::dict out;
        out["agent"] = r.agent;
        out["family"] = r.family;
        out["calls"] = r.calls;
        out["estimates"] = r.estimates;
        out["differ"] = r.wrong;
        out["first"] = r.first;
        out["last"] = r.last;
        out["ended"] = r.ended;
        return out;
      },
      py::arg("log"),
      "Do again what the log of a node (bytes of an MCAP file) says. Returns agent, family, calls, estimates "
      "(compared),\n"
      "differ (estimates that differ in a bit, and calls that were refused), first and last sample, ended "
      "(the "
      "node was\n"
      "stopped, not killed). Raises InvalidInput for anything but a log.");
}

constexpr const char* kSpreads[] = {"local", "flooded", "direct"};

std::optional<certificate::Wanted> wanted_of(const std::string& name, double failure, int attacked,
                                             const std::pair<double, double>& levels) {
  if (name == "none") return std::nullopt;
  certificate::Wanted wanted;
  wanted.failure = failure;
  wanted.attacked = attacked;
  std::tie(wanted.z1, wanted.z2) = levels;
  const auto* const found = std::find(std::begin(kSpreads), std::end(kSpreads), name);
  if (found == std::end(kSpreads)) {
    std::vector<std::string> known{"none"};
    known.insert(known.end(), std::begin(kSpreads), std::end(kSpreads));
    refuse_unknown("certificate", name, known);
  }
  wanted.spread = static_cast<certificate::Spread>(found - kSpreads);
  return wanted;
}

}  // namespace

void bind_agents(py::module_& m) {
  bind_message(m);
  bind_log(m);
  bind_agent(m);
  py::class_<Prepared, std::shared_ptr<Prepared>>(m, "Design", "A filter designed for one model and network.")
      .def(py::init([](const Model& model, const Network& network, const FilterHandle& filter,
                       const std::string& certificate, double failure, int attacked,
                       const std::pair<double, double>& levels) {
             const auto wanted = wanted_of(certificate, failure, attacked, levels);
             const py::gil_scoped_release no_gil;
             auto prepared = filter.filter->prepare(model, network);
             if (wanted) prepared = certified(*prepared, *wanted);
             return std::const_pointer_cast<Prepared>(prepared);
           }),
           py::arg("model"), py::arg("network"), py::arg("filter"), py::arg("certificate") = "none",
           py::arg("failure") = 1e-6, py::arg("attacked") = 0, py::arg("levels") = std::pair(0.0, 0.0))
      .def_property_readonly(
          "certificate",
          [](const Prepared& p) -> py::object {
            const auto plan = p.certificate();
            if (plan == nullptr) return py::none();
            const auto& wanted = plan->wanted;
            py::dict found(py::arg("certificate") = kSpreads[static_cast<std::size_t>(wanted.spread)],
                           py::arg("failure") = wanted.failure, py::arg("attacked") = wanted.attacked);
            if (wanted.z1 > 0.0) found["levels"] = std::pair(wanted.z1, wanted.z2);
            return found;
          },
          "What its runs certify (certificate, failure, attacked, and levels if given); None = nothing but "
          "the family's own "
          "bound.")
      .def_property_readonly("model", &Prepared::model)
      .def_property_readonly("network", &Prepared::network)
      .def_property_readonly("filter", [](const Prepared& p) { return filter_object(p.filter()); })
      .def_property_readonly("outline", &Prepared::gains_outline, "What the gains consist of, a line each.")
      .def(
          "agent", [](const std::shared_ptr<Prepared>& p, int id) { return agent_from(p, id); },
          py::arg("id"))
      .def(
          "part", [](const Prepared& p, int id) { return to_python(write_part(p, id)); }, py::arg("id"),
          "What agent `id` needs of the design, as bytes.")
      .def("to_bytes", [](const Prepared& p) { return to_python(write_design(p)); })
      .def_static(
          "from_bytes",
          [](const py::object& data) {
            return std::const_pointer_cast<Prepared>(read_design(from_python(data, "design file")));
          },
          py::arg("data"));
  m.def(
      "design_summary",
      [](const py::object& data) {
        const DesignSummary s = summary_of(from_python(data, "design file"));
        py::dict d;
        d["agent"] = s.part ? py::object(py::int_(s.agent)) : py::object(py::none());
        d["garrison"] = s.garrison;
        d["filter"] = s.filter;
        d["params"] = from_params(s.params);
        d["agents"] = s.agents;
        d["states"] = s.states;
        d["bytes"] = s.bytes;
        d["hash"] = hex(s.digest);
        return d;
      },
      py::arg("data"),
      "What a design file says of itself: filter, params, agents, states, bytes, hash, agent.");
}
