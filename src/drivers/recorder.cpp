// SPDX-License-Identifier: Apache-2.0
#include "recorder.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "garrison/kernel/magnitude.hpp"

namespace garrison::detail {

Recorder::Recorder(const Prepared& prepared, int steps, bool truth_known, const RunOptions& options)
    : keep_(options.keep),
      truth_known_(truth_known),
      certified_(prepared.certificate() != nullptr),
      vouch_(options.message_attacks.empty()),
      direct_(certified_ && prepared.certificate()->wanted.spread == certificate::Spread::direct),
      outputs_(static_cast<std::size_t>(prepared.model().total_outputs())),
      remembers_(certified_ && prepared.certificate()->wanted.memory),
      sink_(options.sink) {
  const Model& model = prepared.model();
  const AnyFilter& filter = prepared.filter();
  Record& r = record_;
  r.trials = options.trials;
  r.steps = steps;
  r.agents = model.agents();
  r.states = model.states();
  r.outputs = model.total_outputs();
  r.first_sample = filter.first_sample();
  r.own_states = filter.own_states();
  if (keep_.signals) r.signal_names = filter.signal_names();
  if (keep_.details) r.detail_names = filter.detail_names();
  const auto trials = static_cast<std::size_t>(r.trials);
  const auto times = static_cast<std::size_t>(steps + 1);
  if (sink_) {
    std::size_t bytes = 0;  // of one time
    arrays(r, [&](auto& array, std::size_t width) { bytes += width * sizeof(array[0]); });
    block_ = static_cast<int>(
        std::clamp<std::size_t>(options.block_bytes / std::max<std::size_t>(bytes, 1), 1, times));
    open_.resize(trials);
  } else {
    lay_out(r, trials * times, trials * (times - static_cast<std::size_t>(r.first_sample)));
  }
  estimates_.resize(trials);
  if (keep_.details) lists_.resize(trials);
  last_.resize(trials);
  proved_.resize(trials);
  counts_.resize(trials);
}

template <class F>
void Recorder::arrays(Record& r, const F& f) const {
  const auto N = static_cast<std::size_t>(r.agents);
  const auto n = static_cast<std::size_t>(r.states);
  const std::size_t reported = keep_.report ? N : 0;
  f(r.truth, truth_known_ && keep_.truth ? (r.own_states ? N * n : n) : 0);
  f(r.error, truth_known_ && keep_.error ? N : 0);
  f(r.measurements, keep_.measurements ? outputs_ : 0);
  f(r.estimate, keep_.estimate ? N * n : 0);
  f(r.bound, reported);
  f(r.bound_kind, reported);
  f(r.box, keep_.box ? reported * n : 0);
  f(r.published, certified_ ? reported : 0);
  f(r.statistic, reported);
  f(r.threshold, reported);
  f(r.verdict, reported);
  f(r.signals, N * r.signal_names.size());
}

void Recorder::lay_out(Record& record, std::size_t times, std::size_t samples) const {
  arrays(record, [&](auto& array, std::size_t width) {
    const bool sampled = static_cast<const void*>(&array) == &record.measurements;
    array.resize((sampled ? samples : times) * width);
  });
}

/// With room for all its times, so that a run allocates nothing from sample to sample.
std::unique_ptr<Record> Recorder::new_block() {
  auto block = std::make_unique<Record>();
  block->trials = 1;
  block->agents = record_.agents;
  block->states = record_.states;
  block->outputs = record_.outputs;
  block->first_sample = record_.first_sample;
  block->own_states = record_.own_states;
  block->signal_names = record_.signal_names;
  const auto times = static_cast<std::size_t>(block_);
  lay_out(*block, times, times);
  return block;
}

void Recorder::begin(int trial) {
  const auto k = static_cast<std::size_t>(trial);
  counts_[k] = {};
  if (!sink_) return;
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) spare_.push_back(new_block());
  open_[k] = std::move(spare_.back());
  spare_.pop_back();
}

void Recorder::end(int trial) {
  const auto k = static_cast<std::size_t>(trial);
  last_[k] = {};
  proved_[k] = {};
  estimates_[k] = {};
  if (keep_.details) lists_[k] = {};
  if (!sink_) return;
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(open_[k]));
}

void Recorder::start_block(int trial, int t) {
  Record& block = page(trial);
  const int last = t + std::min(block_ - 1, record_.steps - t);
  block.steps = last - t;
  const int samples = last - std::max(t, record_.first_sample) + 1;
  lay_out(block, static_cast<std::size_t>(last - t + 1), static_cast<std::size_t>(std::max(samples, 0)));
}

