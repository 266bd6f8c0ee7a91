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
#include "garrison/filters/structural/setting.hpp"

namespace garrison {

/// One exchange per sample, estimates over one graph (weights W) and measurements over another (U):
///   (3) xpred_i = sum_j W_ij A xhat_j,
///   (4) xhat_i = xpred_i + K_i sum_{j : U_ij = 1} c_j (y_j - c_j'xpred_i),
///  (14) r_i = y_i - c_i'xhat_i, an alarm when |r_i| >= m s_i (19).
/// s_i is the exact stationary standard deviation (notes, items 11 and 15) and m follows from `false_alarm`,
/// instead of the paper's (17). Large networks (N n > 1200) use the Riccati bound of s_i: fewer false alarms
/// than asked for, never more. The network says who may hear whom; W and U may use fewer of its links.
///
/// A missing estimate gives its weight to the agent's own; a missing measurement counts as predicted. The
/// test rests for `settle` samples after the start and after a missing message or measurement, here or at any
/// agent that this one hears of, because the error is not stationary then (threshold NaN, verdict "not
/// tested"; messages carry how long their sender still rests). With `isolate` an agent leaves its own
/// measurement out, and withholds it, while its alarm lasts; this can make the error unstable where the
/// sensor is indispensable.
///
/// One agent that lies in its messages moves its neighbours' estimates in proportion to its lie and its
/// weight, and can keep their tests at rest by claiming to rest itself; it accuses nobody else, as every
/// agent judges itself.
struct GARRISON_EXPORT Structural {
  static constexpr std::string_view name = "structural";
  static constexpr std::string_view title = "Single-time-scale estimator with exact residual tests";
  static constexpr std::string_view source = "Doostmohammadian et al., IEEE TNSE 2022";

  struct Params {
    std::string design = "auto";
    std::string share = "neighbours";
    double self_weight = kNaN;
    std::vector<double> weights;
    std::vector<double> sharing;
    std::vector<double> gain;
    double false_alarm = 0.01;
    std::string test = "residual";
    int window = 1;
    int alarm_after = 1;
    int clear_after = 5;
    int settle = -1;
    bool isolate = false;
    bool accuse_missing = false;

    static auto fields();
  };

  /// What agent i needs of an agent it hears (or of itself).
  struct Heard {
    int id;
    double weight;  ///< W_ij
    int first;      ///< of K_i c_j in `columns`; -1: y_j is not used

    template <class V>
    void visit(V& v) {
      v.range("id", id, 0, INT32_MAX);
      v("weight", weight);
      v.range("first", first, -1, INT32_MAX);
    }
  };
  struct Gains {
    std::vector<int> offsets;     ///< first Heard of each agent, N + 1
    std::vector<Heard> heard;     ///< per agent: itself first, then by id
    std::vector<double> columns;  ///< K_i c_j, n numbers each
    std::vector<double> rows;     ///< c_j, N x n row by row
    std::vector<double> std;      ///< of what is tested; NaN = not known, no test
    std::vector<double> innovation_std;
    std::vector<double> precision;  ///< window * window numbers per agent, when window > 1
    double level = kNaN;            ///< m, or the chi-square level
    double sample_level = kNaN;     ///< m
    double rho = kNaN;              ///< rho(Ahat)
    int window = 1;
    int alarm_after = 1;
    int clear_after = 5;
    int settle = 0;
    bool innovation = false;
    bool isolate = false;
    bool accuse_missing = false;
    std::vector<char> has_sensor;
    bool sensing(int id) const { return has_sensor[static_cast<std::size_t>(id)] != 0; }

    template <class V>
    void visit(V& v) {
      v("offsets", offsets);
      v("heard", heard);
      v("columns", columns);
      v("rows", rows);
      v("std", std);
      v("innovation_std", innovation_std);
      v("precision", precision);
      v("level", level);
      v("sample_level", sample_level);
      v("rho", rho);
      v.range("window", window, 1, 100000);
      v.range("alarm_after", alarm_after, 1, INT32_MAX);
      v.range("clear_after", clear_after, 1, INT32_MAX);
      v.range("settle", settle, 0, kMostRest);
      v("innovation", innovation);
      v("isolate", isolate);
      v("accuse_missing", accuse_missing);
      v("has_sensor", has_sensor);
    }
  };
  /// Longest rest that a message can tell of.
  static constexpr int kMostRest = 65535;

  template <int n>
  struct State {
    Vec<n> x;
    Vec<n> prior;
    double y = kNaN;
    double residual = kNaN;
    double innovation = kNaN;
    double statistic = kNaN;
    double threshold = kNaN;
    int rest = 0;   // samples before the next test
    int above = 0;  // tests in a row
    int below = 0;
    int filled = 0;  // residuals in the window
    int oldest = 0;
    bool alarm = false;
    std::vector<double> last;  // window of residuals, a ring
    AgentSet accused;

