// SPDX-License-Identifier: Apache-2.0
#include "own_family.hpp"

#include <algorithm>
#include <cctype>

#include "convert.hpp"
#include "garrison/core/params.hpp"

namespace own {

using garrison::kNaN;
using garrison::refuse;
using garrison::Report;
using garrison::Verdict;

namespace {

std::string where(const Session& s, const char* function, int id) {
  return s.name + "." + function + ", agent " + std::to_string(id) + ", sample " + std::to_string(s.t);
}

/// Calls the user's code under the lock. What it raises is kept for the runner; from then on nothing is
/// called any more.
template <class Call>
void call(Session& s, const char* function, int id, const Call& body) noexcept {
  if (s.failure) return;
  const py::gil_scoped_acquire gil;
  try {
    noted(where(s, function, id), body);
  } catch (const garrison::InvalidInput& error) {
    s.failure = std::make_exception_ptr(
        garrison::InvalidInput(std::string(error.what()) + " (" + where(s, function, id) + ")"));
  } catch (...) {
    s.failure = std::current_exception();
  }
}

/// `size` numbers that the user's code returned.
void read(const std::string& which, py::handle given, double* out, std::size_t size) {
  const auto array = convert::array(which, given);
  if (static_cast<std::size_t>(array.size()) != size)
    refuse(which, garrison::amount(array.size(), "number"), std::to_string(size));
  std::copy_n(array.data(), size, out);
}

/// A dict of named arrays as a message; None: nothing is sent, and numbers that are not finite never arrive.
void read_message(const Session& s, const std::string& which, py::handle given, std::vector<double>& out) {
  if (given.is_none()) return std::fill(out.begin(), out.end(), kNaN);
  const Layout& layout = s.layout;
  std::string names;
  for (const std::string& name : layout.names) names += (names.empty() ? "" : ", ") + name;
  if (!py::isinstance<py::dict>(given))
    refuse(which, convert::shown(given), "a message, a dict with " + names + ", or None to send nothing");
  const auto message = py::reinterpret_borrow<py::dict>(given);
  for (const auto& [key, value] : message)
    if (std::find(layout.names.begin(), layout.names.end(), py::str(key).cast<std::string>()) ==
        layout.names.end())
      refuse(which, "the unknown field " + py::repr(key).cast<std::string>(), "the fields " + names,
             "list a message's fields and sizes in `layout`");
  std::size_t at = 0;
  for (std::size_t k = 0; k < layout.names.size(); at += layout.sizes[k++]) {
    if (!message.contains(layout.names[k]))
      refuse(which, "no field \"" + layout.names[k] + "\"", "the fields " + names);
    read(which + "[\"" + layout.names[k] + "\"]", message[layout.names[k].c_str()], out.data() + at,
         layout.sizes[k]);
  }
}

py::dict inbox_of(const Session& s, const std::vector<std::pair<int, const double*>>& letters) {
  py::dict inbox;
  for (const auto& [sender, values] : letters) {
    py::dict message;
    const double* at = values;
    for (std::size_t k = 0; k < s.layout.names.size(); at += s.layout.sizes[k++])
      message[s.layout.names[k].c_str()] = array_of(at, s.layout.sizes[k]);
    inbox[py::int_(sender)] = message;
  }
  return inbox;
}

/// The state's estimate: an attribute, or an entry of a dict.
py::object estimate_of(const Session& s, const py::object& state) {
  const bool table = py::isinstance<py::dict>(state);
  if (table && state.contains("estimate")) return state["estimate"];
  if (!table && py::hasattr(state, "estimate")) return state.attr("estimate");
  refuse(s.name + ".start", convert::shown(state) + " as state",
         "an object with an attribute \"estimate\", or a dict with that entry");
}
void look(const Session& s, int id, garrison::Vector& x) {
  const auto& state = s.agents[static_cast<std::size_t>(id)].state;
  read(s.name + ": estimate of agent " + std::to_string(id), estimate_of(s, state), x.data(),
       static_cast<std::size_t>(x.size()));
}
void put_estimate(py::object& state, const garrison::Vector& x) {
  const auto value = array_of(x.data(), static_cast<std::size_t>(x.size()));
  if (py::isinstance<py::dict>(state))
    state["estimate"] = value;
  else
    state.attr("estimate") = value;
}

/// Where the entry "estimate" of a message is, if it is one of the plant's state.
std::ptrdiff_t place_of_estimate(const Layout& layout, std::size_t states) {
  std::size_t at = 0;
  for (std::size_t k = 0; k < layout.names.size(); at += layout.sizes[k++])
    if (layout.names[k] == "estimate" && layout.sizes[k] == states) return static_cast<std::ptrdiff_t>(at);
  return -1;
}

/// A verdict by its name or word (NOT_TESTED, not_tested, not tested), or as a garrison.Verdict.
Verdict verdict_of(const std::string& which, py::handle given) {
  const std::vector<std::string> words{"cleared", "suspected", "attacked", "silent", "not_tested"};
  if (py::isinstance<py::str>(given)) {
    auto word = given.cast<std::string>();
    for (char& letter : word)
      letter = letter == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    for (std::size_t k = 0; k < words.size(); ++k)
      if (word == words[k]) return static_cast<Verdict>(k);
    garrison::refuse_unknown(which, word, words);
  }
  const int value = convert::small(which, given);
  if (value < 0 || value >= garrison::kVerdicts)
    refuse(which, std::to_string(value), "a garrison.Verdict or its name");
  return static_cast<Verdict>(value);
}

void read_report(Session& s, int id, const py::dict& given, Report& r, garrison::AgentSet& accused) {
  const std::string which = s.name + ".report";
  std::vector<std::string> known{"bound", "statistic", "threshold", "verdict", "accused"};
  known.insert(known.end(), s.signals.begin(), s.signals.end());
  auto& signals = s.agents[static_cast<std::size_t>(id)].signals;
  std::fill(signals.begin(), signals.end(), kNaN);
  accused.clear();
  for (const auto& [key, value] : given) {
    const auto name = py::str(key).cast<std::string>();
    const auto signal = std::find(s.signals.begin(), s.signals.end(), name);
    if (name == "bound")
      r.bound = convert::number(which + ".bound", value);
    else if (name == "statistic")
      r.statistic = convert::number(which + ".statistic", value);
    else if (name == "threshold")
      r.threshold = convert::number(which + ".threshold", value);
    else if (name == "verdict")
      r.verdict = verdict_of(which + ".verdict", value);
    else if (name == "accused")
      for (const py::handle one : value) {
        const int agent = convert::small(which + ".accused", one);
        const int agents = static_cast<int>(s.agents.size());
        if (agent < 0 || agent >= agents)
          refuse(which + ".accused", std::to_string(agent), "agents in 0.." + std::to_string(agents - 1));
        accused.insert(agent);
      }
    else if (signal != s.signals.end())
      signals[static_cast<std::size_t>(signal - s.signals.begin())] =
          convert::number(which + "." + name, value);
    else
      garrison::refuse_unknown(which, name, known);
  }
}

}  // namespace

void Family::start(Session& s, int id, const Vector& x0, Vector& x) {
  call(s, "start", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    const auto given = array_of(x0.data(), static_cast<std::size_t>(x0.size()));
    agent.state = py::hasattr(s.filter, "start")
                      ? py::object(s.filter.attr("start")(agent.info, given))
                      : py::module_::import("types").attr("SimpleNamespace")(py::arg("estimate") = given);
    look(s, id, x);
  });
}

