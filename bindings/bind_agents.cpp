// SPDX-License-Identifier: Apache-2.0
// Single agents.
#include "agents.hpp"
#include "bytes.hpp"
#include "garrison/core/covariance.hpp"
#include "garrison/core/series.hpp"
#include "garrison/wire/letter.hpp"

using namespace garrison;
using wire::Letter;

namespace {

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
             "this filter needs " + std::to_string(a->rounds()) + (a->rounds() == 1 ? " round" : " rounds") +
                 " per sample");
    case Refusal::late:
      refuse(call, "t = " + std::to_string(t), "a sample after " + std::to_string(a->sample()),
             "an agent does not go back; use reset(x0, t) to start anew");
    case Refusal::early:
      refuse(call, "t = " + std::to_string(t),
             "at most " + amount(Agent::kMostGap + 1, "sample") + " after " + at,
             "so much was missed: use reset(x0, t), or listen and join");
    default:
      refuse(call, "a refusal (" + std::string(word(why)) + ")", "a call that fits");
  }
}

/// Another plant, with the reason in words where it is refused.
void vary(PyAgent& a, const std::optional<Matrix>& A, const std::optional<Matrix>& C,
          const std::optional<Matrix>& Q, const std::optional<Matrix>& R) {
  const auto shape = [](Eigen::Index rows, Eigen::Index cols) {
    return std::to_string(rows) + " x " + std::to_string(cols);
  };
  const auto require = [&](const char* name, const std::optional<Matrix>& given, int rows, int cols) {
    if (!given) return;
    if (given->rows() != rows || given->cols() != cols)
      refuse(name, shape(given->rows(), given->cols()), shape(rows, cols));
  };
  require("A", A, a->states(), a->states());
  require("C", C, a->outputs(), a->states());
  require("process_covariance", Q, a->states(), a->states());
  require("measurement_covariance", R, a->outputs(), a->outputs());
  if (Q) require_covariance("process_covariance", *Q);
  if (R) require_covariance("measurement_covariance", *R);
  const Matrix W = R ? whitener(*R) : Matrix();
  if (R && W.size() != R->size())
    refuse("measurement_covariance", "a matrix that is not positive definite",
           "a symmetric positive definite one");
  const auto given = [](const std::optional<Matrix>& one) { return one ? &*one : nullptr; };
  const Change plant{.A = given(A), .C = given(C), .Q = given(Q), .W = R ? &W : nullptr};
  switch (const Refusal why = a->vary(plant); why) {
    case Refusal::none:
      return;
    case Refusal::foreign:
      refuse("vary",
             "an agent of " + std::string(a->family()) + " that is designed for one plant, or certified",
             "one of a filter that takes a VaryingModel, without a certificate",
             "see docs/how-to/changing-plants.md");
    default:
      refuse_call(a, "vary", why, a->sample());
  }
}

