// SPDX-License-Identifier: Apache-2.0
// Saturated consensus filter and its detector (He, Ren, Sandberg, Johansson, IEEE TAC 2022).
//
// Steps, for every agent i and time t (numbers are the paper's equations):
//   predict   A xhat_i(t-1)
//   innovate  h = y_i(t) - C_i A xhat_i(t-1), one per row of C_i
//   test      |h| > phi_i(t) proves an attack (15); a proved sensor never updates again      [Algorithm 2]
//             with `table`: the lower one of phi_i(t) and H_i(t) of theorem T (docs/certificates.md)
//   saturate  xtilde_i = prediction + sum over rows of C_i' clip(h, -beta, beta)             (3), (4)
//   average   L rounds of xhat_i <- xhat_i - alpha sum_j (xhat_i - xhat_j)                   (5)
//   flood     the same rounds unite the sets of proved sensors
// Letters: beta saturation level, L rounds, alpha step, s most sensors attacked, I_i set of proved sensors,
// d_i its size, rhobar_i the bound on the mean error (14), p(t) the bound on the disagreement (10).
//
// More than s sensors proved: an assumption is false, and a proof rests on all of them. An agent that holds
// such a set names nobody, reports no bound, and goes on with the saturation alone (3)-(5).
//
// Where we leave the print: the test has a rounding guard; "= s" in line 6 reads ">= s"; a bound is reported
// only by an agent that still tests, because (16) is false for the others; an agent that missed a message, or
// heard from one that did, reports no bound, tests nothing, and its set is not united with others (with
// `recovery` it goes on, by theorem L of docs/certificates.md). The same
// holds for all once more than s sensors lack a measurement in one sample. (Only who sees all measurements
// can count them: an agent on its own takes it for granted, and `uncover` tells it.) Bounds and proofs cover
// attacked sensors, not agents that lie in their messages: one liar that forges `proved` has anybody
// isolated, one that clears `intact` switches all tests off; drivers say so when such an attack is simulated,
// and drop the bounds.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "garrison/core/conditions.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/trials.hpp"
#include "garrison/filters/consensus_params.hpp"
#include "garrison/filters/saturation/bounds.hpp"
#include "garrison/filters/saturation/parts.hpp"
#include "garrison/kernel/average.hpp"
#include "garrison/kernel/block.hpp"

namespace garrison {

struct GARRISON_EXPORT Saturation {
  static constexpr std::string_view name = "saturation";
  static constexpr std::string_view title = "Saturated consensus filter, with attack detector";
  static constexpr std::string_view source =
      "He, Ren, Sandberg, Johansson, IEEE TAC 2022, Algorithms 1 and 2";

  struct Params : ConsensusParams {
    double threshold = kNaN;
    int attacked = 0;
    double initial_error = kNaN;
    bool detector = false;
    std::string detector_index = "t";
    bool adaptive = false;
    bool accuse_missing = false;
    bool table = false;
    bool recovery = false;
    double failure = 0.0;
    int horizon = 0;

    static auto fields();
  };

  using Gains = saturation::Gains;
  using Memory = saturation::Memory;
  template <int n>
  using State = saturation::State<n>;
  template <int n>
  using Message = saturation::Message<n>;

  /// Step and weights of the rounds, for drivers that average the whole network at once.
  struct Averaging {
    double alpha;
    std::span<const double> omega;
  };

