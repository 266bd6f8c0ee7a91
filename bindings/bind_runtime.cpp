// SPDX-License-Identifier: Apache-2.0
// Drivers: simulate, replay, single agents.
#include "bindings.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;

namespace {

RunOptions run_options(int trials, std::uint64_t seed, int threads, const std::optional<Matrix>& start,
                       const std::vector<AnyAttack>& attacks, const py::dict& link,
                       const std::vector<std::string>& keep, const py::object& progress) {
  RunOptions o;
  o.trials = trials;
  o.seed = seed;
  o.threads = threads;
  if (start) o.start = start->transpose();  // Python has one row per agent
  for (const AnyAttack& attack : attacks) {
    if (attack.measurement) o.attacks.push_back(attack.measurement);
    if (attack.message) o.message_attacks.push_back(attack.message);
  }
  const std::vector<std::string> known{"drop", "delay", "delay_rounds"};
  for (const auto& [key, value] : link) {
    const auto name = key.cast<std::string>();
    if (name == "drop")
      o.link.drop = value.cast<double>();
    else if (name == "delay")
      o.link.delay = value.cast<double>();
    else if (name == "delay_rounds")
      o.link.delay_rounds = value.cast<int>();
    else
      refuse_unknown("link", name, known);
  }
  o.keep = {false, false, false, false, false};
  const std::vector<std::string> keepable{"estimate", "report", "signals", "measurements", "details"};
  for (const std::string& name : keep) {
    if (name == "estimate")
      o.keep.estimate = true;
    else if (name == "report")
      o.keep.report = true;
    else if (name == "signals")
      o.keep.signals = true;
    else if (name == "measurements")
      o.keep.measurements = true;
    else if (name == "details")
      o.keep.details = true;
    else
      refuse_unknown("keep", name, keepable);
  }
  // The callback also lets Ctrl-C through: the run stops and the interrupt is raised when it has.
  o.progress = [progress](std::int64_t done, std::int64_t total) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) {
      PyErr_Clear();
      return false;
    }
    if (!progress.is_none()) progress(done, total);
    return true;
  };
  return o;
}

py::dict from_record(Record&& r) {
  if (r.interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  const py::ssize_t K = r.trials;
  const py::ssize_t T = r.steps + 1;
  const py::ssize_t N = r.agents;
  const py::ssize_t n = r.states;
  const auto S = static_cast<py::ssize_t>(r.signal_names.size());
  py::dict d;
  const auto put = [&](const char* name, auto&& numbers, std::vector<py::ssize_t> shape) {
    if (!numbers.empty()) d[name] = owned(std::move(numbers), std::move(shape));
  };
  const py::ssize_t samples = T - r.first_sample;
  const auto M = static_cast<py::ssize_t>(r.measurements.size()) / (K * samples);
  put("truth", r.truth,
      r.own_states ? std::vector<py::ssize_t>{K, T, N, n} : std::vector<py::ssize_t>{K, T, n});
  put("measurements", r.measurements, {K, samples, M});
  put("estimate", r.estimate, {K, T, N, n});
  put("error", r.error, {K, T, N});
  put("bound", r.bound, {K, T, N});
  put("statistic", r.statistic, {K, T, N});
  put("threshold", r.threshold, {K, T, N});
  put("verdict", r.verdict, {K, T, N});
  put("signals", r.signals, {K, T, S, N});
  d["signal_names"] = r.signal_names;
  py::list accusations;
  for (const auto& a : r.accusations) accusations.append(py::make_tuple(a.trial, a.time, a.sets));
  d["accusations"] = accusations;
  d["warnings"] = r.warnings;
  py::list details;
  for (const auto& entry : r.details)
    details.append(py::make_tuple(entry.trial, entry.time, entry.agent,
                                  r.detail_names[static_cast<std::size_t>(entry.name)], entry.values));
  d["details"] = details;
  d["counters"] = py::dict(py::arg("sent") = r.link.sent, py::arg("lost") = r.link.lost,
                           py::arg("late") = r.link.late, py::arg("forged") = r.link.forged,
                           py::arg("refused") = r.link.refused, py::arg("missing") = r.missing,
                           py::arg("nonfinite") = r.nonfinite, py::arg("overflows") = r.overflows);
  d["bytes_per_step"] = r.bytes_per_step;
  return d;
}

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_of(const Array& a) { return py::str(a.attr("shape")).cast<std::string>(); }

/// (samples, M), or (trials, samples, M); truth likewise, of agents with states of their own (.., N, n).
Log log_of(const Model& model, const AnyFilter& filter, const Array& y, const std::optional<Array>& truth) {
  const int M = model.total_outputs();
  const py::ssize_t dims = y.ndim();
  if ((dims != 2 && dims != 3) || y.shape(dims - 1) != M)
    refuse("measurements", shape_of(y),
           "(samples, " + std::to_string(M) + ") or (trials, samples, " + std::to_string(M) + ")",
           "one column per row of the C_i, agent by agent; nan where a measurement is missing");
  const py::ssize_t steps = y.shape(dims - 2) + filter.first_sample() - 1;
  if (truth) {
    std::vector<py::ssize_t> expected(y.shape(), y.shape() + dims);
    expected[static_cast<std::size_t>(dims) - 2] = steps + 1;
    expected.back() = model.states();
    if (filter.own_states()) expected.insert(expected.end() - 1, model.agents());
    if (!std::equal(expected.begin(), expected.end(), truth->shape(), truth->shape() + truth->ndim()))
      refuse("truth", shape_of(*truth), py::str(py::tuple(py::cast(expected))).cast<std::string>(),
             filter.first_sample() == 0 ? "one row per time"
                                        : "one row per time, the first one before the first measurement");
  }
  return {y.data(), truth ? truth->data() : nullptr, dims == 2 ? 1 : static_cast<int>(y.shape(0)),
          static_cast<int>(steps)};
}

/// What sense and fuse return in Python.
struct Letter {
  std::shared_ptr<AnyMessage> message;
};

}  // namespace

