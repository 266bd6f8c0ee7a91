// SPDX-License-Identifier: Apache-2.0
// The resilient distributed Kalman filter of Dutta, Zhang, Jin (2019).
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
#include "garrison/filters/rdkf/agent_step.hpp"
#include "garrison/filters/rdkf/fits.hpp"
#include "garrison/kernel/counting.hpp"

namespace garrison {

/// At every sample agent i sends its information vector z_i = Pbar_i^-1 A xhat_i(k-1), fuses the vectors of
/// N_i (itself included) to the prediction x0 = Q_i^-1 (1/d_i) sum z_j, and solves (8):
///   xhat_i(k) = argmin over x of penalty(b_i - M_i x) + (x - x0)' Q_i (x - x0),
/// b = Sv^-1/2 y, M = Sv^-1/2 C, penalty lambda |r| in the paper. Whatever is measured moves the estimate by
/// at most half of (10) from x0. Steady-state covariances from (5) in the appendix' reading
/// (docs/filters/rdkf.md#r1).
///
/// A neighbour that is missing counts as holding this agent's own previous estimate. Entries of a
/// measurement that are not finite (or beyond kHuge) are missing: the step is that of a sensor without their
/// rows, for which (10) holds too; with none left the estimate is x0.
///
/// With `initial_error` and process_bound known, agents also carry a bound on their error, from their
/// neighbours' bounds and from how far their own measurement moved them: it holds under every attack on
/// measurements, but grows without end where nothing decays. After a restart there is none, here and at all
/// who hear of it, until a certificate of another kind takes over.
///
/// The pull of a *measurement* is limited, that of a message is not: one agent that lies in its messages
/// moves its neighbours without limit, in proportion to its lie, and a forged `bound` makes theirs false:
/// drivers drop all bounds when such an attack is simulated.
struct GARRISON_EXPORT Rdkf {
  static constexpr std::string_view name = "rdkf";
  static constexpr std::string_view title = "Resilient distributed Kalman filter";
  static constexpr std::string_view source = "Dutta, Zhang, Jin, 2019";

  struct Params {
    double weight = 1.0;
    std::string penalty = "norm";
    std::string solver = "exact";
    double smoothing = 0.0;
    double initial_error = kNaN;

    static auto fields() {
      return std::make_tuple(
          field(
              &Params::weight,
              {.name = "weight",
               .symbol = "lambda",
               .unit = "1",
               .doc =
                   "lambda of (8), the pull of a measurement at most; its estimate moves by at most half of "
                   "(10), which is proportional to it; 0 ignores all measurements",
               .least = 0.0,
               .most = 1e100}),
          field(&Params::penalty, {.name = "penalty",
                                   .symbol = "",
                                   .unit = "",
                                   .doc = "of the whitened residual: \"norm\" = the paper's; \"huber\" = the "
                                          "same pull, but a Kalman "
                                          "step as long as it is not reached; \"l1\" = sensor by sensor; "
                                          "\"group\" = the neighbours' "
                                          "measurements too, which then travel",
                                   .choices = {"norm", "huber", "l1", "group"}}),
          field(&Params::solver,
                {.name = "solver",
                 .symbol = "",
                 .unit = "",
                 .doc = "how the step is solved: \"exact\", or \"ipopt\" as a slow cross-check of penalty "
                        "\"norm\" in builds that have it",
                 .choices = {"exact", "ipopt"}}),
          field(
              &Params::smoothing,
              {.name = "smoothing",
               .symbol = "epsilon",
               .unit = "1",
               .doc =
                   "penalty \"norm\" only: lambda sqrt(|r|^2 + epsilon^2); solver \"ipopt\" takes 1e-6 for 0",
               .least = 0.0,
               .most = 1e100}),
          field(&Params::initial_error,
                {.name = "initial_error",
                 .symbol = "eta0",
                 .unit = "state",
                 .doc = "bound on the distance of every initial estimate from the state; giving it "
                        "asks for run-time error bounds (needs the model's process_bound)",
                 .least = 0.0}));
    }
  };

