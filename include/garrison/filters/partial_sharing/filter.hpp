// SPDX-License-Identifier: Apache-2.0
// Consensus Kalman filter that shares a part of its estimate: BR-CDF, Algorithm 1 of Moradi, Gogineni,
// Venkategowda, Werner, "Distributed filtering design with enhanced resilience to coordinated Byzantine
// attacks".
//
// Steps, for every agent i and sample t (numbers are the paper's equations; k = t - 1):
//   predict  xhat_i(k) = A z_i(t-1)
//   share    the l entries of xhat_i(k) that S_i(k) selects; the selection then shifts by tau
//   update   z_i(t) = xhat_i + Kf (y_i - H_i xhat_i) + gamma (I - Kf H_i) P_i sum_j S_j (xbar_j - xhat_i)
// so that A z_i(t) is xhat_i(k+1) of (10): K_i = A Kf (9) and C_i = gamma (A - K_i H_i) P_i. The estimate of
// time t is z_i(t), which has seen y_i(t); the paper's xhat_i(k+1) is the prediction from it. Gains follow
// (11), which sees no data: they are frozen once they have converged, or follow the matrices of every sample
// (vary.hpp), and a missing measurement leaves them alone. A z_i(t) is computed with z_i(t), so that `sense`
// only has to send it. Numbers are kept in groups of agents side by side (group.hpp); an agent on its own is
// a group of one.
//
// Where we leave the print: C_i has no inverse of P_i, so singular covariances and agents without
// sensors are ordinary; entries j did not share, or that are missing or beyond kHuge, count as agreeing.
// There is no screening and no test: one liar moves the estimate without limit, in proportion to its lie. No
// bound is reported.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "garrison/core/change.hpp"
#include "garrison/core/conditions.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/series.hpp"
#include "garrison/filters/partial_sharing/group.hpp"
#include "garrison/filters/partial_sharing/selection.hpp"
#include "garrison/filters/partial_sharing/update.hpp"
#include "garrison/kernel/block.hpp"

namespace garrison {

struct GARRISON_EXPORT PartialSharing {
  static constexpr std::string_view name = "partial_sharing";
  static constexpr std::string_view title = "Consensus Kalman filter with partial sharing (BR-CDF)";
  static constexpr std::string_view source = "Moradi, Gogineni, Venkategowda, Werner, 2023, Algorithm 1";

  struct Params {
    double gain = kNaN;
    int shared = 0;
    std::vector<double> shared_each;
    std::vector<double> selection;
    std::string starts = "random";
    int selection_seed = 0;
    int shift = 1;
    double start_variance = 1.0;
    std::vector<double> start_covariance;
    bool start_is_prediction = false;
    std::string gains = "frozen";

    static auto fields();
  };

  /// The limit of an agent's recursion: gamma times the filtered covariance, and the gain of innovations.
  struct Steady {
    std::vector<double> P, G, K;

    template <class V>
    void visit(V& v) {
      v("P", P);
      v("G", G);
      v("K", K);
    }
  };
  struct Gains {
    double gamma = 0.0;
    partial_sharing::Selection selection;
    std::vector<std::vector<double>> W;  ///< of each agent, row by row: W R_i W' = I, lower triangular
    std::vector<Steady> steady;          ///< empty: the recursion runs
    Matrix Q;
    Matrix P0;      ///< of the first sample
    Matrix before;  ///< P_0 one sample earlier, for a plant that changes; none where it is P0, or gains rest
    bool given = false;  ///< the start is xhat(0) with P0, not an estimate one sample earlier
    bool freeze = true;

    template <class V>
    void visit(V& v) {
      v("gamma", gamma);
      v("selection", selection);
      v("W", W);
      v("steady", steady);
      v("Q", Q);
      v("P0", P0);
      v("before", before);
      v("given", given);
      v("freeze", freeze);
    }
  };
  /// What agent `id` needs of the gains; the entries that others share are few and stay.
  static Gains part(const Gains& all, int id, std::span<const int>) {
    const auto i = static_cast<std::size_t>(id);
    Gains g{all.gamma, all.selection, {}, {}, all.Q, all.P0, all.before, all.given, all.freeze};
    g.W.resize(all.W.size());
    g.W[i] = all.W[i];
    g.steady.resize(all.steady.size());
    if (!g.steady.empty()) g.steady[i] = all.steady[i];
    return g;
  }