std::size_t Recorder::row(int trial, int t) const {
  if (sink_) return static_cast<std::size_t>(t - first_of(t));
  return static_cast<std::size_t>(trial) * static_cast<std::size_t>(record_.steps + 1) +
         static_cast<std::size_t>(t);
}

double* Recorder::estimate(int trial, int t) {
  if (keep_.estimate) return page(trial).estimate.data() + row(trial, t) * size();
  auto& scratch = estimates_[static_cast<std::size_t>(trial)];
  scratch.resize(size());
  return scratch.data();
}

bool Recorder::errors(Record& record, std::size_t row, const double* estimate, const double* truth) const {
  const auto n = static_cast<std::size_t>(record_.states);
  const auto N = static_cast<std::size_t>(record_.agents);
  const std::size_t width = record_.own_states ? N * n : n;
  if (keep_.truth) std::copy_n(truth, width, record.truth.data() + row * width);
  bool usable = all_below(truth, width, kSurelyUsable / 2.0);
  for (std::size_t i = 0; i < N; ++i, truth += record_.own_states ? n : 0) {
    double square = 0.0;
    for (std::size_t k = 0; k < n; ++k)
      square += (estimate[i * n + k] - truth[k]) * (estimate[i * n + k] - truth[k]);
    if (keep_.error) record.error[row * N + i] = std::sqrt(square);
    usable = usable && square < kSurelyUsable * kSurelyUsable / 4.0;
  }
  return usable;
}

void Recorder::count(int trial, int t, std::span<const double> y) {
  if (!all_below(y.data(), y.size(), kHuge)) {
    Counts& counts = counts_[static_cast<std::size_t>(trial)];
    for (const double v : y) {
      counts.missing += std::isnan(v) ? 1 : 0;
      counts.nonfinite += std::abs(v) >= kHuge ? 1 : 0;
    }
  }
  if (!keep_.measurements) return;
  const int first = record_.first_sample;
  const auto at =
      sink_ ? static_cast<std::size_t>(t - std::max(first_of(t), first))
            : static_cast<std::size_t>(trial) * static_cast<std::size_t>(record_.steps + 1 - first) +
                  static_cast<std::size_t>(t - first);
  std::copy(y.begin(), y.end(),
            page(trial).measurements.begin() + static_cast<std::ptrdiff_t>(at * outputs_));
}

void Recorder::move(double* estimates, const double* shift) const {
  if (shift == nullptr) return;
  const auto n = static_cast<std::size_t>(record_.states);
  for (std::size_t k = 0; k < size(); ++k) estimates[k] += shift[k % n];
}

void Recorder::take(int trial, int t, const Runner& runner, const double* truth, std::span<const double> y,
                    const double* shift) {
  if (sink_ && t == first_of(t)) start_block(trial, t);
  const std::size_t at = row(trial, t);
  const auto N = static_cast<std::size_t>(record_.agents);
  Record& r = page(trial);
  Frame frame;
  frame.estimate = estimate(trial, t);
  if (keep_.report) {
    frame.bound = r.bound.data() + at * N;
    frame.bound_kind = r.bound_kind.data() + at * N;
    if (!r.box.empty()) frame.box = r.box.data() + at * size();
    if (!r.published.empty()) frame.published = r.published.data() + at * N;
    frame.statistic = r.statistic.data() + at * N;
    frame.threshold = r.threshold.data() + at * N;
    frame.verdict = r.verdict.data() + at * N;
  }
  if (keep_.signals) frame.signals = r.signals.data() + at * N * r.signal_names.size();
  frame.believed = vouch_;
  runner.read(frame);
  move(frame.estimate, shift);
  if (!vouch_ && frame.bound != nullptr) disown(frame);
  if (truth != nullptr && (keep_.error || keep_.truth)) errors(r, at, frame.estimate, truth);
  if (keep_.report) accusations(trial, t, runner);
  if (keep_.report && remembers_ && (vouch_ || direct_)) proofs(trial, t, runner);
  if (keep_.details) details(trial, t, runner);
  if (t >= record_.first_sample) count(trial, t, y);
  if (!sink_ || t != first_of(t) + r.steps) return;
  const std::lock_guard lock(sink_mutex_);
  sink_(r, trial, first_of(t));
}

