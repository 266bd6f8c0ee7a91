// SPDX-License-Identifier: Apache-2.0
// The single-time-scale estimator (3)-(4) with its residual test (14), (19).
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "garrison/core/conditions.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/params.hpp"
#include "garrison/filters/structural/fits.hpp"
#include "garrison/filters/structural/parts.hpp"
#include "garrison/filters/structural/setting.hpp"
#include "garrison/filters/structural/spread.hpp"
#include "garrison/kernel/block.hpp"

namespace garrison {

/// One exchange per sample, estimates over one graph (weights W) and measurements over another (U):
///   (3) xpred_i = sum_j W_ij A xhat_j,
///   (4) xhat_i = xpred_i + K_i sum_{j : U_ij = 1} c_j (y_j - c_j'xpred_i),
///  (14) r_i = y_i - c_i'xhat_i, an alarm when |r_i| >= m s_i (19).
/// s_i is the exact stationary standard deviation (docs/filters/structural.md#d11, d15) and m follows
/// from `false_alarm`, instead of the paper's (17). Large networks (N n > 1200) use the Riccati bound of s_i:
/// fewer false alarms than asked for, never more. The network says who may hear whom; W and U may use fewer
/// of its links.
///
/// A missing estimate gives its weight to the agent's own; a missing measurement counts as predicted. From
/// then on, until it is stationary again, an agent carries a bound P_i >= cov(e_i) of its own error (Jensen)
/// and tests against m times the deviation that follows from it: fewer false alarms than asked, never more
/// (docs/adr/0008). Messages tell P_i and how long their sender is off. Nothing is tested for `settle`
/// samples after the start (threshold NaN, verdict "not tested"). Where the bounded deviation is above 10
/// times the stationary one, a measurement beyond even that is an alarm, and one within says nothing: the
/// verdict stays "not tested" and no alarm ends. Where a gap has cut a window short the last sample alone is
/// tested, which can accuse and end an alarm, but not clear: the verdict is "not tested" there, too. An alarm
/// ends also after 20 measurements in a row that cannot be tested.
///
/// With `isolate` innovations are tested before they are used: an agent leaves out every measurement, its own
/// or one it hears, that is over its level, and withholds its own while its alarm lasts. P_i grows meanwhile,
/// so that a sensor which is right again is let in again, and one that is necessary is never left out for
/// ever.
///
/// One agent that lies in its messages moves its neighbours' estimates in proportion to its lie and its
/// weight, can blind their tests by claiming a large bound, and can have them accuse their own honest
/// sensors.
struct GARRISON_EXPORT Structural {
  static constexpr std::string_view name = "structural";
  static constexpr std::string_view title = "Single-time-scale estimator with exact residual tests";
  static constexpr std::string_view source = "Doostmohammadian et al., IEEE TNSE 2021";

  struct Params {
    std::string design = "auto";
    std::string share = "neighbours";
    double self_weight = kNaN;
    std::vector<double> weights;
    std::vector<double> sharing;
    std::vector<double> gain;
    double false_alarm = 0.01;
    std::string test = "auto";
    int window = 1;
    int alarm_after = 1;
    int clear_after = 5;
    int settle = -1;
    bool isolate = false;
    bool accuse_missing = false;

    static auto fields();
  };

  using Heard = structural::Heard;
  using Gains = structural::Gains;
  using Memory = structural::Memory;
  template <int n>
  using State = structural::State<n>;
  template <int n>
  using Message = structural::Message<n>;

