// SPDX-License-Identifier: Apache-2.0
#include "garrison/drivers/simulate.hpp"

#include <atomic>
#include <cmath>
#include <mutex>

#include "course.hpp"
#include "garrison/engine/workers.hpp"
#include "plant.hpp"
#include "recorder.hpp"

namespace garrison {
namespace {

/// Of the run's trial 0, 1, ..
using MakeSource = std::function<std::unique_ptr<detail::Source>(std::uint32_t trial)>;

/// The number under which a trial of this run draws its random numbers.
std::uint32_t drawn_as(const RunOptions& options, std::uint32_t trial) {
  return static_cast<std::uint32_t>(options.first_trial) + trial;
}

class RunnerVictims final : public Victims {
 public:
  RunnerVictims(const Runner& runner, const detail::Course& course) : runner_(runner), course_(course) {}
  void expected(int agent, double* out) const override {
    runner_.expected(agent, out);
    course_.add(agent, out);
  }
  double alarm_level(int agent) const override { return runner_.alarm_level(agent); }

 private:
  const Runner& runner_;
  const detail::Course& course_;
};

/// Reports progress from many threads, one at a time, and remembers whether to go on.
class Progress {
 public:
  Progress(const RunOptions& options, std::int64_t total) : report_(options.progress), total_(total) {}
  /// Counts samples; false = stop.
  bool advance(int samples = 1) {
    const std::int64_t done = done_ += samples;
    if (report_ && done * 100 / total_ != (done - samples) * 100 / total_) {
      const std::lock_guard lock(mutex_);
      if (!report_(done, total_)) go_ = false;
    }
    return go_;
  }
  bool stopped() const { return !go_; }