  template <int n>
  struct State {
    std::shared_ptr<partial_sharing::Group<n>> group;  // with the agent's numbers in lane `lane`
    int lane = 0;
    AgentSet nobody;

    template <class V>
    void visit(V& v) {
      partial_sharing::Group<n>& g = *group;
      const auto all = [&](const char* name, double* array, int count) {
        for (int k = 0; k < count; ++k) v(name, g.at(array, k, lane));
      };
      all("innovations", g.y, g.q);
      all("estimate", g.z, g.m);
      all("P", g.P, packed(g.m));
      all("G", g.G, packed(g.m));
      all("K", g.K, g.q * g.m);
      if (g.follows) {
        all("C", g.C, g.q * g.m);
        all("W", g.W, packed(g.q));
      }
      v("prediction", std::span<double>(g.prediction(lane), static_cast<std::size_t>(g.m)));
      bool frozen = g.is_frozen(lane);
      v("frozen", frozen);
      g.set_frozen(lane, frozen);
      v("started", g.started);
    }
  };

  /// The shared entries. Which ones they are follows from the sender and the time (`shape`), never from the
  /// wire.
  template <int n>
  struct Message {
    std::conditional_t<n == Dynamic, std::vector<double>, std::array<double, kOnStack<n>>> value{};
    std::conditional_t<n == Dynamic, std::vector<int>, std::array<int, kOnStack<n>>> entry{};
    int count = 0;
    std::span<const int> entries() const { return {entry.data(), static_cast<std::size_t>(count)}; }

    template <class V>
    void visit(V& v) {
      v.numbers("shared", std::span<double>(value.data(), static_cast<std::size_t>(count)));
    }
  };

  /// Detectability, sharing, and the three stability tests side by side; MSE with and without sharing.
  static Check check(const Params& params, const Model& model, const Network& network);
  /// @throws InvalidInput when covariances are missing or R_i is singular, selections do not fit, or steady
  /// gains are asked for where (11) diverges
  static Gains design(const Params& params, const Model& model, const Network& network);
  /// Of a design file: the gains have what this agent reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int>) noexcept {
    const auto agents = static_cast<std::size_t>(l.agents);
    const auto n = static_cast<std::size_t>(l.states);
    const auto q = static_cast<std::size_t>(l.outputs);
    const auto id = static_cast<std::size_t>(l.id);
    const auto square = [&](const Matrix& m) { return m.rows() == l.states && m.cols() == l.states; };
    if (!g.selection.fits(l.agents, l.states) || g.W.size() != agents || g.W[id].size() != q * q ||
        !square(g.Q))
      return false;
    if (!g.freeze && !g.given && !square(g.before)) return false;
    if (g.steady.empty()) return square(g.P0);
    if (g.steady.size() != agents) return false;
    const Steady& own = g.steady[id];
    return own.P.size() == n * n && own.G.size() == n * n && own.K.size() == q * n;
  }
  static int rounds(const Gains&) { return 1; }
  /// Why a plant that changes in time cannot be taken; empty: it can.
  static std::string needs_constant(const Gains& g) {
    return g.freeze ? "gains that freeze, or are steady, are those of one plant; gains = \"varying\" takes it"
                    : "";
  }
  /// @throws InvalidInput where some R_i has no inverse
  static void require_series(const Series& series, const Model& model);