Letter letter_of(const PyAgent& a, const std::vector<std::byte>& body, int round) {
  return {std::string(a->family()),        a->design(), {a->id(), a->sample(), round}, a->agents(),
          a->fields(a->id(), a->sample()), body};
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
  if (letter.design != a->design() || letter.fields != a->fields(e.sender, e.sample))
    refuse("inbox", from + " of another design", "messages of the same design",
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

void take_snapshot(PyAgent& a, const py::object& data) {
  const Refusal why = a->load(from_python(data, "snapshot"));
  if (why == Refusal::order) refuse_call(a, "load", why, a->sample());
  if (why != Refusal::none)
    refuse("snapshot", "bytes with a wrong " + std::string(word(why)),
           "a snapshot of agent " + std::to_string(a->id()) + " of this very design");
}

std::string in_short(const PyAgent& a) {
  return "<Agent " + std::to_string(a->id()) + " of " + std::string(a->family()) + ", sample " +
         std::to_string(a->sample()) + ">";
}
std::string repr(const std::vector<std::byte>& bytes) {
  return py::repr(to_python(bytes)).cast<std::string>();
}

/// One number per state that `fill` writes.
auto per_state(const PyAgent& a, void (Agent::*fill)(std::span<double>) const noexcept) {
  std::vector<double> all(static_cast<std::size_t>(a->states()));
  ((*a.agent).*fill)(all);
  const auto size = static_cast<py::ssize_t>(all.size());
  return owned(std::move(all), {size});
}

}  // namespace

void bind_agents(py::module_& m) {
  py::class_<PyAgent>(
      m, "Agent",
      numpydoc(
          R"(One agent on its own: `sense` once per sample, then `fuse` once per round, with the same bits as inside
simulate and replay. Time is the caller's: it may start at any sample, and says nothing that a gap may have
broken.

model : Model | The plant and all sensors.
network : Network | Who hears whom.
filter : Filter | A family of garrison.filters, or a filter of your own.
id : int | Which agent, 0..N-1.
! InvalidInput | Sizes do not fit, or there is no such agent.
! DesignInfeasible | The filter cannot be designed for this model and network.)")
          .c_str())
      .def(py::init([](const Model& model, const Network& network, const FilterHandle& filter, int id) {
             return agent_from(filter.filter->prepare(model, network), id);
           }),
           py::arg("model"), py::arg("network"), py::arg("filter"), py::arg("id"))
      .def_static(
          "from_part",
          [](const py::object& data, const py::object& snapshot) {
            PyAgent a = agent_from(from_python(data, "part"));
            if (!snapshot.is_none()) take_snapshot(a, snapshot);
            return a;
          },
          py::arg("data"), py::arg("snapshot") = py::none(),
          numpydoc(R"(The agent whose part of a design Prepared.part(id) wrote; nothing is designed.

data : bytes | The part.
snapshot : bytes, optional | Of `save`; the agent goes on from there. Default: at the beginning of a run.
< Agent
! InvalidInput | No part of a design, or a snapshot of another agent or design.)")
              .c_str())
      .def_property_readonly(
          "id", [](const PyAgent& a) { return a->id(); }, "Its number, 0..N-1.")
      .def_property_readonly(
          "family", [](const PyAgent& a) { return std::string(a->family()); }, "Name of the filter.")
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
                refuse("x0", amount(x0.size(), "number"), std::to_string(a->states()) + ", one per state");
              case Refusal::number:
                refuse("x0", "a number that is not finite, or beyond 1e150", "finite numbers");
              default:
                refuse("t", std::to_string(at), "a sample from " + std::to_string(a->start()) + " on",
                       "the estimate x0 is that of sample t");
            }
            a.refused = 0;
          },
          py::arg("x0"), py::arg("t") = py::none(),
          numpydoc(
              R"(Start anew with an estimate. At any t but the beginning nothing is known of how far x0 is off: there is no
bound and no test until the family can vouch again, and in its next sample the agent sends nothing (None)
and takes an estimate from what its neighbours send.

x0 : (n,) array | Estimate of the state, in its units; finite, at most 1e150.
t : int, optional | The sample that x0 is the estimate of. Default: the beginning of a run.
! InvalidInput | A wrong size, a number that is not finite, or a sample before the beginning of a run.)")
              .c_str())
      .def(
          "vary",
          [](PyAgent& a, std::optional<Matrix> A, std::optional<Matrix> C, std::optional<Matrix> Q,
             std::optional<Matrix> R) { vary(a, A, C, Q, R); },
          py::kw_only(), py::arg("A") = py::none(), py::arg("C") = py::none(),
          py::arg("process_covariance") = py::none(), py::arg("measurement_covariance") = py::none(),
          numpydoc(
              R"(The plant of the next samples, until told again; for the filters that take a VaryingModel, with the bits of its
simulation. What is left out is the design's. `reset` and `load` go back to the design's: a snapshot does not hold the
plant, and an agent that goes on from one has to be told again.

A : (n, n) array, optional | Leads to the next sample.
C : (m_i, n) array, optional | Of the own sensor.
process_covariance : (n, n) array, optional | Of the noise on the way to the next sample; positive semidefinite.
measurement_covariance : (m_i, m_i) array, optional | Of the own sensor; positive definite.
! InvalidInput | Sizes that do not fit, numbers that are not finite, covariances that are none, a filter that is designed for
  one plant, an agent with a certificate, or a call within a sample.)")
              .c_str())
      .def(
          "sense",
          [](PyAgent& a, std::int64_t t, const std::vector<double>& y) -> std::optional<Letter> {
            if (y.size() != static_cast<std::size_t>(a->outputs()))
              refuse("y", amount(y.size(), "number"),
                     std::to_string(a->outputs()) + ", one per row of C[" + std::to_string(a->id()) + "]");
            std::vector<std::byte> body(a->most_bytes());
            const auto sent = a->sense(t, y, body);
            if (sent.refusal != Refusal::none) refuse_call(a, "sense", sent.refusal, t);
            if (sent.bytes == 0) return std::nullopt;
            body.resize(sent.bytes);
            return letter_of(a, body, 0);
          },
          py::arg("t"), py::arg("y"),
          numpydoc(
              R"(Take the measurement of sample t. Samples missed since the last one are made up for, without measurements
and messages.

t : int | The sample; later than the last one.
y : (m_i,) floats | One number per row of C[id], in its unit; nan = missing.
< Message or None | The first message of this sample; None where the estimate is of no use (not finite).
! InvalidInput | A wrong size, a round that is not finished, or a sample that is not after the last one or
  too long after it.)")
              .c_str())
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
          numpydoc(
              R"(End the round with the neighbours' messages of it. Messages of an earlier sample or round are dropped and
counted, as are bodies that no agent could have sent.

inbox : sequence of Message or None | At most one per neighbour, in any order; leave missing ones out, or
  give None.
< Message or None | The next message.
! InvalidInput | Called before `sense`, or a message of a stranger, another design or a later sample, or two
  of one neighbour.)")
              .c_str())
      .def(
          "join",
          [](PyAgent& a, std::int64_t t, const std::vector<Letter>& inbox, bool speak) {
            const Refusal why = a->listen(t);
            if (why != Refusal::none) refuse_call(a, "join", why, t);
            for (const Letter& letter : inbox) deliver(a, letter);
            a->join(speak);
          },
          py::arg("t"), py::arg("inbox"), py::arg("speak") = false,
          numpydoc(
              R"(Take over an estimate from what the neighbours sent in the first round of a sample, as an agent that starts
in a running network: its next sample is t + 1. Where nobody was heard the agent keeps its own, and says
nothing until it hears somebody.

t : int | The sample.
inbox : sequence of Message | At most one per neighbour.
speak : bool | Send the own estimate although nobody was heard, for networks in which nobody else speaks,
  either.
! InvalidInput | As `fuse`, or a sample that is not after the last one.)")
              .c_str())
      .def(
          "uncover", [](PyAgent& a) { a->uncover(); },
          "Something was missed that only the caller knows of, such as more than `attacked` measurements of\n"
          "the whole network in one sample: no bound and no test rests on the past any more.")
      .def_property_readonly(
          "estimate", [](const PyAgent& a) { return per_state(a, &Agent::estimate); }, "(n,)")
      .def_property_readonly(
          "accused", [](const PyAgent& a) { return a->accused(); }, "Agents that this one has accused.")
      .def_property_readonly(
          "proved", [](const PyAgent& a) { return a->proved(); },
          "Sources that its certificate with memory has shown to be attacked, numbered in the order of their "
          "first\n"
          "measurement in the network.")
      .def_property_readonly(
          "box", [](const PyAgent& a) { return per_state(a, &Agent::box); },
          "(n,) bounds on the error of each coordinate; `bound` is that of all together.")
      .def_property_readonly(
          "control", [](const PyAgent& a) { return a->control(); },
          "Control input applied until the next sample; nan if the family has none.")
      .def_property_readonly(
          "dropped", [](const PyAgent& a) { return a.refused; },
          "Messages that were late, or whose body no agent could have sent.")
      .def_property_readonly(
          "resets", [](const PyAgent& a) { return a->resets(); },
          "How often the estimate was of no use and was taken anew from the neighbours.")
      .def_property_readonly(
          "bound", [](const PyAgent& a) { return a->report().bound; },
          "On the error of its estimate, in the norm of the state; inf or nan: none, bound_kind says why.")
      .def_property_readonly(
          "bound_kind", [](const PyAgent& a) { return static_cast<int>(a->report().kind); },
          "Value of garrison.BoundKind: where the bound comes from, or why there is none.")
      .def_property_readonly(
          "statistic", [](const PyAgent& a) { return a->report().statistic; },
          "Of the test of its own sensor; nan = not tested.")
      .def_property_readonly(
          "threshold", [](const PyAgent& a) { return a->report().threshold; },
          "The level that the statistic is compared with; nan = not tested.")
      .def_property_readonly(
          "verdict", [](const PyAgent& a) { return static_cast<int>(a->report().verdict); },
          "Value of garrison.Verdict, of its own sensor.")
      .def(
          "save", [](const PyAgent& a) { return to_python(a.snapshot()); },
          "A snapshot as bytes, between samples only; the agent that loads it goes on with the same bits.")
      .def("load", &take_snapshot, py::arg("data"),
           numpydoc(R"(Go on from a snapshot.

data : bytes | Of `save`, of this agent and design. A plant that `vary` told is not in it and has to be told again.
! InvalidInput | A snapshot of another agent or design, damaged bytes, or within a sample.)")
               .c_str())
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
             if (a->round() < a->rounds()) return in_short(a);  // nothing can be kept within a sample
             return "garrison.Agent.from_part(" + repr(a.file()) + ", " + repr(a.snapshot()) + ")";
           })
      .def("__str__", &in_short)
      .def(py::pickle([](const PyAgent& a) { return to_python(kept(a)); },
                      [](const py::bytes& b) { return agent_kept(from_python(b, "agent")); }));
}