void bind_runtime(py::module_& m) {
  m.def(
      "simulate",
      [](const Model& model, const Network& network, const FilterHandle& filter, int steps, const Vector& x0,
         double start_error, const std::string& noise, const Matrix& disturbances, int trials,
         std::uint64_t seed, int threads, const std::optional<Matrix>& start,
         const std::vector<AnyAttack>& attacks, const py::dict& link, const std::vector<std::string>& keep,
         const py::object& progress) {
        const RunOptions options = run_options(trials, seed, threads, start, attacks, link, keep, progress);
        Record record;
        {
          const py::gil_scoped_release no_gil;
          record = simulate(model, network, *filter.filter, {steps, x0, start_error, noise, disturbances},
                            options);
        }
        return from_record(std::move(record));
      },
      py::arg("model"), py::arg("network"), py::arg("filter"), py::kw_only(), py::arg("steps"), py::arg("x0"),
      py::arg("start_error"), py::arg("noise"), py::arg("disturbances"), py::arg("trials"), py::arg("seed"),
      py::arg("threads"), py::arg("start"), py::arg("attacks"), py::arg("link"), py::arg("keep"),
      py::arg("progress"), "Arrays of a simulated run; use garrison.simulate.");
  m.def(
      "replay",
      [](const Model& model, const Network& network, const FilterHandle& filter, const Array& measurements,
         const std::optional<Array>& truth, int trials, std::uint64_t seed, int threads,
         const std::optional<Matrix>& start, const std::vector<AnyAttack>& attacks, const py::dict& link,
         const std::vector<std::string>& keep, const py::object& progress) {
        const RunOptions options = run_options(trials, seed, threads, start, attacks, link, keep, progress);
        const Log log = log_of(model, *filter.filter, measurements, truth);
        Record record;
        {
          const py::gil_scoped_release no_gil;
          record = replay(model, network, *filter.filter, log, options);
        }
        return from_record(std::move(record));
      },
      py::arg("model"), py::arg("network"), py::arg("filter"), py::kw_only(), py::arg("measurements"),
      py::arg("truth"), py::arg("trials"), py::arg("seed"), py::arg("threads"), py::arg("start"),
      py::arg("attacks"), py::arg("link"), py::arg("keep"), py::arg("progress"),
      "Arrays of a replayed run; use garrison.replay.");

  py::class_<Letter>(m, "Message", "A message between agents of the same filter.")
      .def_property_readonly("sender", [](const Letter& l) { return l.message->sender(); })
      .def_property_readonly(
          "values",
          [](const Letter& l) {
            auto numbers = l.message->values();
            const auto size = static_cast<py::ssize_t>(numbers.size());
            return owned(std::move(numbers), {size});
          },
          "Its numbers (a copy).");

  py::class_<AnyAgent>(
      m, "Agent",
      "One agent on its own: `sense` once per sample, then `fuse` once per round, with the same bits as\n"
      "inside simulate and replay.")
      .def(py::init([](const FilterHandle& filter, const Model& model, const Network& network, int id) {
             return filter.filter->prepare(model, network)->agent(id);
           }),
           py::arg("filter"), py::arg("model"), py::arg("network"), py::arg("id"))
      .def_property_readonly("id", &AnyAgent::id)
      .def_property_readonly("rounds", &AnyAgent::rounds, "Rounds per sample.")
      .def("reset", &AnyAgent::reset, py::arg("x0"), "Back to time 0 with the initial estimate x0, (n,).")
      .def(
          "sense", [](AnyAgent& a, const std::vector<double>& y) { return Letter{a.sense(y)}; }, py::arg("y"),
          "One number per row of C_i, nan = missing. Returns the first message of this sample.")
      .def(
          "fuse",
          [](AnyAgent& a, const std::vector<Letter>& inbox) {
            std::vector<std::shared_ptr<AnyMessage>> all;
            for (const Letter& l : inbox) all.push_back(l.message);
            return Letter{a.fuse(all)};
          },
          py::arg("inbox"),
          "Messages of the neighbours in any order; leave missing ones out. Returns the next message.")
      .def_property_readonly("estimate", &AnyAgent::estimate, "(n,)")
      .def_property_readonly("accused", &AnyAgent::accused, "Agents that this one believes to be attacked.")
      .def_property_readonly("control", &AnyAgent::control,
                             "What it does to its own plant until the next sample; nan where it has none.")
      .def_property_readonly("dropped", &AnyAgent::dropped,
                             "Messages dropped because a number was not finite.")
      .def_property_readonly("bound", [](const AnyAgent& a) { return a.report().bound; })
      .def_property_readonly("statistic", [](const AnyAgent& a) { return a.report().statistic; })
      .def_property_readonly("threshold", [](const AnyAgent& a) { return a.report().threshold; })
      .def_property_readonly("verdict",
                             [](const AnyAgent& a) { return static_cast<int>(a.report().verdict); });
}