  /// What agent `id` needs of the gains.
  static Gains part(const Gains& gains, int id, std::span<const int> neighbours);
  /// Conditions and bounds of theorems 1-5 and propositions 2-4, with what is missing named.
  static Check check(const Params& params, const Model& model, const Network& network);
  /// Validates and prepares; @throws InvalidInput (see the doc of each parameter).
  static Gains design(const Params& params, const Model& model, const Network& network);
  /// Bounds and detector need one initial estimate for all (docs/filters/saturation.md#s1); @throws
  /// InvalidInput.
  static void check_start(const Gains& gains, const Matrix& x0);
  /// What a user should know of a run: it refuted an assumption, or too many measurements were missing.
  static std::vector<std::string> warnings(const Params& params, const Model& model, const VerdictLog& log);
  /// Eight trials at once; null when the detector makes trials take different branches.
  static std::unique_ptr<TrialsRunner> trials(std::shared_ptr<const Gains> gains, const Model& model,
                                              const Network& network);
  /// Of a design file: the gains have what this agent reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int>) noexcept {
    return (g.omega.empty() || g.omega.size() == static_cast<std::size_t>(g.rounds)) &&
           g.table.fits(l.id, l.agents, g.rounds);
  }
  /// Of a snapshot: nothing of it leads out of the tables.
  template <int n>
  static bool sound(const State<n>& s) noexcept {
    return s.loss == nullptr || s.loss->sound(s.t);
  }
  static int rounds(const Gains& g) { return g.rounds; }
  /// A missing measurement is an update that fails to come, as that of an attacked sensor may.
  static int most_missing(const Gains& g) { return g.setting.attacked; }
  /// Why a plant that changes in time cannot be taken; empty: it can.
  static std::string needs_constant(const Gains& g) {
    const bool rests = g.detector || g.adaptive || !g.table.empty();
    return rests ? "detector, adaptive and table rest on theorems for constant plants" : "";
  }
  static Averaging averaging(const Gains& g) { return {g.alpha, g.omega}; }

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    State<n> fresh;
    fresh.x = m.x = x0;
    const auto nn = static_cast<std::size_t>(x0.size());
    if constexpr (n == Dynamic) fresh.prediction = std::make_unique<double[]>(nn);
    if (!g.omega.empty()) fresh.previous = std::make_unique<double[]>(nn);
    if (!g.table.losses.empty()) {
      fresh.loss = std::make_unique<saturation::LossRecord>();
      fresh.loss->clip = g.beta;
      fresh.loss->old.resize(nn);
      m.loss.keep();
    }
    fresh.rho = g.bounded ? g.setting.eta0 : kNaN;
    fresh.p = 0.0;
    if (bounds_errors(g)) fresh.size = largest(x0.data(), static_cast<int>(x0.size()));
    m.intact = true;
    const int tracked = g.detector ? l.agents : 0;
    fresh.proved.resize(tracked);
    m.proved.resize(tracked);
    s = std::move(fresh);
  }

  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t t,
                    Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    double on_stack[kOnStack<n>];
    double* const prediction = n == Dynamic ? s.prediction.get() : on_stack;
    multiply<n>(l.A, s.x.data(), prediction, nn);
    update<n>(l, g, s, y, t, prediction, s.x.data());
    send(s, m);
  }

  /// `sense` from A xhat_i(t-1) on and without its message, for drivers that average the whole network at
  /// once: they keep the estimates themselves, and may be compiled for wider registers (kernel/isa.hpp).
  template <int n, int most = 2>
  GARRISON_INLINE static void update(const Local& l, const Gains& g, State<n>& s, const double* y,
                                     std::int64_t t, const double* prediction, double* estimate) noexcept {
    const bool recovering = s.loss != nullptr && !s.intact;
    if (recovering) s.loss->bound = recovered_bound(l, g, s);
    advance_bounds(g, s);
    s.t = t;
    if (covered(g, s)) s.level = std::fmin(s.level, g.table.level(l.id, t));
    const bool tests = recovering
                           ? take_levels(l, g, s)
                           : g.detector && s.intact && !s.refuted && (g.bounded || s.level < kInfinity);
    const int nn = dimension<n>(l);
    copy<n, most>(prediction, estimate, nn);
    const bool proved = g.detector && !s.refuted && s.proved.contains(l.id);
    const bool informed = knows_all(g, s);
    const double beta = beta_now(g, s);
    int used = 0;
    int limited = 0;
    bool accused = false;
    s.innovation = kNaN;
    for (int r = 0; r < l.outputs; ++r) {
      const double* c = l.C + static_cast<std::ptrdiff_t>(r) * nn;
      double expected_y = 0.0;
      for (int k = 0; k < nn; ++k) expected_y += c[k] * prediction[k];
      const double h = y[r] - expected_y;
      if (std::isnan(s.innovation) || std::abs(h) > std::abs(s.innovation)) s.innovation = h;
      double injected = 0.0;
      if (proved) {
        // (a) isolated
      } else if (std::isnan(h) || (!(std::abs(h) < kHuge) && (informed || beta == kInfinity))) {
        // missing; or so large that using it in full would destroy the estimate
        accused = accused || (g.detector && g.accuse_missing && !informed && !s.refuted);
      } else if (informed) {
        injected = h;  // (b) all attackers are known, no test
        ++used;
      } else if (tests &&
                 saturation::exceeds(std::abs(h), s.level, std::abs(y[r]) + std::abs(expected_y) + s.size)) {
        accused = true;  // (c) proof (15)
      } else {
        injected = std::max(-beta, std::min(h, beta));  // (d) = k h with k of (4), without 0/0
        limited += std::abs(h) > beta ? 1 : 0;
        ++used;
      }
      add_scaled<n, most>(injected, c, estimate, nn);
    }
    if (accused) {
      // Nothing of an accused sensor is used, even if some of its outputs look harmless.
      copy<n, most>(prediction, estimate, nn);
      s.proved.insert(l.id);
      look_for_refutation(g, s);
    }
    if (t % kLooks == 0 && bounds_errors(g)) s.size = std::max(kFading * s.size, largest(estimate, nn));
    s.verdict = proved || accused                                         ? Verdict::attacked
                : used == 0                                               ? Verdict::silent
                : limited > 0                                             ? Verdict::suspected
                : informed                                                ? Verdict::cleared
                : ((g.detector ? tests && !s.refuted : beta < kInfinity)) ? Verdict::cleared
                                                                          : Verdict::not_tested;
    if (recovering) relay_update(l, g, s, estimate, prediction);
  }

  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int round,
                   Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    const double omega = g.omega.empty() ? 1.0 : g.omega[static_cast<std::size_t>(round)];
    const bool recovering = s.loss != nullptr && (!s.intact || gap(inbox));
    if (recovering) std::copy_n(s.x.data(), nn, s.loss->old.data());
    average_round<n>(nn, g.alpha, omega, s.x.data(), s.previous.get(), inbox.size(),
                     [&](std::size_t k) { return inbox[k].x.data(); });
    if (recovering) relay(l, g, s, inbox, round, omega);
    // Estimates and sets travel in one message: the proof of "no false accusation" rests on it. A set of an
    // agent that a gap lies behind proves nothing, unless it has gone on with levels that hold all the same.
    if (!inbox.complete() || recovering) s.intact = false;
    for (std::size_t k = 0; k < inbox.size(); ++k) {
      s.intact = s.intact && inbox[k].intact;
      if (g.detector && (inbox[k].intact || s.loss != nullptr)) s.proved.unite(inbox[k].proved);
    }
    look_for_refutation(g, s);
    send(s, m);
  }

  /// Entrywise median of what the neighbours sent: less than half of them lie, so no liar moves it beyond the
  /// honest ones.
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t t,
                     State<n>& s) noexcept {
    if (s.previous != nullptr)
      std::fill_n(s.previous.get(), dimension<n>(l), 0.0);  // it may be what overflowed
    median_into<n>(inbox.size(), [&](std::size_t k) { return inbox[k].x.data(); }, s.x);
    uncover<n>(g, s);
    if (s.loss != nullptr && s.t == t) relay_median(l, g, s, inbox);
  }
  template <int n>
  static void uncover(const Gains&, State<n>& s) noexcept {
    s.intact = false;
    if (s.loss != nullptr) s.loss->forget(s.t);
  }

  /// (3): C_i xtilde_i = y_i where C_i C_i' = I and nothing was clipped.
  template <int n>
  static const double* sensed(const Message<n>& m) noexcept {
    return m.x.data();
  }

  /// The rounds would change nothing but the average if both agents carry the same side information.
  template <int n>
  static bool same_side_information(const State<n>& a, const State<n>& b) noexcept {
    return a.intact == b.intact && a.proved == b.proved &&
           (a.loss == nullptr || a.intact || a.loss->state == b.loss->state);
  }
  /// Whether `intact` is all of the side information.
  template <int n>
  static bool bare(const State<n>& s) noexcept {
    return s.proved.size() == 0 && (s.loss == nullptr || s.intact);
  }

  /// Where a driver that averages at once reads and writes the estimate.
  template <int n>
  static double* averaged(State<n>& s) noexcept {
    return s.x.data();
  }

  template <int n>
  static Report report(const Local& l, const Gains& g, const State<n>& s) noexcept {
    Report r;
    r.verdict = l.outputs == 0 ? Verdict::silent : s.verdict;
    r.statistic = std::abs(s.innovation);
    r.threshold = g.detector ? s.level : beta_now(g, s);
    if (g.bounded && s.intact && !(g.detector && s.proved.size() >= g.setting.attacked))
      r.bound = rho_now(g, s) + p_now(g, s);
    if (recovers(s)) saturation::offer(recovered_bound(l, g, s), CertificateKind::recovered, r);
    if (covered(g, s)) offer_table(l, g, s, r);
    r.bound += saturation::kRounding * (s.size + r.bound);
    return r;
  }
  template <int n>
  static const Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  template <int n>
  static const AgentSet* accused(const State<n>& s) noexcept {
    return s.refuted ? &saturation::kNobody : &s.proved;
  }
  template <int n>
  static void expected(const Local& l, const Gains&, const State<n>& s, double* out) noexcept {
    next_measurement<n>(l, s.x.data(), out);
  }
  template <int n>
  static double alarm_level(const Local& l, const Gains& g, const State<n>& s) noexcept {
    if (s.loss != nullptr && !s.intact) return recovered_alarm_level(l, g, s);
    if (!g.detector && !g.adaptive) return g.beta;
    const double level = saturation::innovation_bound(g.setting, rho_now(g, s), p_now(g, s));
    const double least = covered(g, s) ? std::fmin(level, g.table.level(l.id, s.t + 1)) : level;
    return g.bounded || least < kInfinity ? least : g.beta;
  }

  static constexpr std::size_t signal_count = 7;
  static std::vector<std::string> signal_names() {
    return {"gain", "innovation", "level", "phi", "rho", "p", "detected"};
  }
  /// Values of signal_names() after a step: k_i, h_i, beta, phi_i, rho or rhobar_i at t, p(t), d_i(t).
  template <int n>
  static void signals(const Local&, const Gains& g, const State<n>& s, double* out) noexcept {
    const double all[] = {gain_now(g, s),
                          s.innovation,
                          beta_now(g, s),
                          g.detector ? s.level : kNaN,
                          rho_now(g, s),
                          p_now(g, s),
                          static_cast<double>(s.proved.size())};
    std::copy(std::begin(all), std::end(all), out);
  }

  /// Writes the message that this agent sends before its next round.
  template <int n>
  static void send(const State<n>& s, Message<n>& m) noexcept {
    m.x = s.x;
    m.intact = s.intact;
    m.proved = s.proved;
    if (s.loss != nullptr) say(s, m);
  }

 private:
  /// Samples from one look at the size of an estimate to the next: saturation::kRounding allows for its
  /// growth.
  static constexpr int kLooks = 8;
  /// Per look: errors that rounding made fade no slower, or the bounds are far above them.
  static constexpr double kFading = 0.992;

  static double largest(const double* x, int n) noexcept {
    double found = 0.0;
    for (int k = 0; k < n; ++k) found = std::max(found, std::abs(x[k]));
    return found;
  }
  /// ||a - b||.
  static double distance(const double* a, const double* b, int nn) noexcept {
    double sum = 0.0;
    for (int k = 0; k < nn; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(sum);
  }
  // recovering.hpp: of an agent that a message was lost behind, with `recovery`. What is rare must not slow
  // down what is not.
  /// The relayed bound after `sense`.
  template <int n>
  GARRISON_COLD static void relay_update(const Local& l, const Gains& g, State<n>& s, const double* estimate,
                                         const double* prediction) noexcept;
  template <int n>
  GARRISON_COLD static void say(const State<n>& s, Message<n>& m) noexcept;
  /// Whether a message of this sample is missing, here or behind what another agent sent.
  template <int n>
  GARRISON_COLD static bool gap(const Inbox<Message<n>>& inbox) noexcept;
  /// After a round in which something was missing, here or behind what was heard: relays bounds and merges
  /// what is known of earlier losses. s.loss->old: the estimate before the round.
  template <int n>
  GARRISON_COLD static void relay(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                                  int round, double omega) noexcept;
  /// After a rejoin: what those who were heard know of the own estimate.
  template <int n>
  GARRISON_COLD static void relay_median(const Local& l, const Gains& g, State<n>& s,
                                         const Inbox<Message<n>>& inbox) noexcept;
};

}  // namespace garrison

#include "garrison/filters/saturation/params.hpp"
#include "garrison/filters/saturation/recovering.hpp"
