// SPDX-License-Identifier: Apache-2.0
// Local-filtering-based resilient estimation (Mitra and Sundaram, Automatica 2019), a baseline.
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
#include "garrison/kernel/block.hpp"

namespace garrison {

/// The saturation paper only cites this filter; our definition, docs/filters/baselines.md#lfre:
/// all modes form one group.
/// An agent that can observe the whole state alone is a source and runs a Luenberger observer,
///   xhat_i(t) = A xhat_i(t-1) + H_i (y_i(t-1) - C_i xhat_i(t-1)),  xhat_i(1) = A xhat_i(0);
/// an output that is missing corrects nothing. H_i places the poles with all of its outputs, or with one of
/// them alone where that gives the smaller steady error.
/// Every other one averages, entry by entry, its parents' xhat(t-1) without the f largest and f smallest, and
/// predicts: xhat_i(t) = A mean. Parents are the neighbours closer to a source, or all neighbours when fewer
/// than 2f + 1 are. Missing neighbours are left out; with none left the agent predicts from its own estimate.
///
/// No agent tests anything, and none reports a bound. Up to f parents that lie in their messages are trimmed
/// away; one more, or a source that lies, moves its children without limit.
struct GARRISON_EXPORT Lfre {
  static constexpr std::string_view name = "lfre";
  static constexpr std::string_view title = "Local-filtering-based resilient estimation";
  static constexpr std::string_view source =
      "Mitra, Sundaram, Automatica 2019; baseline of the saturation paper";

  struct Params {
    int faulty = 1;
    std::vector<double> poles;

    static auto fields() {
      return std::make_tuple(
          field(&Params::faulty, {.name = "faulty",
                                  .symbol = "f",
                                  .unit = "agents",
                                  .doc = "values trimmed from each end of the parents' estimates",
                                  .least = 0}),
          field(&Params::poles,
                {.name = "poles",
                 .symbol = "",
                 .unit = "1",
                 .doc = "real poles of the sources' observers, one per state; left out: equally spaced over "
                        "0.1, from 0.3 to 0.8, where the noise gives each source the least error",
                 .least = -1.0,
                 .most = 1.0}));
    }
  };

  struct Gains {
    int faulty = 1;
    std::vector<Matrix> observer;           ///< H_i per agent, n x outputs; empty = not a source
    std::vector<std::vector<int>> parents;  ///< sorted ids; of a source: all neighbours, unused

    template <class V>
    void visit(V& v) {
      v.range("faulty", faulty, 0, INT32_MAX);
      v("observer", observer);
      v("parents", parents);
    }
  };
  /// What agent `id` needs of them.
  static Gains part(const Gains& all, int id, std::span<const int>) {
    const auto i = static_cast<std::size_t>(id);
    Gains g{all.faulty, std::vector<Matrix>(all.observer.size()),
            std::vector<std::vector<int>>(all.parents.size())};
    g.observer[i] = all.observer[i];
    g.parents[i] = all.parents[i];
    return g;
  }

  template <int n>
  struct State {
    Vec<n> x;
    Vec<n> mean;
    std::vector<double> y_before;  // y(t-1), what the observer uses at t
    std::vector<double> y_now;
    bool measured = false;  // y_now holds a number
    bool source = false;    // by the gains
    std::vector<double> column;
    AgentSet nobody;

    template <class V>
    void visit(V& v) {
      v("estimate", x);
      v("y_before", y_before);
      v("y_now", y_now);
      v("measured", measured);
    }
  };
  template <int n>
  struct Message {
    Vec<n> x;

    template <class V>
    void visit(V& v) {
      v.numbers("estimate", x);
    }
  };