void Family::sense(Session& s, int id, std::span<const double> y, std::int64_t t, Vector& x,
                   std::vector<double>& out) noexcept {
  s.t = t;
  call(s, "sense", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    const py::object sent = s.filter.attr("sense")(agent.info, agent.state, array_of(y.data(), y.size()), t);
    read_message(s, s.name + ".sense", sent, out);
    look(s, id, x);
  });
}

void Family::fuse(Session& s, int id, const Letters& inbox, int round, Vector& x,
                  std::vector<double>& out) noexcept {
  call(s, "fuse", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    const py::object sent = s.filter.attr("fuse")(agent.info, agent.state, inbox_of(s, inbox), round);
    read_message(s, s.name + ".fuse", sent, out);
    look(s, id, x);
  });
}

void Family::rejoin(Session& s, int id, const Letters& inbox, std::int64_t t, Vector& x) noexcept {
  call(s, "rejoin", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    if (py::hasattr(s.filter, "rejoin")) {
      s.filter.attr("rejoin")(agent.info, agent.state, inbox_of(s, inbox), t);
      return look(s, id, x);
    }
    const auto at = place_of_estimate(s.layout, static_cast<std::size_t>(x.size()));
    const std::size_t heard = at < 0 ? 0 : inbox.size();
    garrison::median_into<garrison::Dynamic>(heard, [&](std::size_t k) { return inbox[k].second + at; }, x);
    put_estimate(agent.state, x);
  });
}

void Family::place(Session& s, int id, const Vector& x) noexcept {
  call(s, "estimate", id, [&] { put_estimate(s.agents[static_cast<std::size_t>(id)].state, x); });
}

Report Family::report(Session& s, int id, garrison::AgentSet& accused) noexcept {
  Report r;
  r.verdict = Verdict::not_tested;
  call(s, "report", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    if (!py::hasattr(s.filter, "report")) return;
    const py::object given = s.filter.attr("report")(agent.info, agent.state);
    if (!py::isinstance<py::dict>(given))
      refuse(s.name + ".report", convert::shown(given),
             "a dict, e.g. {\"statistic\": 0.3, \"threshold\": 1.0}");
    read_report(s, id, py::reinterpret_borrow<py::dict>(given), r, accused);
  });
  return r;
}

void Family::expected(Session& s, int id, std::span<double> out) noexcept {
  call(s, "expected", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    if (py::hasattr(s.filter, "expected"))
      read(s.name + ".expected", s.filter.attr("expected")(agent.info, agent.state), out.data(), out.size());
  });
}

double Family::alarm_level(Session& s, int id) noexcept {
  double level = garrison::kInfinity;
  call(s, "alarm_level", id, [&] {
    auto& agent = s.agents[static_cast<std::size_t>(id)];
    if (py::hasattr(s.filter, "alarm_level"))
      level = convert::number(s.name + ".alarm_level", s.filter.attr("alarm_level")(agent.info, agent.state));
  });
  return level;
}

}  // namespace own