  using Gains = rdkf::Gains;

  template <int n>
  struct State {
    Vec<n> x;  // xhat_i(k)
    Vec<n> z;  // own information vector
    double bound = kNaN;
    int saturated = 0;  // steps in a row
    bool measured = false;
    rdkf::Workspace work;

    template <class V>
    void visit(V& v) {
      v("estimate", x);
      v("z", z);
      v("bound", bound);
      v.range("saturated", saturated, 0, INT32_MAX);
      v("measured", measured);
      v("deviation", work.deviation);
      v("mu", work.step.mu);
      v.range("iterations", work.step.iterations, 0, INT32_MAX);
    }
  };
  template <int n>
  struct Message {
    double bound = kNaN;
    Vec<n> z;
    Vector extended;  // penalty group: z, then y filled up with zeros
    std::vector<int>
        present;  // penalty group: which of y are there, 16 to a number, the first the lowest bit

    template <class V>
    void visit(V& v) {
      const auto states = static_cast<std::size_t>(z.size());
      v.numbers("information", std::span<double>(information(), states));
      if (extended.size() != 0)
        v.numbers("measurement", std::span<double>(extended.data() + states,
                                                   static_cast<std::size_t>(extended.size()) - states));
      v.optional("bound", bound);
      for (std::size_t k = 0; k < present.size(); ++k) v.count(rdkf::kPresent[k], present[k], 0xffff);
    }
    double* information() { return extended.size() != 0 ? extended.data() : z.data(); }
    const double* information() const { return extended.size() != 0 ? extended.data() : z.data(); }
  };