  /// A state that has been given its lane of a group stays there.
  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m);

  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t t,
                    Message<n>& m) noexcept {
    for (int r = 0; r < l.outputs; ++r) s.group->at(s.group->y, r, s.lane) = y[r];
    const double* const x = s.group->prediction(s.lane);
    shape<n>(l, g, l.id, t, m);
    for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) m.value[k] = x[m.entry[k]];
  }
  /// Which entries `sender` shares at sample t.
  template <int n>
  static void shape(const Local& l, const Gains& g, int sender, std::int64_t t, Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    const int moved = g.selection.offset(t - 1);
    const auto shared = g.selection.entries(sender);
    m.count = static_cast<int>(shared.size());
    for (std::size_t k = 0; k < shared.size(); ++k) {
      const int a = shared[k] + moved;
      m.entry[k] = a < nn ? a : a - nn;
    }
  }

  /// (11) and the prediction once more from the last sample, with the A and Q of this one; then its C and W.
  template <int n>
  static void vary(const Local& l, const Gains& g, const Change& change, Eigen::Index first,
                   State<n>& s) noexcept;
  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>& m) noexcept;
  /// Entrywise median of the predictions that neighbours shared; entries that nobody shared stay.
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t t,
                     State<n>& s) noexcept;

  template <int n>
  static Report report(const Local& l, const Gains& g, const State<n>& s) noexcept;

  template <int n>
  static Vec<n> estimate(const State<n>& s) noexcept {
    Vec<n> z(s.group->m);
    for (int i = 0; i < s.group->m; ++i) z[i] = s.group->at(s.group->z, i, s.lane);
    return z;
  }
  /// Whether nothing in it is so large that no sample and no gain could have made it.
  template <int n>
  static bool sound(const State<n>& s) noexcept {
    partial_sharing::Group<n>& g = *s.group;
    bool all = true;
    const auto look = [&](double* array, int count) {
      for (int k = 0; k < count; ++k) all = all && std::abs(g.at(array, k, s.lane)) < kHuge;
    };
    look(g.P, packed(g.m));
    look(g.G, packed(g.m));
    look(g.K, g.q * g.m);
    look(g.C, g.q * g.m);
    look(g.W, packed(g.q));
    for (int k = 0; k < g.m; ++k) all = all && std::abs(g.prediction(s.lane)[k]) < kHuge;
    return all;
  }
  template <int n>
  static const AgentSet* accused(const State<n>& s) noexcept {
    return &s.nobody;
  }
  template <int n>
  static void expected(const Local& l, const Gains&, const State<n>& s, double* out) noexcept {
    measurement<n>(l, s.group->prediction(s.lane), out);
  }
  template <int n>
  static double alarm_level(const Local&, const Gains&, const State<n>&) noexcept {
    return kInfinity;
  }
  static constexpr std::size_t signal_count = 3;
  static std::vector<std::string> signal_names() { return {"trace", "frozen", "shared"}; }
  /// tr P_i of (11) for the next sample, by the A of this one and the model's Q, whether the gains are
  /// frozen, and the number of entries sent.
  template <int n>
  static void signals(const Local& l, const Gains& g, const State<n>& s, double* out) noexcept {
    const int nn = dimension<n>(l);
    out[0] = 0.0;
    for (int i = 0; i < nn; ++i) out[0] += s.group->at(s.group->P, packed(i, i), s.lane);
    out[1] = s.group->is_frozen(s.lane) ? 1.0 : 0.0;
    out[2] = static_cast<double>(g.selection.shared(l.id));
  }

  /// Several agents at once (engine/batch/side_by_side.hpp).
  template <int n>
  class SideBySide;

 private:
  static partial_sharing::Common common(const Local& l, const Gains& g) noexcept {
    return {l.A, g.Q.data(), g.gamma, g.freeze};
  }
  /// C of `l`, and W from row `first` of what was told on; null = the design's.
  template <int n>
  static void use_sensor(const Local& l, const Gains& g, const Matrix* told, Eigen::Index first,
                         State<n>& s) noexcept;
  /// sum_j S_j (xbar_j - xhat_i)
  template <int n>
  static void disagreement(const State<n>& s, const Inbox<Message<n>>& inbox, double* u) noexcept;
};

}  // namespace garrison

#include "garrison/filters/partial_sharing/agent.hpp"
#include "garrison/filters/partial_sharing/params.hpp"
#include "garrison/filters/partial_sharing/vary.hpp"