/// Agents lie: what rests on their word is no bound. A direct certificate does not.
void Recorder::disown(const Frame& frame) const {
  const auto of_measurements = [](std::uint8_t kind) {
    const auto k = static_cast<CertificateKind>(kind);
    return k == CertificateKind::witness || k == CertificateKind::relayed || k == CertificateKind::too_few ||
           k == CertificateKind::refuted || k == CertificateKind::memory;
  };
  const auto n = static_cast<std::size_t>(record_.states);
  for (std::size_t i = 0; i < static_cast<std::size_t>(record_.agents); ++i) {
    if (direct_ && of_measurements(frame.bound_kind[i])) continue;
    frame.bound[i] = kNaN;
    if (frame.box != nullptr) std::fill_n(frame.box + i * n, n, kNaN);
    frame.bound_kind[i] = static_cast<std::uint8_t>(CertificateKind::liars);
  }
}

void Recorder::accusations(int trial, int t, const Runner& runner) {
  auto& last = last_[static_cast<std::size_t>(trial)];
  const auto N = static_cast<std::size_t>(record_.agents);
  if (last.empty() && runner.accused(0).empty()) return;  // nobody keeps such sets
  bool changed = last.empty();
  last.resize(N);
  for (std::size_t i = 0; i < N; ++i) {
    const AgentSet& now = runner.accused(static_cast<int>(i));
    if (!(last[i] == now)) {
      last[i] = now;
      changed = true;
    }
  }
  if (!changed) return;
  Record::Accusation entry{trial, t, {}};
  for (const AgentSet& set : last) {
    auto& ids = entry.sets.emplace_back();
    for (int id = 0; id < record_.agents; ++id)
      if (!set.empty() && set.contains(id)) ids.push_back(id);
  }
  const std::lock_guard lock(mutex_);
  record_.accusations.push_back(std::move(entry));
}

void Recorder::proofs(int trial, int t, const Runner& runner) {
  auto& last = proved_[static_cast<std::size_t>(trial)];
  last.resize(static_cast<std::size_t>(record_.agents));
  bool changed = t == 0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    const std::span<const int> now = runner.proved(static_cast<int>(i));
    if (std::equal(now.begin(), now.end(), last[i].begin(), last[i].end())) continue;
    last[i].assign(now.begin(), now.end());
    changed = true;
  }
  if (!changed) return;
  const std::lock_guard lock(mutex_);
  record_.proved.push_back({trial, t, last});
}

void Recorder::doubts(int trial, const Runner& runner) {
  if (!remembers_ || !(vouch_ || direct_)) return;  // agents that lie may have said anything
  for (int i = 0; i < record_.agents; ++i) {
    const certificate::Doubts found = runner.doubts(i);
    if (!found.any()) continue;
    const std::lock_guard lock(mutex_);
    record_.doubted.push_back({trial, i, found});
  }
}

void Recorder::details(int trial, int t, const Runner& runner) {
  auto& last = lists_[static_cast<std::size_t>(trial)];
  const auto names = static_cast<int>(record_.detail_names.size());
  last.resize(static_cast<std::size_t>(record_.agents) * static_cast<std::size_t>(names));
  std::vector<double> now;
  std::size_t at = 0;
  for (int i = 0; i < record_.agents; ++i) {
    for (int k = 0; k < names; ++k, ++at) {
      now.clear();
      runner.detail(i, static_cast<std::size_t>(k), now);
      if (now == last[at]) continue;
      last[at] = now;
      const std::lock_guard lock(mutex_);
      record_.details.push_back({trial, t, i, k, now});
    }
  }
}

void Recorder::finish(const LinkCounters& link, const Runner& runner) {
  const std::lock_guard lock(mutex_);
  record_.link += link;
  record_.overflows += runner.overflows();
  record_.resets += runner.resets();
  record_.refuted |= runner.refuted();
  bytes_ += runner.bytes_per_step();
  ++finished_;
}

Record Recorder::release() {
  for (const Counts& counts : counts_) {
    record_.missing += counts.missing;
    record_.nonfinite += counts.nonfinite;
  }
  if (finished_ > 0) record_.bytes_per_step = (bytes_ + finished_ / 2) / finished_;
  // Threads finish trials in any order; the record must not depend on it.
  for (auto* sets : {&record_.accusations, &record_.proved})
    std::sort(sets->begin(), sets->end(), [](const auto& a, const auto& b) {
      return std::tie(a.trial, a.time) < std::tie(b.trial, b.time);
    });
  std::sort(record_.doubted.begin(), record_.doubted.end(), [](const auto& a, const auto& b) {
    return std::tie(a.trial, a.agent) < std::tie(b.trial, b.agent);
  });
  std::sort(record_.details.begin(), record_.details.end(), [](const auto& a, const auto& b) {
    return std::tie(a.trial, a.time, a.agent, a.name) < std::tie(b.trial, b.time, b.agent, b.name);
  });
  return std::move(record_);
}

}  // namespace garrison::detail
