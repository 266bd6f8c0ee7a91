// SPDX-License-Identifier: Apache-2.0
// Families whose rounds only average: all agents of a network in one go (docs/adr/0001).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>

#include "garrison/core/filter.hpp"
#include "garrison/engine/plan/consensus.hpp"
#include "garrison/engine/workers.hpp"
#include "garrison/kernel/aligned.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"
#include "garrison/kernel/magnitude.hpp"

namespace garrison {

/// A family whose rounds only average estimates as long as all agents carry the same side information:
/// the engine then averages the whole network at once, with the same bits.
template <class F, int n>
concept Averages = requires(const Local& l, const typename F::Gains& g, typename F::template State<n>& s,
                            typename F::template Message<n>& m, const double* y, std::int64_t t, double* x) {
  F::template update<n>(l, g, s, y, t, x, x);
  F::averaging(g).alpha;
  { F::template averaged<n>(s) } -> std::same_as<double*>;
  { F::template same_side_information<n>(s, s) } -> std::same_as<bool>;
  F::template send<n>(s, m);
};

/// The estimates of all agents in one array. They stay there from step to step, and go to the agents' states
/// once somebody looks at these.
/// Threads: one at a time.
template <class F, int n>
class Averaging {
  using State = typename F::template State<n>;

 public:
  Averaging(std::span<State> states, int dimension)
      : states_(states), nn_(dimension), estimates_(states.size() * row()), scratch_(estimates_.size()) {}

  /// Whether all estimates are finite after sensing, and whether they were then averaged; if not, the states
  /// are up to date and have messages to send.
  struct Outcome {
    bool finite;
    bool averaged;
  };
  template <class Sample>
  Outcome step(const Sample& s) {
    const auto N = static_cast<std::int64_t>(states_.size());
    if (!gathered_)
      for (std::size_t k = 0; k < states_.size(); ++k)
        copy<n>(F::template averaged<n>(states_[k]), estimate(k), nn_);
    std::atomic<bool> finite{true};
    std::atomic<bool> alike{true};
    s.workers.split(N, [&](std::int64_t begin, std::int64_t end, int) {
      Sensed sensed{};
      run_widest_of<Sense<decltype(s.local), decltype(s.y)>, n>(this, &s.gains, &s.local, s.t, &s.y,
                                                                static_cast<std::size_t>(begin),
                                                                static_cast<std::size_t>(end), &sensed);
      if (!sensed.finite) finite = false;
      if (!sensed.alike) alike = false;
    });
    for (int part = 1; part < s.workers.threads(); ++part)
      if (!same(0, static_cast<std::size_t>(s.workers.begin(N, part)))) alike = false;
    gathered_ = finite && alike;
    stale_ = true;
    if (gathered_) {
      s.sensed([this](std::size_t k) { return estimate(k); });
      const auto [alpha, omega] = F::averaging(s.gains);
      s.plan.run(estimates_.data(), scratch_.data(), alpha, omega, F::rounds(s.gains), &s.workers);
    } else {
      settle();
    }
    return {finite, gathered_};
  }

  void send(std::size_t k, typename F::template Message<n>& m) const { F::template send<n>(states_[k], m); }

  /// Brings the states up to date.
  void settle() {
    if (!stale_) return;
    for (std::size_t k = 0; k < states_.size(); ++k)
      copy<n>(estimate(k), F::template averaged<n>(states_[k]), nn_);
    stale_ = false;
  }
  /// Before the states move on without us.
  void release() {
    settle();
    gathered_ = false;
  }

 private:
  static constexpr std::size_t kAhead = 16;  // agents, about 200 ns

  std::size_t row() const { return static_cast<std::size_t>(n == Dynamic ? nn_ : n); }
  double* estimate(std::size_t k) { return estimates_.data() + k * row(); }
  bool same(std::size_t a, std::size_t b) const {
    return F::template same_side_information<n>(states_[a], states_[b]);
  }

  struct Sensed {
    bool finite;
    bool alike;
  };
  template <class Locals, class Measurements>
  struct Sense {
    template <int B>
    GARRISON_INLINE static void run(Averaging* all, const typename F::Gains* g, const Locals* local,
                                    std::int64_t t, const Measurements* y, std::size_t begin, std::size_t end,
                                    Sensed* sensed) {
      *sensed = all->template sense<B>(*g, *local, t, *y, begin, end);
    }
  };
  template <int B, class Locals, class Measurements>
  GARRISON_INLINE Sensed sense(const typename F::Gains& g, const Locals& local, std::int64_t t,
                               const Measurements& y, std::size_t begin, std::size_t end) {
    const double* const A = local(begin).A;
    double* const predictions = scratch_.data() + begin * row();  // of a few agents: stays in cache
    bool finite = true;
    bool alike = true;
    for (std::size_t first = begin; first < end; first += kAhead) {
      const std::size_t last = std::min(first + kAhead, end);
      for (std::size_t k = first; k < last; ++k)
        multiply<n, B>(A, estimate(k), predictions + (k - first) * row(), nn_);
      for (std::size_t k = first; k < last; ++k) {
        // Measurements are in order of public ids, all over the place for the hardware's own prefetcher.
        const std::size_t ahead = std::min(k + kAhead, end - 1);
        __builtin_prefetch(y(ahead));
        __builtin_prefetch(local(ahead).C);
        const auto* const later = reinterpret_cast<const char*>(&states_[ahead]);
        for (std::size_t line = 0; line < sizeof(State); line += 64) __builtin_prefetch(later + line, 1);
        F::template update<n, B>(local(k), g, states_[k], y(k), t, predictions + (k - first) * row(),
                                 estimate(k));
        alike = alike && same(begin, k);
      }
      finite = finite && all_below(estimate(first), (last - first) * row(), kHuge);
    }
    return {finite, alike};
  }

  std::span<State> states_;
  int nn_;
  Aligned<double> estimates_;
  Aligned<double> scratch_;
  bool gathered_ = false;  // `estimates_` is up to date
  bool stale_ = false;     // the states are not
};

}  // namespace garrison