    template <class V>
    void visit(V& v) {
      const int window = std::max<int>(1, static_cast<int>(last.size()));
      v("estimate", x);
      v("prior", prior);
      v("y", y);
      v("residual", residual);
      v("innovation", innovation);
      v("statistic", statistic);
      v("threshold", threshold);
      v.range("rest", rest, 0, kMostRest);
      v.range("above", above, 0, INT32_MAX);
      v.range("below", below, 0, INT32_MAX);
      v.range("filled", filled, 0, window);
      v.range("oldest", oldest, 0, window - 1);
      v("alarm", alarm);
      v("last", last);
      v("accused", accused);
    }
  };
  template <int n>
  struct Message {
    static constexpr int size = n == Dynamic ? Dynamic : n + 1;
    bool measured = false;  ///< the last number is y; otherwise there is none
    int rest = 0;           ///< samples before the sender's next test
    Vec<size> numbers;      ///< estimate, then y

    template <class V>
    void visit(V& v) {
      const auto states = static_cast<std::size_t>(numbers.size()) - 1;
      v.numbers("estimate", std::span<double>(numbers.data(), states));
      v.numbers("measurement", std::span<double>(numbers.data() + states, 1));
      v.flag("measured", measured);
      v.count("rest", rest, kMostRest);
    }
  };

