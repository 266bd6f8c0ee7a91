// SPDX-License-Identifier: Apache-2.0
#include "trials.hpp"

#include <atomic>
#include <mutex>

#include "course.hpp"
#include "garrison/engine/workers.hpp"
#include "recorder.hpp"

namespace garrison::detail {
namespace {

class RunnerVictims final : public Victims {
 public:
  RunnerVictims(const Runner& runner, const Course& course) : runner_(runner), course_(course) {}
  void expected(int agent, double* out) const override {
    runner_.expected(agent, out);
    course_.add(agent, out);
  }
  double alarm_level(int agent) const override { return runner_.alarm_level(agent); }

 private:
  const Runner& runner_;
  const Course& course_;
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

std::vector<std::unique_ptr<MeasurementAttack>> start_attacks(const Model& model, const RunOptions& options,
                                                              std::uint32_t trial) {
  std::vector<std::unique_ptr<MeasurementAttack>> attacks;
  std::uint32_t salt = 0;
  for (const Attack& plan : options.attacks)
    attacks.push_back(plan->start(model, Random(options.seed, trial, Purpose::attack), ++salt));
  return attacks;
}

/// One trial on its own runner.
void run_trial(const Prepared& prepared, const RunOptions& options, Runner& runner, Source& source,
               Recorder& recorder, int trial, Progress& progress, std::string& doubt) {
  const Model& model = prepared.model();
  const Network& network = prepared.network();
  const std::uint32_t id = drawn_as(options, static_cast<std::uint32_t>(trial));
  Link link(network, options.link, options.message_attacks, options.seed, id);
  auto attacks = start_attacks(model, options, id);
  Course course(model, options);
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
  recorder.doubts(trial, runner);
  recorder.end(trial);
  recorder.finish(link.counters, runner);
  doubt = course.doubt();
}

/// kLanes trials at once where the family can; trial by trial the same bits. False: some estimate grew so
/// large that agents might have rejoined, which these do not; their trials are then to be run one by one.
bool run_side_by_side(const Model& model, const RunOptions& options, TrialsRunner& runner,
                      const MakeSource& make, Recorder& recorder, int first, Progress& progress) {
  struct Lane {
    std::unique_ptr<Source> source;
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
  Course course(model, options);
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
  for (int l = 0; l < used; ++l) recorder.end(first + l);
  return fine;
}

bool fit_side_by_side(const RunOptions& options) {
  if (options.trials < 2 || options.keep.report || options.keep.signals || options.keep.details) return false;
  if (options.sink) return false;  // trials that are run again would be written twice
  if (!options.message_attacks.empty() || options.link.drop > 0.0 || options.link.delay > 0.0) return false;
  for (const Attack& attack : options.attacks)
    if (attack->closed_loop()) return false;
  return options.series == nullptr && options.nonlinear == nullptr;
}

void require_run(const Prepared& prepared, const RunOptions& options) {
  const Model& model = prepared.model();
  if (options.trials < 1) refuse("trials", std::to_string(options.trials), "at least 1");
  if (options.first_trial < 0 || options.first_trial > kMostTrials - options.trials)
    refuse("first_trial", std::to_string(options.first_trial),
           "a number >= 0 with first_trial + trials <= " + std::to_string(kMostTrials));
  for (const Attack& attack : options.attacks) attack->schedule().require_agents_below(model.agents());
  for (const auto& attack : options.message_attacks)
    if (!attack->fits(model.states()))
      refuse("attack", "numbers for another plant",
             "one per attacked agent and state (" + amount(model.states(), "state") + ")",
             "see the attack's covariance or deltas");
  const Link rehearsal(prepared.network(), options.link, options.message_attacks, options.seed, 0);
  prepared.check_start(starts(model, options.start));
}

/// What people should know of a run.
void warn(const Prepared& prepared, const RunOptions& options, std::string doubt, Record& record) {
  const AnyFilter& filter = prepared.filter();
  record.warnings =
      filter.warnings(prepared.model(), {record.verdict, record.trials, record.steps + 1, record.agents});
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
}

}  // namespace

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

Record run_trials(const Prepared& prepared, int steps, bool truth_known, const RunOptions& options,
                  const MakeSource& make) {
  require_run(prepared, options);
  const Model& model = prepared.model();
  Recorder recorder(prepared, steps, truth_known, options);
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
  warn(prepared, options, std::move(doubt), record);
  return record;
}

}  // namespace garrison::detail