 private:
  const std::function<bool(std::int64_t, std::int64_t)>& report_;
  std::int64_t total_;
  std::atomic<std::int64_t> done_{0};
  std::atomic<bool> go_{true};
  std::mutex mutex_;
};

Matrix starts(const Model& model, const Matrix& given) {
  const int n = model.states();
  const int N = model.agents();
  if (given.size() == 0) return Matrix::Zero(n, N);
  if (given.rows() != n || (given.cols() != 1 && given.cols() != N))
    refuse("start", std::to_string(given.cols()) + " x " + std::to_string(given.rows()) + " numbers",
           "1 x " + std::to_string(n) + " or " + std::to_string(N) + " x " + std::to_string(n),
           "agents x states: one initial estimate for all, or one per agent");
  if (!(given.cwiseAbs().maxCoeff() < kHuge))
    refuse("start", "a number that is not finite, or beyond 1e150", "finite initial estimates");
  return given.cols() == N ? given : given.replicate(1, N);
}

std::vector<std::unique_ptr<MeasurementAttack>> start_attacks(const Model& model, const RunOptions& options,
                                                              std::uint32_t trial) {
  std::vector<std::unique_ptr<MeasurementAttack>> attacks;
  std::uint32_t salt = 0;
  for (const Attack& plan : options.attacks)
    attacks.push_back(plan->start(model, Random(options.seed, trial, Purpose::attack), ++salt));
  return attacks;
}

/// One trial on its own runner.
void run_trial(const Prepared& prepared, const RunOptions& options, Runner& runner, detail::Source& source,
               detail::Recorder& recorder, int trial, Progress& progress, std::string& doubt) {
  const Model& model = prepared.model();
  const Network& network = prepared.network();
  const std::uint32_t id = drawn_as(options, static_cast<std::uint32_t>(trial));
  Link link(network, options.link, options.message_attacks, options.seed, id);
  auto attacks = start_attacks(model, options, id);
  detail::Course course(model, options);
  const RunnerVictims victims(runner, course);
  recorder.begin(trial);
  std::vector<double> y(static_cast<std::size_t>(model.total_outputs()));
  runner.reset(source.start(starts(model, options.start)), link.perfect() ? nullptr : &link);
  source.meet(runner);
  const auto sample = [&](int t) {
    source.next(t, y);
    if (!course.plain()) course.enter(t, runner);
    for (auto& attack : attacks) attack->apply({t, y, victims});
    runner.step(t, course.without(y).data());
  };
  if (recorder.record().first_sample == 0) sample(0);
  recorder.take(trial, 0, runner, source.truth(), y, nullptr);
  for (int t = 1; t <= recorder.record().steps; ++t) {
    sample(t);
    recorder.take(trial, t, runner, source.truth(), y, course.shift());
    if (!progress.advance()) return;
  }
  recorder.finish(link.counters, runner);
  doubt = course.doubt();
}

/// kLanes trials at once where the family can; trial by trial the same bits. False: some estimate grew so
/// large that agents might have rejoined, which these do not; their trials are then to be run one by one.
bool run_side_by_side(const Model& model, const RunOptions& options, TrialsRunner& runner,
                      const MakeSource& make, detail::Recorder& recorder, int first, Progress& progress) {
  struct Lane {
    std::unique_ptr<detail::Source> source;
    std::vector<std::unique_ptr<MeasurementAttack>> attacks;
  };
  struct Nobody final : Victims {  // closed-loop attacks never come here
    void expected(int, double*) const override {}
    double alarm_level(int) const override { return kNaN; }
  } nobody;
  const auto& record = recorder.record();
  const int used = std::min(kLanes, record.trials - first);
  const auto M = static_cast<std::size_t>(model.total_outputs());
  std::vector<Lane> lanes;
  std::vector<Matrix> x0;
  const Matrix start = starts(model, options.start);
  for (int l = 0; l < kLanes; ++l) {
    const auto trial = static_cast<std::uint32_t>(first + std::min(l, used - 1));
    lanes.push_back({make(trial), start_attacks(model, options, drawn_as(options, trial))});
    x0.push_back(lanes.back().source->start(start));
  }
  std::vector<double> y(M);
  std::vector<double> all(M * kLanes);
  runner.reset(x0.data());
  const auto truth = [&](int lane) { return lanes[static_cast<std::size_t>(lane)].source->truth(); };
  bool fine = recorder.take_side_by_side(first, used, 0, runner, truth, nullptr);
  detail::Course course(model, options);
  for (int t = 1; t <= record.steps; ++t) {
    if (!course.plain()) course.enter(t);
    for (int l = 0; l < kLanes; ++l) {
      auto& lane = lanes[static_cast<std::size_t>(l)];
      lane.source->next(t, y);
      for (auto& attack : lane.attacks) attack->apply({t, y, nobody});
      const auto rest = course.without(y);
      for (std::size_t k = 0; k < M; ++k) all[k * kLanes + static_cast<std::size_t>(l)] = rest[k];
      if (l < used) recorder.count(first + l, t, y);
    }
    runner.step(all.data());
    fine = recorder.take_side_by_side(first, used, t, runner, truth, course.shift()) && fine;
    if (!progress.advance(used)) return true;
  }
  return fine;
}

bool fit_side_by_side(const RunOptions& options) {
  if (options.trials < 2 || options.keep.report || options.keep.signals || options.keep.details) return false;
  if (!options.message_attacks.empty() || options.link.drop > 0.0 || options.link.delay > 0.0) return false;
  for (const Attack& attack : options.attacks)
    if (attack->closed_loop()) return false;
  return options.series == nullptr;
}

Record drive(const Prepared& prepared, int steps, bool truth_known, const RunOptions& options,
             const MakeSource& make) {
  const Model& model = prepared.model();
  const Network& network = prepared.network();
  const AnyFilter& filter = prepared.filter();
  if (options.trials < 1) refuse("trials", std::to_string(options.trials), "at least 1");
  if (options.first_trial < 0 || options.first_trial > kMostTrials - options.trials)
    refuse("first_trial", std::to_string(options.first_trial),
           "a number >= 0 with first_trial + trials <= " + std::to_string(kMostTrials));
  for (const Attack& attack : options.attacks) attack->schedule().require_agents_below(model.agents());
  for (const auto& attack : options.message_attacks)
    if (!attack->fits(model.states()))
      refuse("attack", "numbers for another plant",
             "one per attacked agent and state (" + std::to_string(model.states()) + " states)",
             "see the attack's covariance or deltas");
  const Link rehearsal(network, options.link, options.message_attacks, options.seed, 0);
  prepared.check_start(starts(model, options.start));
  detail::Recorder recorder(prepared, steps, truth_known, options);
  Progress progress(options, static_cast<std::int64_t>(steps) * options.trials);
  const int threads = thread_count(options.threads);
  std::mutex mutex;
  std::exception_ptr failure;
  std::string doubt;  // the same of all trials: inputs are
  const auto guarded = [&](const auto& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  const auto one_by_one = [&](std::int64_t begin, std::int64_t end, Runner& runner) {
    for (auto trial = begin; trial < end && !progress.stopped(); ++trial) {
      const auto source = make(static_cast<std::uint32_t>(trial));
      std::string found;
      run_trial(prepared, options, runner, *source, recorder, static_cast<int>(trial), progress, found);
      if (trial == 0) doubt = std::move(found);
    }
  };
  if (const auto probe = fit_side_by_side(options) ? prepared.trials() : nullptr; probe != nullptr) {
    const auto alone = prepared.runner(1);  // lanes keep no messages to measure
    alone->reset(starts(model, options.start), nullptr);
    recorder.finish({}, *alone);
    const int groups = (options.trials + kLanes - 1) / kLanes;
    Workers workers(std::min(threads, groups));
    workers.split(groups, [&](std::int64_t begin, std::int64_t end, int) {
      guarded([&] {
        const auto runner = prepared.trials();
        for (auto g = begin; g < end && !progress.stopped(); ++g) {
          const int first = static_cast<int>(g) * kLanes;
          if (!run_side_by_side(model, options, *runner, make, recorder, first, progress))
            one_by_one(first, std::min(first + kLanes, options.trials), *prepared.runner(1));
        }
      });
    });
  } else {
    Workers workers(std::min(threads, options.trials));
    const int inner = options.trials == 1 ? threads : 1;
    workers.split(options.trials, [&](std::int64_t begin, std::int64_t end, int) {
      guarded([&] { one_by_one(begin, end, *prepared.runner(inner)); });
    });
  }
  if (failure) std::rethrow_exception(failure);
  Record record = recorder.release();
  record.interrupted = progress.stopped();
  record.warnings = filter.warnings(model, {record.verdict, record.trials, record.steps + 1, record.agents});
  if (!doubt.empty()) record.warnings.push_back(std::move(doubt));
  for (std::string& words : filter.refuted(record.refuted)) record.warnings.push_back(std::move(words));
  if (!options.message_attacks.empty()) {
    const auto plan = prepared.certificate();
    const bool direct = plan != nullptr && plan->wanted.spread == certificate::Spread::direct;
    record.warnings.push_back("Agents lie in their messages: " +
                              std::string(direct ? "no bound but the direct certificate's" : "no bound") +
                              " is reported, and a sensor called attacked may be honest, because both "
                              "rest on what agents tell each other.");
  }
  if (record.resets > 0)
    record.warnings.push_back("Estimates overflowed and were taken anew from the neighbours " +
                              std::to_string(record.resets) + " times: the filter diverged.");
  return record;
}

}  // namespace

Record simulate(const Prepared& prepared, const PlantOptions& plant, const RunOptions& options) {
  const Model& model = prepared.model();
  if (plant.steps < 1) refuse("steps", std::to_string(plant.steps), "at least 1");
  detail::require_course(prepared, options, plant.steps);
  const bool own = prepared.filter().own_states();
  const int width = own ? model.agents() * model.states() : model.states();
  if (plant.x0.size() != 0 && plant.x0.size() != width)
    refuse("x0", std::to_string(plant.x0.size()) + " numbers",
           std::to_string(width) + (own ? ", one per agent and state" : ", one per state"));
  if (!plant.x0.allFinite()) refuse("x0", "a number that is not finite", "a finite initial state");
  if (!(plant.start_error >= 0.0) || !std::isfinite(plant.start_error))
    refuse("start_error", text(plant.start_error), "a finite number >= 0");
  if (own) {
    const Matrix* recorded = plant.disturbances.size() == 0 ? nullptr : &plant.disturbances;
    if (recorded != nullptr && recorded->rows() != plant.steps + 1)
      refuse("noise", std::to_string(recorded->rows()) + " rows of recorded disturbances",
             std::to_string(plant.steps + 1) + ", one per time 0..steps");
    const Matrix start = starts(model, options.start);
    return drive(prepared, plant.steps, true, options, [&](std::uint32_t trial) {
      return detail::world_source(prepared.world({plant.x0, start, plant.start_error, plant.noise, recorded,
                                                  options.seed, drawn_as(options, trial)}),
                                  model.agents());
    });
  }
  if (plant.disturbances.size() != 0)
    refuse("noise", "recorded disturbances", "the name of a noise law",
           "only families whose agents drive plants of their own take recorded ones");
  const detail::NoiseLaw law(plant.noise, model, options.series.get());
  return drive(prepared, plant.steps, true, options, [&](std::uint32_t trial) {
    return detail::simulated_source(model, law, plant, options, drawn_as(options, trial));
  });
}

Record simulate(const Model& model, const Network& network, const AnyFilter& filter,
                const PlantOptions& plant, const RunOptions& options) {
  return simulate(*filter.prepare(model, network), plant, options);
}

Record replay(const Prepared& prepared, const Log& log, const RunOptions& options) {
  const Model& model = prepared.model();
  if (log.steps < 1) refuse("measurements", std::to_string(log.steps) + " samples", "at least 1");
  detail::require_course(prepared, options, log.steps);
  if (log.runs != 1 && log.runs != options.trials)
    refuse("trials", std::to_string(options.trials), std::to_string(log.runs) + ", one per run of the log",
           "a log of one run serves any number of trials");
  const auto rows = static_cast<std::size_t>(log.runs) *
                    static_cast<std::size_t>(log.steps + 1 - prepared.filter().first_sample());
  prepared.check_log({log.measurements, rows * static_cast<std::size_t>(model.total_outputs())});
  const int width = prepared.filter().own_states() ? model.agents() * model.states() : model.states();
  return drive(prepared, log.steps, log.truth != nullptr, options, [&](std::uint32_t trial) {
    return detail::recorded_source(model, log, log.runs == 1 ? 0 : trial, width,
                                   prepared.filter().first_sample());
  });
}

Record replay(const Model& model, const Network& network, const AnyFilter& filter, const Log& log,
              const RunOptions& options) {
  return replay(*filter.prepare(model, network), log, options);
}

Record replay(const Model& model, const Network& network, const AnyFilter& filter,
              const MatrixRef& measurements, const MatrixRef& truth, const RunOptions& options) {
  const auto shape = [](const MatrixRef& m) {
    return std::to_string(m.rows()) + " x " + std::to_string(m.cols());
  };
  if (measurements.rows() < 1 || measurements.cols() != model.total_outputs())
    refuse("measurements", shape(measurements), "steps x " + std::to_string(model.total_outputs()),
           "one column per row of the C_i, agent by agent; NaN where a measurement is missing");
  const auto steps = measurements.rows() + filter.first_sample() - 1;
  const int width = filter.own_states() ? model.agents() * model.states() : model.states();
  if (truth.size() != 0 && (truth.rows() != steps + 1 || truth.cols() != width))
    refuse("truth", shape(truth), std::to_string(steps + 1) + " x " + std::to_string(width),
           "one row per time 0..steps");
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Rows y = measurements;
  const Rows x = truth;
  return replay(model, network, filter,
                Log{y.data(), x.size() == 0 ? nullptr : x.data(), 1, static_cast<int>(steps)}, options);
}

}  // namespace garrison
