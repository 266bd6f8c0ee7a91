// SPDX-License-Identifier: Apache-2.0
// Drivers: simulate, replay.
#include "bindings.hpp"
#include "budget.hpp"
#include "functions.hpp"
#include "garrison/drivers/contradiction.hpp"
#include "garrison/drivers/exceedances.hpp"
#include "garrison/drivers/simulate.hpp"
#include "known.hpp"

using namespace garrison;

namespace {

/// (sender, receiver, start, stop) each; None for all agents, or no end.
std::vector<Cut> cuts_of(const py::handle& given) {
  using Row = std::tuple<std::optional<int>, std::optional<int>, std::int64_t, std::optional<std::int64_t>>;
  std::vector<Cut> cuts;
  try {
    for (const auto& [sender, receiver, start, stop] : given.cast<std::vector<Row>>())
      cuts.push_back({sender.value_or(-1), receiver.value_or(-1), start, stop.value_or(INT64_MAX)});
  } catch (const py::cast_error&) {
    refuse("link.cuts", py::repr(given).cast<std::string>(), "a list of (sender, receiver, start, stop)",
           "None stands for all agents, or for no end");
  }
  return cuts;
}
/// (sample, round, sender, receiver) each.
std::vector<Lost> lost_of(const py::handle& given) {
  using Row = std::tuple<std::int64_t, int, int, int>;
  std::vector<Lost> lost;
  try {
    for (const auto& [sample, round, sender, receiver] : given.cast<std::vector<Row>>())
      lost.push_back({{sender, sample, round}, receiver});
  } catch (const py::cast_error&) {
    refuse("link.lost", py::repr(given).cast<std::string>(), "a list of (sample, round, sender, receiver)");
  }
  return lost;
}

RunOptions run_options(int trials, int first_trial, std::uint64_t seed, int threads,
                       const std::optional<Matrix>& start, const std::vector<AnyAttack>& attacks,
                       const py::dict& link, const std::vector<std::string>& keep, const Matrix& inputs,
                       const py::dict& series, std::shared_ptr<const Nonlinear> nonlinear,
                       const py::object& progress) {
  RunOptions o;
  o.trials = trials;
  o.first_trial = first_trial;
  o.seed = seed;
  o.threads = threads;
  o.inputs = inputs;
  o.series = series_of(series);
  o.nonlinear = std::move(nonlinear);
  if (start) o.start = start->transpose();  // Python has one row per agent
  for (const AnyAttack& attack : attacks) {
    if (attack.measurement) o.attacks.push_back(attack.measurement);
    if (attack.message) o.message_attacks.push_back(attack.message);
  }
  const std::vector<std::string> known{"drop", "delay", "delay_rounds", "cuts", "lost"};
  for (const auto& [key, value] : link) {
    const auto name = key.cast<std::string>();
    if (name == "drop")
      o.link.drop = value.cast<double>();
    else if (name == "delay")
      o.link.delay = value.cast<double>();
    else if (name == "delay_rounds")
      o.link.delay_rounds = value.cast<int>();
    else if (name == "cuts")
      o.link.cuts = cuts_of(value);
    else if (name == "lost")
      o.link.lost = lost_of(value);
    else
      refuse_unknown("link", name, known);
  }
  o.keep = {false, false, false, false, false, false, false, false};
  const std::vector<std::string> keepable{"estimate", "report", "signals", "measurements",
                                          "details",  "box",    "error",   "truth"};
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
    else if (name == "box")
      o.keep.report = o.keep.box = true;
    else if (name == "error")
      o.keep.error = true;
    else if (name == "truth")
      o.keep.truth = true;
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

/// f(name, numbers, lengths of the axes behind trial and time) of every array that a record holds.
template <class R, class F>
void each_array(R& r, const F& f) {
  using Shape = std::vector<py::ssize_t>;
  const py::ssize_t N = r.agents;
  const py::ssize_t n = r.states;
  const auto put = [&](const char* name, auto& numbers, Shape behind) {
    if (!numbers.empty()) f(name, numbers, std::move(behind));
  };
  put("truth", r.truth, r.own_states ? Shape{N, n} : Shape{n});
  put("measurements", r.measurements, {r.outputs});
  put("estimate", r.estimate, {N, n});
  put("error", r.error, {N});
  put("bound", r.bound, {N});
  put("box", r.box, {N, n});
  put("published", r.published, {N});
  put("bound_kind", r.bound_kind, {N});
  put("statistic", r.statistic, {N});
  put("threshold", r.threshold, {N});
  put("verdict", r.verdict, {N});
  put("signals", r.signals, {static_cast<py::ssize_t>(r.signal_names.size()), N});
}

/// The shape with `trials` and as many times as there are numbers for in front.
std::vector<py::ssize_t> whole_shape(std::size_t numbers, py::ssize_t trials,
                                     const std::vector<py::ssize_t>& behind) {
  auto times = static_cast<py::ssize_t>(numbers) / trials;
  for (const py::ssize_t length : behind) times /= length;
  std::vector<py::ssize_t> shape{trials, times};
  shape.insert(shape.end(), behind.begin(), behind.end());
  return shape;
}

/// What a Python function takes of a block: sink(trial, [(name, array, its first row, rows of a whole trial,
/// time of the first of those)]). The arrays are views that end with the call.
std::function<void(const Record&, int, int)> sink_of(const py::object& sink, int steps) {
  if (sink.is_none()) return {};
  return [sink, steps](const Record& block, int trial, int first) {
    const py::gil_scoped_acquire gil;
    py::list arrays;
    const py::capsule borrowed(&block, [](void*) {});
    each_array(block, [&](const std::string& name, const auto& numbers, const auto& behind) {
      auto shape = whole_shape(numbers.size(), 1, behind);
      shape.erase(shape.begin());
      using Number = typename std::decay_t<decltype(numbers)>::value_type;
      const int before = name == "measurements" ? block.first_sample : 0;  // times without this array
      arrays.append(py::make_tuple(name, py::array_t<Number>(shape, numbers.data(), borrowed),
                                   std::max(first - before, 0), steps + 1 - before, before));
    });
    sink(trial, arrays);
  };
}

/// What the data say against certificates with memory: a dict per trial and agent.
py::list doubts_of(const Record& r) {
  py::list all;
  for (const auto& [trial, agent, doubts] : r.doubted)
    all.append(py::dict(
        py::arg("trial") = trial, py::arg("agent") = agent, py::arg("refuted") = doubts.refuted,
        py::arg("refuted_at") = doubts.refuted_at, py::arg("apart") = doubts.apart,
        py::arg("apart_at") = doubts.apart_at, py::arg("apart_in") = doubts.apart_in,
        py::arg("evidence") = doubts.dependence.evidence, py::arg("source") = doubts.dependence.source,
        py::arg("correlation") = doubts.dependence.correlation, py::arg("pairs") = doubts.dependence.pairs));
  return all;
}

py::dict from_record(Record&& r) {
  if (r.interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  py::dict d;
  each_array(r, [&](const char* name, auto& numbers, const auto& behind) {
    auto shape = whole_shape(numbers.size(), r.trials, behind);
    d[name] = owned(std::move(numbers), std::move(shape));
  });
  d["trials"] = r.trials;
  d["steps"] = r.steps;
  d["signal_names"] = r.signal_names;
  py::list accusations;
  for (const auto& a : r.accusations) accusations.append(py::make_tuple(a.trial, a.time, a.sets));
  d["accusations"] = accusations;
  py::list proved;
  for (const auto& a : r.proved) proved.append(py::make_tuple(a.trial, a.time, a.sets));
  d["proved"] = proved;
  d["doubted"] = doubts_of(r);
  d["warnings"] = r.warnings;
  py::list details;
  for (const auto& entry : r.details)
    details.append(py::make_tuple(entry.trial, entry.time, entry.agent,
                                  r.detail_names[static_cast<std::size_t>(entry.name)], entry.values));
  d["details"] = details;
  d["counters"] = py::dict(
      py::arg("sent") = r.link.sent, py::arg("lost") = r.link.lost, py::arg("late") = r.link.late,
      py::arg("forged") = r.link.forged, py::arg("refused") = r.link.refused, py::arg("missing") = r.missing,
      py::arg("nonfinite") = r.nonfinite, py::arg("overflows") = r.overflows, py::arg("resets") = r.resets);
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

}  // namespace

void bind_drivers(py::module_& m) {
  m.def(
      "exceedances",
      [](const Array& statistic, const Array& threshold) {
        if (statistic.ndim() < 1 || shape_of(statistic) != shape_of(threshold))
          refuse("threshold", shape_of(threshold), "the shape of statistic, " + shape_of(statistic));
        const py::ssize_t N = statistic.shape(statistic.ndim() - 1);
        const auto numbers = [](const Array& a) {
          return std::span<const double>(a.data(), static_cast<std::size_t>(a.size()));
        };
        Exceedances found = exceedances(numbers(statistic), numbers(threshold), static_cast<int>(N));
        return py::make_tuple(owned(std::move(found.tests), {N}), owned(std::move(found.above), {N}));
      },
      py::arg("statistic"), py::arg("threshold"),
      "(tests, above) per agent, the last axis: samples with a test (no nan), and those above its "
      "threshold.");
  m.def(
      "contradictions",
      [](const Model& model, const Array& measurements, int attacked, bool for_good, bool constant,
         const std::vector<int>& owner, const Matrix& inputs) {
        if (measurements.ndim() != 3)
          refuse("measurements", shape_of(measurements), "trials x samples x outputs");
        const auto trials = static_cast<int>(measurements.shape(0));
        using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const Matrix rows = Eigen::Map<const Rows>(measurements.data(), trials * measurements.shape(1),
                                                   measurements.shape(2));
        const auto found = within_budget(kInfinity, [&] {
          return contradictions(model, rows, trials, {attacked, for_good, constant, owner, inputs});
        });
        py::list all;
        for (const Contradiction& one : found)
          all.append(py::make_tuple(one.refuted == Refuted::measurement_bound ? "measurement_bound"
                                    : one.refuted == Refuted::process_bound   ? "process_bound"
                                                                              : nullptr,
                                    one.row));
        return all;
      },
      py::arg("model"), py::arg("measurements"), py::kw_only(), py::arg("attacked"), py::arg("for_good"),
      py::arg("constant"), py::arg("owner"), py::arg("inputs"),
      "(bound, row) per trial: which bound measurements (trials, samples, outputs) refute whichever "
      "`attacked` "
      "sources lie, and\nwhere; (None, -1) = none. owner: whose each measurement is, [] = its agent's; "
      "inputs: "
      "row r leads from sample r to the next one.");
  m.def(
      "simulate",
      [](const std::shared_ptr<Prepared>& prepared, int steps, const Vector& x0, double start_error,
         const std::string& noise, const Matrix& disturbances, int trials, int first_trial,
         std::uint64_t seed, int threads, const std::optional<Matrix>& start,
         const std::vector<AnyAttack>& attacks, const py::dict& link, const std::vector<std::string>& keep,
         const Matrix& inputs, const py::dict& series, const py::dict& functions, const py::object& progress,
         const py::object& sink, std::size_t block_bytes) {
        RunOptions options =
            run_options(trials, first_trial, seed, threads, start, attacks, link, keep, inputs, series,
                        functions_of(functions, prepared->model()), progress);
        options.sink = sink_of(sink, steps);
        options.block_bytes = block_bytes;
        Record record;
        {
          const py::gil_scoped_release no_gil;
          record = simulate(*prepared, {steps, x0, start_error, noise, disturbances}, options);
        }
        return from_record(std::move(record));
      },
      py::arg("design"), py::kw_only(), py::arg("steps"), py::arg("x0"), py::arg("start_error"),
      py::arg("noise"), py::arg("disturbances"), py::arg("trials"), py::arg("first_trial"), py::arg("seed"),
      py::arg("threads"), py::arg("start"), py::arg("attacks"), py::arg("link"), py::arg("keep"),
      py::arg("inputs"), py::arg("series"), py::arg("functions"), py::arg("progress"),
      py::arg("sink") = py::none(), py::arg("block_bytes") = RunOptions().block_bytes,
      "Arrays of a simulated run; use garrison.simulate.");
  m.def(
      "replay",
      [](const std::shared_ptr<Prepared>& prepared, const Array& measurements,
         const std::optional<Array>& truth, int trials, int first_trial, std::uint64_t seed, int threads,
         const std::optional<Matrix>& start, const std::vector<AnyAttack>& attacks, const py::dict& link,
         const std::vector<std::string>& keep, const Matrix& inputs, const py::dict& series,
         const py::dict& functions, const py::object& progress, const py::object& sink,
         std::size_t block_bytes) {
        RunOptions options =
            run_options(trials, first_trial, seed, threads, start, attacks, link, keep, inputs, series,
                        functions_of(functions, prepared->model()), progress);
        const Log log = log_of(prepared->model(), prepared->filter(), measurements, truth);
        options.sink = sink_of(sink, log.steps);
        options.block_bytes = block_bytes;
        Record record;
        {
          const py::gil_scoped_release no_gil;
          record = replay(*prepared, log, options);
        }
        return from_record(std::move(record));
      },
      py::arg("design"), py::kw_only(), py::arg("measurements"), py::arg("truth"), py::arg("trials"),
      py::arg("first_trial"), py::arg("seed"), py::arg("threads"), py::arg("start"), py::arg("attacks"),
      py::arg("link"), py::arg("keep"), py::arg("inputs"), py::arg("series"), py::arg("functions"),
      py::arg("progress"), py::arg("sink") = py::none(), py::arg("block_bytes") = RunOptions().block_bytes,
      "Arrays of a replayed run; use garrison.replay.");
}