  /// @throws InvalidInput, see `rdkf::setting` and the doc of each parameter
  static Gains design(const Params& params, const Model& model, const Network& network);
  static Check check(const Params& params, const Model& model, const Network& network);
  /// Refuses a solver that is not there or does not fit the penalty.
  static void require_fitting(const Params& params);
  /// What a user should know of a run: most agents saturated for long although the plant is unstable.
  static std::vector<std::string> warnings(const Model& model, const VerdictLog& log);
  static int rounds(const Gains&) { return 1; }
  /// Of a design file: the gains have what this agent reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
    return rdkf::fits(g, l, neighbours);
  }
  static bool runs(const Gains& g) noexcept { return rdkf::runs(g); }
  /// What agent `id` needs of the gains: its own, and J of those it hears (to stand in for what they miss to
  /// send).
  static Gains part(const Gains& all, int id, std::span<const int> neighbours) {
    Gains g = all;
    g.agents.assign(all.agents.size(), {});
    for (const int j : neighbours)
      g.agents[static_cast<std::size_t>(j)].J = all.agents[static_cast<std::size_t>(j)].J;
    g.agents[static_cast<std::size_t>(id)] = all.agents[static_cast<std::size_t>(id)];
    return g;
  }

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    State<n> fresh;
    fresh.x = fresh.z = m.z = x0;
    fresh.bound = g.bounded ? g.initial_error : kNaN;
    fresh.work.resize(g, g.agents[static_cast<std::size_t>(l.id)], l.states);
    const bool group = g.penalty == rdkf::Penalty::group;
    m.extended = Vector::Zero(group ? l.states + g.most_outputs : 0);
    m.present.assign(group ? rdkf::words(g.most_outputs) : 0, 0);
    s = std::move(fresh);
  }

  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t,
                    Message<n>& m) noexcept {
    const rdkf::AgentGains& a = g.agents[static_cast<std::size_t>(l.id)];
    rdkf::multiply(a.J, s.x.data(), s.work.product);
    for (int k = 0; k < dimension<n>(l); ++k) s.z[k] = s.work.product[k];
    const std::size_t row = own_row(l, g, a);
    double* const own = s.work.y + row * static_cast<std::size_t>(g.most_outputs);
    char* const present = s.work.present.data() + row * static_cast<std::size_t>(g.most_outputs);
    int rows = 0;
    for (int r = 0; r < l.outputs; ++r) {
      const bool here = std::abs(y[r]) < kHuge;
      own[r] = here ? y[r] : 0.0;
      present[r] = here ? 1 : 0;
      rows += here ? 1 : 0;
    }
    s.work.rows[row] = rows;
    s.measured = rows > 0;
    send(l, g, s, m);
    if (g.penalty == rdkf::Penalty::group) send_measurement(l, own, present, m);
  }

  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    const rdkf::AgentGains& a = g.agents[static_cast<std::size_t>(l.id)];
    rdkf::Workspace& w = s.work;
    for (int k = 0; k < nn; ++k) w.sum[k] = 0.0;
    double bound = g.process_bound;
    double size = 0.0;
    bool some = s.measured;
    std::size_t next = 0;
    for (std::size_t j = 0; j < a.heard.size(); ++j) {
      const int id = a.heard[j];
      const double* z = s.z.data();
      double error = s.bound;
      if (id != l.id) {
        while (next < inbox.size() && inbox.sender(next) < id) ++next;
        if (next < inbox.size() && inbox.sender(next) == id) {
          const Message<n>& heard = inbox[next];
          z = heard.information();
          error = heard.bound;
          if (g.penalty == rdkf::Penalty::group) take_measurement(g, a, j, z + nn, heard.present, w);
        } else {
          rdkf::multiply(g.agents[static_cast<std::size_t>(id)].J, s.x.data(), w.product);
          z = w.product;
          if (g.penalty == rdkf::Penalty::group) w.rows[j] = 0;
        }
      }
      for (int k = 0; k < nn; ++k) w.sum[k] += z[k];
      some = some || (g.penalty == rdkf::Penalty::group && w.rows[j] > 0);
      if (!g.bounded) continue;
      bound += a.reach[j] * error;
      for (int k = 0; k < nn; ++k) size += std::abs(z[k]);
    }
    rdkf::advance(g, a, some, w);
    for (int k = 0; k < nn; ++k) s.x[k] = w.x[k];
    if (g.bounded) s.bound = (bound + w.deviation) * (1.0 + 1e-12) + a.rounding * size;
    if (!(s.bound < kHuge)) s.bound = kNaN;  // it says nothing any more
    s.saturated = w.step.mu > 0.0 && some ? one_more(s.saturated) : 0;
    send(l, g, s, m);  // after the only round: nobody reads it any more
  }

  /// The fused prediction x0 with the entrywise median of the neighbours' information vectors in place of its
  /// own, and of those that are missing.
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t,
                     State<n>& s) noexcept {
    const int nn = dimension<n>(l);
    const rdkf::AgentGains& a = g.agents[static_cast<std::size_t>(l.id)];
    rdkf::Workspace& w = s.work;
    if (inbox.size() > 0) {
      median_into<n>(inbox.size(), [&](std::size_t k) { return inbox[k].information(); }, s.z);
      const auto missing = static_cast<double>(a.heard.size() - inbox.size());
      for (int k = 0; k < nn; ++k) {
        w.sum[k] = missing * s.z[k];
        for (std::size_t j = 0; j < inbox.size(); ++j) w.sum[k] += inbox[j].information()[k];
      }
      s.measured = false;
      rdkf::advance(g, a, false, w);
      for (int k = 0; k < nn; ++k) s.x[k] = w.x[k];
    }
    if (!usable<n>(s.x)) s.x.setZero();
    s.saturated = 0;
    uncover<n>(g, s);
  }
  /// Nobody knows how far a state behind a gap is off.
  template <int n>
  static void uncover(const Gains&, State<n>& s) noexcept {
    s.bound = kNaN;
  }

  template <int n>
  static Report report(const Local& l, const Gains& g, const State<n>& s) noexcept {
    Report r;
    r.bound = std::isfinite(s.bound) ? s.bound : kNaN;
    r.statistic = s.work.deviation;
    r.threshold = g.agents[static_cast<std::size_t>(l.id)].deviation_bound;
    r.verdict = !s.measured || g.price.lambda == 0.0 ? Verdict::silent
                : s.work.step.mu > 0.0               ? Verdict::suspected
                : std::isfinite(g.price.lambda)      ? Verdict::cleared
                                                     : Verdict::not_tested;
    return r;
  }
  template <int n>
  static const Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  template <int n>
  static const AgentSet* accused(const State<n>&) noexcept {
    static const AgentSet nobody;
    return &nobody;
  }
  /// From the own estimate alone: the neighbours' vectors for the next step are not known yet.
  template <int n>
  static void expected(const Local& l, const Gains&, const State<n>& s, double* out) noexcept {
    next_measurement<n>(l, s.x.data(), out);
  }
  template <int n>
  static double alarm_level(const Local& l, const Gains& g, const State<n>&) noexcept {
    return g.agents[static_cast<std::size_t>(l.id)].quiet_level;
  }
  static constexpr std::size_t signal_count = 5;
  /// mu = residual multiplier (> 0: this agent is being pulled as far as it can be), deviation = |xhat - x0|
  /// and its bound, saturated_steps = in a row, iterations of the step's solver.
  static std::vector<std::string> signal_names() {
    return {"mu", "deviation", "deviation_bound", "saturated_steps", "iterations"};
  }
  template <int n>
  static void signals(const Local& l, const Gains& g, const State<n>& s, double* out) noexcept {
    out[0] = s.work.step.mu;
    out[1] = s.work.deviation;
    out[2] = g.agents[static_cast<std::size_t>(l.id)].deviation_bound;
    out[3] = static_cast<double>(s.saturated);
    out[4] = static_cast<double>(s.work.step.iterations);
  }

 private:
  static std::size_t own_row(const Local& l, const Gains& g, const rdkf::AgentGains& a) noexcept {
    std::size_t row = 0;
    if (g.penalty == rdkf::Penalty::group)
      while (a.heard[row] != l.id) ++row;
    return row;
  }
  /// What is sent, but for the measurement.
  template <int n>
  static void send(const Local& l, const Gains& g, const State<n>& s, Message<n>& m) noexcept {
    m.z = s.z;
    m.bound = s.bound;
    if (m.extended.size() == 0) return;
    const int nn = dimension<n>(l);
    for (int k = 0; k < nn; ++k) m.extended[k] = s.z[k];
    for (int r = 0; r < g.most_outputs; ++r) m.extended[nn + r] = 0.0;
    std::fill(m.present.begin(), m.present.end(), 0);
  }
  template <int n>
  static void send_measurement(const Local& l, const double* y, const char* present, Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    for (int r = 0; r < l.outputs; ++r) {
      m.extended[nn + r] = y[r];
      if (present[r] != 0) m.present[static_cast<std::size_t>(r / 16)] |= 1 << (r % 16);
    }
  }
  /// The measurement that the j-th agent in `heard` sent, and which of it is there.
  static void take_measurement(const Gains& g, const rdkf::AgentGains& a, std::size_t j, const double* y,
                               const std::vector<int>& present, rdkf::Workspace& w) noexcept {
    const std::size_t first = j * static_cast<std::size_t>(g.most_outputs);
    std::copy_n(y, g.most_outputs, w.y + first);
    w.rows[j] = 0;
    for (int r = 0; r < a.blocks[j].outputs(); ++r) {
      const int here = (present[static_cast<std::size_t>(r / 16)] >> (r % 16)) & 1;
      w.present[first + static_cast<std::size_t>(r)] = static_cast<char>(here);
      w.rows[j] += here;
    }
  }
};

/// The distributed Kalman filter (7), unprotected: the same step with penalty huber and an unbounded weight.
struct GARRISON_EXPORT Dkf : Rdkf {
  static constexpr std::string_view name = "dkf";
  static constexpr std::string_view title = "Distributed Kalman filter, steady state (no protection)";
  static constexpr std::string_view source = "(7) of Dutta, Zhang, Jin, 2019";

  using RunsAs = Rdkf;
  struct Params {
    static auto fields() { return std::make_tuple(); }
  };
  static Gains design(const Params& params, const Model& model, const Network& network);
  static Check check(const Params& params, const Model& model, const Network& network);
};

}  // namespace garrison
