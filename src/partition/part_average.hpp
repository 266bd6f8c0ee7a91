// SPDX-License-Identifier: Apache-2.0
// Families whose rounds only average, on one rank: all own agents in one go, as engine/batch/averaging.hpp
// does for a whole network, with the interior averaged while ghosts travel. Where these are known several
// hops away, their rounds are worked out here too, and one exchange is enough for as many rounds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "garrison/core/filter.hpp"
#include "garrison/engine/batch/averaging.hpp"
#include "garrison/engine/plan/consensus_kernel.hpp"
#include "garrison/kernel/aligned.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"
#include "partition/region.hpp"

namespace garrison::partition {

/// The estimates of own agents and ghosts in one array, by place. They stay there from sample to sample.
/// Threads: one at a time.
class PartAverage {
 public:
  /// Allocates with the first `gather`: most families never average. `region` and `exchange` must outlive it.
  PartAverage(const Region& region, Exchange& exchange, int width)
      : region_(region), exchange_(exchange), width_(width) {}

  /// The states move on without us, or have started anew.
  void forget() { gathered_ = stale_ = false; }
  template <class State>
  void gather(std::span<State> states) {
    if (now_.empty()) prepare();
    if (gathered_) return;
    for (std::size_t k = 0; k < states.size(); ++k) std::copy_n(states[k].x.data(), width_, row(now_, k));
    gathered_ = true;
  }
  /// Brings the states up to date.
  template <class State>
  void settle(std::span<State> states) {
    if (!stale_) return;
    for (std::size_t k = 0; k < states.size(); ++k) std::copy_n(row(now_, k), width_, states[k].x.data());
    stale_ = false;
  }
  /// Every own agent senses; `local(k)`, `y(k)`: of the agent at place k.
  template <class F, int n, class Locals, class Measurements>
  void sense(const typename F::Gains& gains, const double* A, std::int64_t t,
             std::span<typename F::template State<n>> states, const Locals& local, const Measurements& y) {
    run_widest_of<Sense<F, n, Locals, Measurements>, n>(this, &gains, A, t, states, &local, &y);
    stale_ = true;
  }
  /// Own agents whose estimate is of no use.
  std::int64_t lost() const { return lost_; }

  /// All rounds of a sample. `omega`: Chebyshev weight per round, empty = plain.
  void run(double alpha, std::span<const double> omega, int rounds);

 private:
  template <class F, int n, class Locals, class Measurements>
  struct Sense {
    template <int B>
    GARRISON_INLINE static void run(PartAverage* all, const typename F::Gains* gains, const double* A,
                                    std::int64_t t, std::span<typename F::template State<n>> states,
                                    const Locals* local, const Measurements* y) {
      double* const prediction = all->next_.data();  // of nobody before the rounds
      all->lost_ = 0;
      for (std::size_t k = 0; k < states.size(); ++k) {
        double* const x = all->row(all->now_, k);
        multiply<n, B>(A, x, prediction, all->width_);
        const int place = static_cast<int>(k);
        F::template update<n, B>((*local)(place), *gains, states[k], (*y)(place), t, prediction, x);
        bool usable = true;
        for (int c = 0; c < all->width_; ++c) usable &= std::abs(x[c]) < kHuge;
        all->lost_ += usable ? 0 : 1;
      }
    }
  };
  void prepare();
  /// Sends the rows of own agents that others hear; those of one round ago too where `both`.
  void send(bool both);
  /// Ends `send`.
  void receive(bool both);
  double* row(Aligned<double>& of, std::size_t place) {
    return of.data() + place * static_cast<std::size_t>(width_);
  }

  const Region& region_;
  Exchange& exchange_;
  int width_;
  Aligned<double> now_;
  Aligned<double> next_;
  Aligned<double> out_;
  Aligned<double> in_;  // where ghosts are more than one hop away, else they are received in place
  std::vector<std::int32_t> neighbour_;  // width times the places that are heard
  std::vector<kernel::Run> runs_;        // of interior agents, of the other own ones, of ghosts by ring
  std::size_t interior_ = 0;             // how many are of interior agents
  std::vector<std::size_t> within_;      // how many are of places within 0, 1, .. hops of own agents
  std::int64_t lost_ = 0;
  bool gathered_ = false;  // `now_` is up to date
  bool stale_ = false;     // the states are not
};

}  // namespace garrison::partition