  /// @throws InvalidInput when poles do not match the state, or when no agent is a source
  static Gains design(const Params& params, const Model& model, const Network& network);
  static Check check(const Params& params, const Model& model, const Network& network);
  /// Of a design file: the gains have what this agent reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int>) noexcept {
    const auto agents = static_cast<std::size_t>(l.agents);
    return g.observer.size() == agents && g.parents.size() == agents;
  }
  static int rounds(const Gains&) { return 1; }

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    State<n> fresh;
    fresh.x = fresh.mean = m.x = x0;
    fresh.column.resize(static_cast<std::size_t>(l.degree));
    fresh.y_before.assign(static_cast<std::size_t>(l.outputs), kNaN);
    fresh.y_now = fresh.y_before;
    fresh.source = is_source(l, g);
    s = std::move(fresh);
  }

  template <int n>
  static void sense(const Local& l, const Gains&, State<n>& s, const double* y, std::int64_t,
                    Message<n>& m) noexcept {
    std::swap(s.y_before, s.y_now);
    s.measured = false;
    double* const now = s.y_now.data();
    for (int r = 0; r < l.outputs; ++r) {
      const bool here = std::abs(y[r]) < kHuge;
      now[r] = here ? y[r] : kNaN;
      s.measured |= here;
    }
    m.x = s.x;
  }

  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>& m) noexcept {
    const int nn = dimension<n>(l);
    if (s.source)
      s.mean = s.x;
    else
      trimmed_mean(g.parents[static_cast<std::size_t>(l.id)], g.faulty, inbox, nn, s);
    multiply<n>(l.A, s.mean.data(), s.x.data(), nn);
    if (s.source) correct(l, g.observer[static_cast<std::size_t>(l.id)], nn, s);
    m.x = s.x;
  }

  /// A times the entrywise median of what the neighbours estimated a sample ago, parents or not.
  template <int n>
  static void rejoin(const Local& l, const Gains&, const Inbox<Message<n>>& inbox, std::int64_t,
                     State<n>& s) noexcept {
    std::fill(s.y_before.begin(), s.y_before.end(), kNaN);
    if (inbox.size() > 0) {
      median_into<n>(inbox.size(), [&](std::size_t k) { return inbox[k].x.data(); }, s.mean);
      multiply<n>(l.A, s.mean.data(), s.x.data(), dimension<n>(l));
    }
    if (!usable<n>(s.x)) s.x.setZero();
  }

  template <int n>
  static Report report(const Local&, const Gains&, const State<n>& s) noexcept {
    Report r;
    r.verdict = s.measured && s.source ? Verdict::not_tested : Verdict::silent;
    return r;
  }
  template <int n>
  static const Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  template <int n>
  static const AgentSet* accused(const State<n>& s) noexcept {
    return &s.nobody;
  }
  template <int n>
  static void expected(const Local& l, const Gains&, const State<n>& s, double* out) noexcept {
    measurement<n>(l, s.x.data(), out);
  }
  template <int n>
  static double alarm_level(const Local&, const Gains&, const State<n>&) noexcept {
    return kInfinity;
  }
  static constexpr std::size_t signal_count = 1;
  static std::vector<std::string> signal_names() { return {"source"}; }
  template <int n>
  static void signals(const Local&, const Gains&, const State<n>& s, double* out) noexcept {
    out[0] = s.source ? 1.0 : 0.0;
  }

 private:
  static bool is_source(const Local& l, const Gains& g) noexcept {
    const Matrix& H = g.observer[static_cast<std::size_t>(l.id)];
    return H.size() != 0 && H.rows() == l.states && H.cols() == l.outputs;
  }
  /// Adds H (y(t-1) - C mean) for the outputs that are there.
  template <int n>
  static void correct(const Local& l, const Matrix& H, int nn, State<n>& s) noexcept {
    for (int r = 0; r < l.outputs; ++r) {
      double innovation = s.y_before[static_cast<std::size_t>(r)];
      if (std::isnan(innovation)) continue;
      const double* const c = l.C + static_cast<std::ptrdiff_t>(r) * nn;
      const double* const h = H.data() + static_cast<std::ptrdiff_t>(r) * nn;
      for (int k = 0; k < nn; ++k) innovation -= c[k] * s.mean[k];
      for (int i = 0; i < nn; ++i) s.x[i] += h[i] * innovation;
    }
  }
  template <int n>
  static void trimmed_mean(const std::vector<int>& parents, int faulty, const Inbox<Message<n>>& inbox,
                           int nn, State<n>& s) noexcept {
    for (int k = 0; k < nn; ++k) {
      std::size_t m = 0;
      for (std::size_t j = 0; j < inbox.size(); ++j)
        if (std::binary_search(parents.begin(), parents.end(), inbox.sender(j)))
          s.column[m++] = inbox[j].x[k];
      s.mean[k] = s.x[k];
      if (m == 0) continue;
      const auto begin = s.column.begin();
      std::sort(begin, begin + static_cast<std::ptrdiff_t>(m));
      const std::size_t trim = std::min(static_cast<std::size_t>(faulty), (m - 1) / 2);
      double sum = 0.0;
      for (std::size_t j = trim; j < m - trim; ++j) sum += s.column[j];
      s.mean[k] = sum / static_cast<double>(m - 2 * trim);
    }
  }
};

}  // namespace garrison