  /// @throws InvalidInput when parameters, model and network do not fit, or given gains make the error
  /// unstable; DesignInfeasible when no stabilising gain was found.
  static Gains design(const Params& params, const Model& model, const Network& network);
  static Check check(const Params& params, const Model& model, const Network& network);
  /// The setting that design and check work with.
  static structural::Setting setting(const Params& params, const Model& model, const Network& network);
  /// The gain matrices in params.gain.
  static structural::GainMatrices gains_of(const Params& params, const structural::Setting& setting);
  static int rounds(const Gains&) { return 1; }
  /// What agent `id` needs of the gains: its own row, and the sensors of those it hears.
  static Gains part(const Gains& all, int id, std::span<const int> neighbours);

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    State<n> fresh;
    fresh.x = fresh.prior = x0;
    fresh.rest = g.settle;
    if (g.window > 1) fresh.last.assign(static_cast<std::size_t>(g.window), 0.0);
    fresh.accused.resize(l.agents);
    s = std::move(fresh);
    m.measured = false;
    m.rest = g.settle;
    m.numbers.setZero(dimension<n>(l) + 1);
    m.numbers.head(dimension<n>(l)) = x0;
  }

  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t,
                    Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    s.y = l.outputs > 0 && std::abs(y[0]) < kHuge ? y[0] : kNaN;
    for (int k = 0; k < nn; ++k) m.numbers[k] = s.x[k];
    m.measured = !std::isnan(s.y) && !(g.isolate && s.alarm);
    m.numbers[nn] = m.measured ? s.y : 0.0;
    m.rest = s.rest;
  }

  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    const Heard* heard = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id)];
    const Heard* end = g.heard.data() + g.offsets[static_cast<std::size_t>(l.id) + 1];
    // (3): the mean first, then A; a missing estimate's weight goes to the own one.
    double own = heard->weight;
    bool complete = true;
    for (int k = 0; k < nn; ++k) m.numbers[k] = 0.0;
    std::size_t at = 0;
    for (const Heard* j = heard + 1; j != end; ++j) {
      const bool here = at < inbox.size() && inbox.sender(at) == j->id;
      if (!here) {
        own += j->weight;
        complete = complete && j->weight == 0.0 && (j->first < 0 || !g.sensing(j->id));
        continue;
      }
      s.rest = std::max(s.rest, inbox[at].rest);  // what is off there is off here from now on
      const auto& letter = inbox[at++].numbers;
      for (int k = 0; k < nn; ++k) m.numbers[k] += j->weight * letter[k];
    }
    for (int k = 0; k < nn; ++k) m.numbers[k] += own * s.x[k];
    for (int i = 0; i < nn; ++i) {
      double next = 0.0;
      for (int k = 0; k < nn; ++k) next += l.A[static_cast<std::ptrdiff_t>(k) * nn + i] * m.numbers[k];
      s.prior[i] = next;
    }
    // (4): own measurement, then those of the others in order of id.
    s.x = s.prior;
    const bool used = !std::isnan(s.y) && !(g.isolate && s.alarm);
    const bool has_sensor = l.outputs > 0;
    s.innovation = std::isnan(s.y) ? kNaN : s.y - dot(g, l.id, s.prior, nn);
    if (used) add(g, *heard, s.innovation, nn, s.x);
    complete = complete && (used || !has_sensor);
    at = 0;
    for (const Heard* j = heard + 1; j != end; ++j) {
      if (at >= inbox.size() || inbox.sender(at) != j->id) continue;
      const auto& letter = inbox[at++];
      if (j->first < 0) continue;
      if (letter.measured)
        add(g, *j, letter.numbers[nn] - dot(g, j->id, s.prior, nn), nn, s.x);
      else if (g.sensing(j->id))
        complete = false;
    }
    s.residual = std::isnan(s.y) ? kNaN : s.y - dot(g, l.id, s.x, nn);
    judge(l, g, s, complete, used);
    for (int k = 0; k < nn; ++k) m.numbers[k] = s.x[k];
  }

  /// A times the entrywise median of what the neighbours estimated a sample ago.
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t,
                     State<n>& s) noexcept {
    const int nn = dimension<n>(l);
    if (inbox.size() > 0) {
      median_into<n>(inbox.size(), [&](std::size_t k) { return inbox[k].numbers.data(); }, s.prior);
      for (int i = 0; i < nn; ++i) {
        s.x[i] = 0.0;
        for (int k = 0; k < nn; ++k) s.x[i] += l.A[static_cast<std::ptrdiff_t>(k) * nn + i] * s.prior[k];
      }
    }
    if (!usable<n>(s.x)) s.x.setZero();
    s.prior = s.x;
    uncover<n>(g, s);
  }
  template <int n>
  static void uncover(const Gains& g, State<n>& s) noexcept {
    s.rest = std::max(s.rest, g.settle);
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
    else if (std::isnan(s.threshold) && !missing)
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
    const Heard& own = g.heard[static_cast<std::size_t>(g.offsets[static_cast<std::size_t>(l.id)])];
    double left = 1.0;  // r = (1 - c'Kc) innovation
    for (int k = 0; k < nn; ++k) left -= l.C[k] * g.columns[static_cast<std::size_t>(own.first + k)];
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
  template <int n>
  static double dot(const Gains& g, int id, const Vec<n>& x, int nn) noexcept {
    const double* c = g.rows.data() + static_cast<std::ptrdiff_t>(id) * nn;
    double sum = 0.0;
    for (int k = 0; k < nn; ++k) sum += c[k] * x[k];
    return sum;
  }
  template <int n>
  static void add(const Gains& g, const Heard& j, double innovation, int nn, Vec<n>& x) noexcept {
    const double* column = g.columns.data() + j.first;
    for (int k = 0; k < nn; ++k) x[k] += column[k] * innovation;
  }

  /// The test and its memory. While the own measurement is left out, its innovation is what is tested.
  template <int n>
  static void judge(const Local& l, const Gains& g, State<n>& s, bool complete, bool used) noexcept {
    const auto id = static_cast<std::size_t>(l.id);
    const bool missing = std::isnan(s.y);
    s.statistic = s.threshold = kNaN;
    const bool isolated = g.isolate && s.alarm;
    const double tested = g.innovation || isolated ? s.innovation : s.residual;
    if (!complete && !isolated) s.rest = std::max(s.rest, g.settle + 1);
    if (g.window > 1) remember(g, s, missing || !used ? kNaN : tested);
    if (!missing) s.statistic = g.window > 1 && !isolated ? window_statistic(g, s, id) : std::abs(tested);
    bool over = g.accuse_missing && missing && l.outputs > 0;
    bool judged = over;
    if (s.rest > 0) {
      --s.rest;
    } else if (!missing) {
      const double level = isolated       ? g.sample_level * g.innovation_std[id]
                           : g.window > 1 ? g.level
                                          : g.level * g.std[id];
      if (!std::isnan(level) && !std::isnan(s.statistic)) {
        s.threshold = level;
        over = !(s.statistic < level);
        judged = true;
      }
    }
    if (!judged) return;
    s.above = over ? s.above + 1 : 0;
    s.below = over ? 0 : s.below + 1;
    if (s.above >= g.alarm_after) s.alarm = true;
    if (s.below >= g.clear_after) s.alarm = false;
    s.accused.clear();
    if (s.alarm) s.accused.insert(l.id);
  }

  template <int n>
  static void remember(const Gains& g, State<n>& s, double residual) noexcept {
    if (std::isnan(residual)) {
      s.filled = s.oldest = 0;
      return;
    }
    s.last[static_cast<std::size_t>((s.oldest + s.filled) % g.window)] = residual;
    if (s.filled < g.window)
      ++s.filled;
    else
      s.oldest = (s.oldest + 1) % g.window;
  }

  /// v'S^-1 v over the window, NaN until it is full.
  template <int n>
  static double window_statistic(const Gains& g, const State<n>& s, std::size_t id) noexcept {
    const auto w = static_cast<std::size_t>(g.window);
    if (s.filled < g.window || g.precision.empty()) return kNaN;
    const double* S = g.precision.data() + id * w * w;
    double sum = 0.0;
    for (std::size_t a = 0; a < w; ++a) {
      double row = 0.0;
      for (std::size_t b = 0; b < w; ++b)
        row += S[a * w + b] * s.last[(static_cast<std::size_t>(s.oldest) + b) % w];
      sum += row * s.last[(static_cast<std::size_t>(s.oldest) + a) % w];
    }
    return sum;
  }
};

}  // namespace garrison

#include "garrison/filters/structural/params.hpp"