  /// @throws InvalidInput when parameters, model and network do not fit, or given gains make the error
  /// unstable; DesignInfeasible when no stabilising gain was found.
  static Gains design(const Params& params, const Model& model, const Network& network);
  static Check check(const Params& params, const Model& model, const Network& network);
  /// The setting that design and check work with.
  static structural::Setting setting(const Params& params, const Model& model, const Network& network);
  /// The gain matrices in params.gain.
  static structural::GainMatrices gains_of(const Params& params, const structural::Setting& setting);
  /// Sensors that were hardly tested, or accused more often than can be right.
  static std::vector<std::string> warnings(const Params& params, const Model& model, const VerdictLog& log);
  static int rounds(const Gains&) { return 1; }
  /// Of a design file: the gains have what this agent reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
    return structural::fits(g, l, neighbours);
  }
  /// What agent `id` needs of the gains: its own row, and the sensors of those it hears.
  static Gains part(const Gains& all, int id, std::span<const int> neighbours);

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    const int nn = dimension<n>(l);
    State<n> fresh;
    fresh.x = fresh.prior = x0;
    if (g.window > 1) fresh.last.assign(static_cast<std::size_t>(g.window), 0.0);
    const auto id = static_cast<std::size_t>(l.id);
    fresh.left_out.assign(static_cast<std::size_t>(g.offsets[id + 1] - g.offsets[id]), 0);
    if (carries(g)) {
      fresh.P.assign(structural::entries(nn), 0.0);
      fresh.work.assign(4 * structural::entries(nn), 0.0);
      fresh.fixed = fixed(l, g);
    }
    fresh.pace = g.rho > 0.0 && g.rho < 1.0 ? -1.0 / std::log(g.rho) : 0.0;
    fresh.senders.assign(fresh.left_out.size(), 0);
    fresh.missing.assign(fresh.left_out.size(), 0);
    fresh.accused.resize(l.agents);
    s = std::move(fresh);
    s.start = s.rest = g.settle;
    if (g.settle == 0)
      settle(l, g, s);
    else
      begin(g, s, kStartVariance);
    m.measured = m.withheld = false;
    m.rest = g.settle;
    m.numbers.setZero(nn + 1);
    m.numbers.head(nn) = x0;
    m.covariance.assign(carries(g) ? structural::packed(nn) : 0, 0.0);
    m.settled = false;
  }

  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t,
                    Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    s.y = l.outputs > 0 && std::abs(y[0]) < kHuge ? y[0] : kNaN;
    for (int k = 0; k < nn; ++k) m.numbers[k] = s.x[k];
    m.withheld = !std::isnan(s.y) && g.isolate && s.alarm;
    m.measured = !std::isnan(s.y) && !m.withheld;
    m.numbers[nn] = m.measured ? s.y : 0.0;
    m.rest = s.rest;
    if (!carries(g)) return;
    const bool settled = s.rest == 0 && !g.isolate;  // then P is the stationary covariance
    if (!settled || !m.settled) structural::pack<n>(s.P.data(), nn, m.covariance.data());
    m.settled = settled;
  }

  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    const auto id = static_cast<std::size_t>(l.id);
    const bool measured = !std::isnan(s.y);
    receive(l, g, s, inbox);
    const Seen seen = predict(l, g, s, inbox, m);
    const bool settled = s.rest == 0 && s.start == 0 && seen.estimates;
    const bool carried = carries(g) && (g.isolate || !(settled && seen.measurements));
    if (carried) {
      mix_spreads(l, g, s, inbox);
      run_spread<PredictSpread, n>(l, g, s);
    }
    const double* c = row(g, l.id, nn);
    s.innovation = measured ? s.y - dot(g, l.id, s.prior, nn) : kNaN;
    bool over = false;
    if (g.innovation) {
      const double bounded =
          carried ? std::sqrt(structural::quadratic<n>(s.work.data(), c, nn) + g.noise[id]) : kNaN;
      over = examine(g, s, id, s.innovation, settled ? g.innovation_std[id] : bounded, settled);
    }
    const bool used = measured && !(g.isolate && (s.alarm || over));
    const bool whole = update(l, g, s, inbox, used, carried) && seen.estimates && seen.measurements;
    s.residual = measured ? s.y - dot(g, l.id, s.x, nn) : kNaN;
    if (!g.innovation) {
      const bool exact = settled && whole;
      const double own = used ? 1.0 - 2.0 * reaction(g, l.id, nn) : 1.0;
      const double bounded =
          carried ? std::sqrt(structural::quadratic<n>(s.P.data(), c, nn) + own * g.noise[id]) : kNaN;
      over = examine(g, s, id, s.residual, exact ? g.std[id] : bounded, exact);
    }
    judge(l, g, s, over);
    pass(l, g, s, whole);
    for (int k = 0; k < nn; ++k) m.numbers[k] = s.x[k];
  }

  /// A times the entrywise median of what the neighbours estimated a sample ago.
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t,
                     State<n>& s) noexcept {
    if (inbox.size() > 0) {
      median_into<n>(inbox.size(), [&](std::size_t k) { return inbox[k].numbers.data(); }, s.prior);
      multiply<n>(l.A, s.prior.data(), s.x.data(), dimension<n>(l));
    }
    if (!usable<n>(s.x)) s.x.setZero();
    s.prior = s.x;
    begin(g, s, kStartVariance);
    uncover<n>(g, s);
  }
  template <int n>
  static void uncover(const Gains& g, State<n>& s) noexcept {
    s.start = std::max({s.start, g.settle, g.recover});
    s.rest = std::max(s.rest, s.start);
    s.filled = s.oldest = s.above = 0;
  }

  template <int n>
  static Report report(const Local& l, const Gains& g, const State<n>& s) noexcept {
    Report r;
    r.statistic = s.statistic;
    r.threshold = s.threshold;
    const bool missing = std::isnan(s.y);
    if (s.alarm)
      r.verdict = Verdict::attacked;
    else if (l.outputs == 0 || (missing && !g.accuse_missing))
      r.verdict = Verdict::silent;
    else if ((std::isnan(s.threshold) || ((s.coarse || s.broken) && s.above == 0)) && !missing)
      r.verdict = Verdict::not_tested;
    else
      r.verdict = s.above > 0 ? Verdict::suspected : Verdict::cleared;
    return r;
  }
  template <int n>
  static const Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  template <int n>
  static const AgentSet* accused(const State<n>& s) noexcept {
    return &s.accused;
  }
  template <int n>
  static void expected(const Local& l, const Gains&, const State<n>& s, double* out) noexcept {
    next_measurement<n>(l, s.x.data(), out);
  }
  /// The innovation that a single-sample test lets pass when all else is as predicted.
  template <int n>
  static double alarm_level(const Local& l, const Gains& g, const State<n>&) noexcept {
    const int nn = dimension<n>(l);
    if (g.window > 1 || l.outputs == 0 || std::isnan(g.level)) return kInfinity;
    const double threshold = g.level * g.std[static_cast<std::size_t>(l.id)];
    if (std::isnan(threshold)) return kInfinity;
    if (g.innovation) return threshold;
    const double left = 1.0 - reaction(g, l.id, nn);  // r = (1 - c'Kc) innovation
    return left != 0.0 ? threshold / std::abs(left) : kInfinity;
  }
  static constexpr std::size_t signal_count = 3;
  static std::vector<std::string> signal_names() { return {"residual", "innovation", "alarm"}; }
  template <int n>
  static void signals(const Local&, const Gains&, const State<n>& s, double* out) noexcept {
    out[0] = s.residual;
    out[1] = s.innovation;
    out[2] = s.alarm ? 1.0 : 0.0;
  }

 private:
  /// Deviations, in stationary ones, above which a test can tell an alarm and nothing else.
  static constexpr double kBlind = 10.0;
  /// Measurements in a row that no test says anything of, as where the residual vanishes because there is no
  /// noise: after so many nothing speaks for an alarm any more.
  static constexpr int kForgotten = 20;
  /// By which P grows, per sample, while all that is measured is left out: nothing speaks for the estimate.
  static constexpr double kNobody = 1.3;
  /// By which P grows, per sample, while a sensor is left out that the estimate followed after it had been
  /// accused for long: who was right is open, so a second jump is followed within a minute of samples,
  /// however far.
  static constexpr double kHaste = 3.0;
  /// Deviations, in stationary ones, from which an estimate is lost: where nobody else tells, it is then
  /// worth no more than the sensor that is left out, and P grows by `haste`.
  static constexpr double kLost = 15.0;
  /// What became of a sensor: used, left out, used again after a jump that the estimate followed, left out
  /// once more, used again after that until the estimate has settled.
  enum Trust : char { trusted, out, followed, out_again, returning };
  /// The most that P is taken to be, in stationary variances.
  static constexpr double kMostVariance = 1e16;
  /// Start errors that are reckoned with, in stationary variances.
  static constexpr double kStartVariance = 1e4;
  /// What of the messages that are due has come.
  struct Seen {
    bool estimates = true;
    bool measurements = true;
  };
  template <int n>
  struct PredictSpread {
    template <int B>
    GARRISON_INLINE static void run(const Local* l, const Gains* g, Memory* s) noexcept {
      predict_spread<B, n>(*l, *g, *s);
    }
  };
  template <int n>
  struct UpdateSpread {
    template <int B>
    GARRISON_INLINE static void run(const Local* l, const Gains* g, Memory* s) noexcept {
      update_spread<B, n>(*l, *g, *s);
    }
  };
  /// One of them, in registers as wide as the machine's; dimensions whose rows do not fill registers share
  /// one piece of code.
  template <template <int> class Kernel, int n>
  static void run_spread(const Local& l, const Gains& g, Memory& s) noexcept {
    if constexpr (n == 2 || n == 4 || n == 8)
      run_widest_of<Kernel<n>, n>(&l, &g, &s);
    else
      run_widest<Kernel<Dynamic>>(&l, &g, &s);
  }
  /// What one sample says about whom to use: (4) gathers it.
  struct Doubts {
    bool carried;         ///< the bound of the error is carried
    bool out = false;     ///< a measurement was left out
    bool heeded = false;  ///< one was used
    double growth = 1.0;  ///< of the bound of the error
  };
  /// Whether y_j is due.
  static bool expects(const Gains& g, const Heard& j) noexcept { return j.first >= 0 && g.sensing(j.id); }
  static bool carries(const Gains& g) noexcept { return !g.covariance.empty(); }
  /// The stationary covariance of agent `id`; the gains of one agent hold no other's.
  static const double* stationary(const Gains& g, int id, int nn) noexcept {
    const bool alone = g.covariance.size() == structural::entries(nn);
    return g.covariance.data() + (alone ? 0 : static_cast<std::ptrdiff_t>(structural::entries(nn)) * id);
  }
  static const double* row(const Gains& g, int id, int nn) noexcept {
    return g.rows.data() + static_cast<std::ptrdiff_t>(id) * nn;
  }
  template <int n>
  static double dot(const Gains& g, int id, const Vec<n>& x, int nn) noexcept;
  /// c_i'K_i c_i
  static double reaction(const Gains& g, int id, int nn) noexcept;
  /// P of an estimate of which nothing is known: a diagonal, `factor` times the stationary variances.
  static void begin(const Gains& g, Memory& s, double factor) noexcept;
  /// The variance of state k in the stationary error. One that is zero up to rounding, as where measurements
  /// have no noise, is no measure of what a gap does: then it is a small part of what one step adds.
  static double usual_variance(const Local& l, const Gains& g, int k) noexcept {
    const std::size_t at = static_cast<std::size_t>(k) * (static_cast<std::size_t>(l.states) + 1);
    return std::max(stationary(g, l.id, l.states)[at], 1e-9 * g.process[at]);
  }
  /// The largest of them.
  static double largest_usual(const Memory& s) noexcept {
    double most = 0.0;
    for (const double usual : s.usual()) most = std::max(most, usual);
    return most;
  }
  /// P = the covariance of the stationary error.
  static void settle(const Local& l, const Gains& g, Memory& s) noexcept;
  /// I - sum K_i c_j c_j', column by column, and sum R_jj K_i c_j (K_i c_j)', over all measurements that are
  /// due; then usual_variance of each state.
  static std::vector<double> fixed(const Local& l, const Gains& g);
  /// Finds out who sent each message, and whose is missing.
  template <int n>
  static void receive(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox) noexcept;
  /// (3): the mean first, then A; a missing estimate's weight goes to the own one.
  template <int n>
  static Seen predict(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                      Message<n>& m) noexcept;
  static double own_weight(const Heard* heard, const Memory& s) noexcept;
  /// Jensen: A (sum_j W_ij P_j) A' + E >= cov(e before the update), into the first n x n of `work`.
  template <int B, int n>
  static void predict_spread(const Local& l, const Gains& g, Memory& s) noexcept;
  /// Its sum over the messages, packed, into the third n x n of `work`.
  template <int n>
  static void mix_spreads(const Local& l, const Gains& g, Memory& s, const Inbox<Message<n>>& inbox) noexcept;
  /// (4); false when a measurement was left out. Whose is not used is missing from then on. With `carried`
  /// also the bound of the error.
  template <int n>
  static bool update(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, bool used,
                     bool carried) noexcept;
  /// (4) with all that came: own measurement, then those of the others in order of id.
  template <int n>
  static void use_all(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox) noexcept;
  /// (4) with `isolate`, in the same order; true when a measurement was left out. With `carried` also what
  /// that adds to the bound before the update.
  template <int n>
  static bool use_trusted(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox,
                          bool used, bool carried) noexcept;
  /// P_i = G prior G' + sum of what the noises add, G = I - sum K_i c_j c_j', over what is not missing.
  template <int B, int n>
  static void update_spread(const Local& l, const Gains& g, Memory& s) noexcept;
  /// The measurement of Heard `e` is not used, `by_level`: because it is over its level.
  static void leave(const Local& l, const Gains& g, Memory& s, int e, bool by_level, Doubts& doubts) noexcept;
  /// The measurement of Heard `e` is used, with `isolate`.
  static void take_back(const Local& l, const Gains& g, Memory& s, int e, bool carried) noexcept;
  /// Whether a measurement that is heard is over its level, the bound of what is expected of it being
  /// `prior`.
  template <int n>
  static bool surprising(const Gains& g, const Heard& j, const double* prior, double innovation,
                         int nn) noexcept;
  /// One test of `value`, of which `std` is the deviation (`exact`) or bounds it: sets statistic and
  /// threshold, true for an alarm. The matrix of a window is that of the stationary error; while a gap is
  /// behind it, the sample alone is tested.
  static bool examine(const Gains& g, Memory& s, std::size_t id, double value, double std,
                      bool exact) noexcept;
  /// The memory of the tests: the verdict.
  static void judge(const Local& l, const Gains& g, Memory& s, bool over) noexcept;
  /// Counts how long the error is not stationary: after a gap (`whole` is false) until what it added to P has
  /// fallen below 1 % of the deviation.
  static void pass(const Local& l, const Gains& g, Memory& s, bool whole) noexcept;
  static void remember(const Gains& g, Memory& s, double residual) noexcept;
  /// v'S^-1 v over the window, NaN until it is full.
  static double window_statistic(const Gains& g, const Memory& s, std::size_t id) noexcept;
};

}  // namespace garrison

#include "garrison/filters/structural/bound.hpp"
#include "garrison/filters/structural/judge.hpp"
#include "garrison/filters/structural/params.hpp"
#include "garrison/filters/structural/step.hpp"
#include "garrison/filters/structural/trust.hpp"
