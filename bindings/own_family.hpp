// SPDX-License-Identifier: Apache-2.0
// The family whose functions call Python: everything that the engine asks of a family (core/filter.hpp).
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/engine.hpp"
#include "own.hpp"

namespace own {

/// Names and sizes of what a message carries.
struct Layout {
  std::vector<std::string> names;
  std::vector<std::size_t> sizes;
  std::size_t total = 0;
};

/// What one agent of such a filter is told of itself; Python sees it as garrison.AgentInfo.
struct AgentInfo {
  int id = 0;
  int agents = 0;
  std::string name;  ///< "" = none
  garrison::Matrix A;
  garrison::Matrix C;
  std::vector<int> neighbours;
  py::object gains;
  garrison::Matrix Q{};  ///< of the process noise; empty = not known
  garrison::Vector R{};  ///< variances of its own outputs; empty = not known
};

/// All that Python keeps for one run; used under the lock, by one thread.
struct Session {
  struct Agent {
    py::object info;
    py::object state;
    std::vector<double> signals;
  };
  py::object filter;
  std::string name;
  Layout layout;
  std::vector<std::string> signals;
  std::vector<Agent> agents;
  std::int64_t t = 0;
  std::exception_ptr failure;  ///< the first one; nothing of the user's is called after it
};

struct Family {
  static constexpr std::string_view name = "own";
  static constexpr std::size_t signal_count = 0;  // OwnRunner writes them

  struct Gains {
    Session* session = nullptr;
    int rounds = 0;
  };
  template <int n>
  struct State {
    garrison::Vec<n> x;
    int id = 0;
    mutable garrison::AgentSet accused;
  };
  template <int n>
  struct Message {
    const Layout* layout = nullptr;
    std::vector<double> values;

    template <class V>
    void visit(V& v) {
      std::size_t at = 0;
      for (std::size_t k = 0; layout != nullptr && k < layout->names.size(); at += layout->sizes[k++])
        v.numbers(layout->names[k], std::span<double>(values).subspan(at, layout->sizes[k]));
    }
  };

  static int rounds(const Gains& g) { return g.rounds; }

  template <int n>
  static void init(const garrison::Local& l, const Gains& g, const garrison::Vec<n>& x0, State<n>& s,
                   Message<n>& m) {
    s.x = x0;
    s.id = l.id;
    s.accused.resize(l.agents);
    m.layout = &g.session->layout;
    m.values.assign(m.layout->total, garrison::kNaN);
    start(*g.session, l.id, x0, s.x);
  }
  template <int n>
  static void sense(const garrison::Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t t,
                    Message<n>& m) noexcept {
    sense(*g.session, l.id, {y, static_cast<std::size_t>(l.outputs)}, t, s.x, m.values);
  }
  template <int n>
  static void fuse(const garrison::Local& l, const Gains& g, State<n>& s,
                   const garrison::Inbox<Message<n>>& inbox, int round, Message<n>& m) noexcept {
    fuse(*g.session, l.id, letters(inbox), round, s.x, m.values);
  }
  template <int n>
  static void rejoin(const garrison::Local& l, const Gains& g, const garrison::Inbox<Message<n>>& inbox,
                     std::int64_t t, State<n>& s) noexcept {
    rejoin(*g.session, l.id, letters(inbox), t, s.x);
  }
  template <int n>
  static garrison::Report report(const garrison::Local& l, const Gains& g, const State<n>& s) noexcept {
    return report(*g.session, l.id, s.accused);
  }
  template <int n>
  static const garrison::Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  /// The copy of it that the engine has; that of the user's state: `place`.
  template <int n>
  static double* averaged(State<n>& s) noexcept {
    return s.x.data();
  }
  template <int n>
  static const garrison::AgentSet* accused(const State<n>& s) noexcept {
    return &s.accused;
  }
  template <int n>
  static void expected(const garrison::Local& l, const Gains& g, const State<n>& s, double* out) noexcept {
    garrison::next_measurement<n>(l, s.x.data(), out);
    expected(*g.session, l.id, {out, static_cast<std::size_t>(l.outputs)});
  }
  template <int n>
  static double alarm_level(const garrison::Local& l, const Gains& g, const State<n>&) noexcept {
    return alarm_level(*g.session, l.id);
  }
  template <int n>
  static void signals(const garrison::Local&, const Gains&, const State<n>&, double*) noexcept {}

  /// Gives the user's state of agent `id` another estimate.
  static void place(Session& s, int id, const garrison::Vector& x) noexcept;

 private:
  using Vector = garrison::Vector;
  /// The messages of an inbox, by sender.
  using Letters = std::vector<std::pair<int, const double*>>;
  template <class Message>
  static Letters letters(const garrison::Inbox<Message>& inbox) {
    Letters all;
    for (std::size_t k = 0; k < inbox.size(); ++k) all.emplace_back(inbox.sender(k), inbox[k].values.data());
    return all;
  }

  static void start(Session& s, int id, const Vector& x0, Vector& x);
  static void sense(Session& s, int id, std::span<const double> y, std::int64_t t, Vector& x,
                    std::vector<double>& out) noexcept;
  static void fuse(Session& s, int id, const Letters& inbox, int round, Vector& x,
                   std::vector<double>& out) noexcept;
  static void rejoin(Session& s, int id, const Letters& inbox, std::int64_t t, Vector& x) noexcept;
  static garrison::Report report(Session& s, int id, garrison::AgentSet& accused) noexcept;
  static void expected(Session& s, int id, std::span<double> out) noexcept;
  static double alarm_level(Session& s, int id) noexcept;
};

}  // namespace own
