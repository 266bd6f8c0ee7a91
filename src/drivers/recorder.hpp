// SPDX-License-Identifier: Apache-2.0
// Writes one trial after the other into a Record, or block by block into a sink. Internal to the drivers.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <span>

#include "garrison/drivers/simulate.hpp"
#include "garrison/kernel/magnitude.hpp"

namespace garrison::detail {

/// Trials write to disjoint parts of the arrays, or to blocks of their own, so threads need no lock except
/// for the counters and the sink.
class Recorder {
 public:
  Recorder(const Prepared& prepared, int steps, bool truth_known, const RunOptions& options);

  const Record& record() const { return record_; }
  /// Everything asked for at time t of a trial; y is what the network received (not read at t = 0), `shift`
  /// what is added to every estimate (n numbers; null = nothing).
  void take(int trial, int t, const Runner& runner, const double* truth, std::span<const double> y,
            const double* shift);
  /// The same of the trials first .. first + used - 1, which run side by side: estimates and errors. Not into
  /// a sink, which cannot take back what it was given.
  /// `truth(lane)`: null when it is not known. False: an estimate is so large that it may not have been of
  /// use.
  template <class Truth>
  bool take_side_by_side(int first, int used, int t, const TrialsRunner& runner, const Truth& truth,
                         const double* shift) {
    std::array<double*, kLanes> out{};
    for (int l = 0; l < used; ++l) out[static_cast<std::size_t>(l)] = estimate(first + l, t);
    runner.read(out.data(), used);
    bool fine = true;
    for (int l = 0; l < used; ++l) {
      double* const estimates = out[static_cast<std::size_t>(l)];
      // Before the shift: what is too large for the filter is so in its own coordinates.
      fine = fine && (shift == nullptr || all_below(estimates, size(), kSurelyUsable));
      move(estimates, shift);
      if (const double* x = truth(l))
        fine = errors(record_, row(first + l, t), estimates, x) && fine;
      else
        fine = fine && all_below(estimates, size(), kSurelyUsable);
    }
    return fine;
  }
  /// Counts and keeps the measurements of time t >= 1.
  void count(int trial, int t, std::span<const double> y);
  /// Forgets what was counted of a trial that is about to be run (again), and gives it a block.
  void begin(int trial);
  /// Frees what only a trial that runs needs.
  void end(int trial);
  /// What the data of a trial say against certificates with memory, at its end.
  void doubts(int trial, const Runner& runner);
  void finish(const LinkCounters& link, const Runner& runner);
  Record release();

 private:
  /// Averages of estimates below this are averages of estimates below kHuge, however small the weights.
  static constexpr double kSurelyUsable = 1e100;
  struct Counts {
    std::int64_t missing = 0;
    std::int64_t nonfinite = 0;
  };
  /// Numbers of all estimates at one time.
  std::size_t size() const {
    return static_cast<std::size_t>(record_.agents) * static_cast<std::size_t>(record_.states);
  }
  /// f(array, numbers of it at one time) of every array; 0 where it is not kept.
  template <class F>
  void arrays(Record& record, const F& f) const;
  /// Makes the arrays that are kept as large as times and samples.
  void lay_out(Record& record, std::size_t times, std::size_t samples) const;
  std::unique_ptr<Record> new_block();
  /// Where a trial is written to, and which of the times there is t.
  Record& page(int trial) { return sink_ ? *open_[static_cast<std::size_t>(trial)] : record_; }
  std::size_t row(int trial, int t) const;
  /// First time of the block that t is in.
  int first_of(int t) const { return t - t % block_; }
  void start_block(int trial, int t);
  /// Adds what known inputs add to every estimate.
  void move(double* estimates, const double* shift) const;
  /// Where estimates of that time go.
  double* estimate(int trial, int t);
  /// True: truth and errors are so small that the estimates are, too.
  bool errors(Record& record, std::size_t row, const double* estimate, const double* truth) const;
  void disown(const Frame& frame) const;
  void accusations(int trial, int t, const Runner& runner);
  void proofs(int trial, int t, const Runner& runner);
  void details(int trial, int t, const Runner& runner);

  Record record_;
  std::int64_t bytes_ = 0;  // of a step, summed over what has finished
  std::int64_t finished_ = 0;
  Keep keep_;
  bool truth_known_;
  bool certified_;
  bool vouch_;   // no agent lies in its messages: only then a family's bounds are covered
  bool direct_;  // the certificate does not rest on what agents say of others
  std::size_t outputs_;
  std::vector<Counts> counts_;                           // per trial
  bool remembers_;                                       // agents prove sources to be attacked
  std::vector<std::vector<AgentSet>> last_;              // per trial: the sets at the last accusation
  std::vector<std::vector<std::vector<int>>> proved_;    // per trial and agent
  std::vector<std::vector<std::vector<double>>> lists_;  // per trial, [agent * details + detail]
  std::vector<std::vector<double>> estimates_;           // per trial, when estimates are not kept
  std::mutex mutex_;
  const std::function<void(const Record&, int, int)>& sink_;
  int block_ = 0;                               // times of a block; without a sink not used
  std::vector<std::unique_ptr<Record>> open_;   // per trial: its block while it runs
  std::vector<std::unique_ptr<Record>> spare_;  // blocks of trials that have ended
  std::mutex sink_mutex_;
};

}  // namespace garrison::detail
