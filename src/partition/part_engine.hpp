// SPDX-License-Identifier: Apache-2.0
// The agents of one rank: the steps of engine/engine.hpp, with ghosts in place of the agents of other ranks.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "garrison/core/filter.hpp"
#include "garrison/kernel/aligned.hpp"
#include "garrison/wire/archive.hpp"
#include "partition/between_rounds.hpp"
#include "partition/block.hpp"
#include "partition/part_average.hpp"
#include "partition/part_runner.hpp"
#include "partition/post.hpp"
#include "partition/saved.hpp"

namespace garrison::partition {

/// What a family calls the agents: their public ids of the whole network, or names 0.. of own agents and
/// ghosts in the same order, for gains that were cut down to these.
struct Names {
  std::vector<int> of;  ///< by place
  int agents = 0;       ///< how many names there are
};

/// Every decision that the engine takes for the whole network (is some estimate lost, are too many
/// measurements missing, do all agents carry the same side information) is a sum over all ranks, so the bits
/// are those of one rank. Interior agents step while ghosts travel.
/// Threads: one at a time.
template <class F, int n>
class PartEngine final : public PartRunner {
  static_assert(Filter<F, n>);
  using State = typename F::template State<n>;
  using Message = typename F::template Message<n>;
  using Gains = typename F::Gains;

 public:
  /// `model`: own agents in ascending order of public ids. `region` and `exchange` must outlive it.
  PartEngine(std::shared_ptr<const Gains> gains, const Model& model, const Region& region, Exchange& exchange,
             Names names)
      : gains_(std::move(gains)),
        A_(model.A()),
        region_(region),
        exchange_(exchange),
        names_(std::move(names)),
        post_(region, exchange, names_.of, model.states(), F::rounds(*gains_)),
        average_(region, exchange, model.states()),
        states_(static_cast<std::size_t>(region.listed())),
        places_(states_.size()) {
    for (int k = 0; k < region.own; ++k) {
      Place& place = places_[static_cast<std::size_t>(region.sorted[static_cast<std::size_t>(k)])];
      place = {model.outputs(k), model.offset(k), rows_.size()};
      const Matrix& C = model.C(k);
      for (Eigen::Index r = 0; r < C.rows(); ++r)
        for (Eigen::Index c = 0; c < C.cols(); ++c) rows_.push_back(C(r, c));
    }
  }

  void require(const MessageAttack& attack, int agents) const override {
    State state;
    Message message;
    F::template init<n>(local(0), *gains_, Vec<n>::Zero(A_.rows()), state, message);
    attack.require(FieldList(message), agents);
  }

  void reset(const Vector& x0, Link* link) override {
    exchange_.connect(region_.routes);
    average_.forget();
    post_.connect(link);
    const Vec<n> start = x0;
    each(0, region_.listed(),
         [&](int k, Message& out) { F::template init<n>(local(k), *gains_, start, state(k), out); });
    post_.fill(region_.depth() > 1 ? between_rounds_bytes(state(0)) : 0,
               [&](std::size_t place, Message& m) { shape_of(place, first_sample<F>(), m); });
    overflows_ = resets_ = 0;
  }

  void step(std::int64_t t, const double* y) override {
    if constexpr (requires { F::most_missing(*gains_); }) notice_missing(F::most_missing(*gains_), y);
    if constexpr (Averages<F, n>) {
      if (post_.perfect()) return averaged_step(t, y);
    }
    settle();
    average_.forget();
    each(0, region_.own, [&](int k, Message& out) {
      F::template sense<n>(local(k), *gains_, state(k), measured(k, y), t, out);
    });
    post_.post();
    std::int64_t lost[] = {lost_here()};
    exchange_.sum(lost);
    rounds(t, lost[0] == 0);
  }

  void estimates(double* out) const override {
    settle();
    for (int k = 0; k < region_.own; ++k) {
      const Vec<n>& x = F::template estimate<n>(states_[static_cast<std::size_t>(at(k))]);
      std::copy_n(x.data(), x.size(), out + static_cast<std::ptrdiff_t>(k) * x.size());
    }
  }
  std::int64_t overflows() const override { return overflows_; }
  std::int64_t resets() const override { return resets_; }

  void save(int k, std::vector<std::byte>& out) const override {
    settle();
    save_state(states()[static_cast<std::size_t>(at(k))], known_to(at(k)), out);
  }
  void load(int k, std::span<const std::byte> bytes) override {
    if (!load_state(bytes, known_to(at(k)), names_.agents, state(at(k))))
      refuse("checkpoint",
             "no state of agent " + std::to_string(region_.ids[static_cast<std::size_t>(at(k))]),
             "one that this filter wrote with the same parameters");
  }

 private:
  struct Place {
    int outputs;
    int offset;         // in y
    std::size_t first;  // in rows_
  };
  /// Place of the k-th own agent.
  int at(int k) const { return region_.sorted[static_cast<std::size_t>(k)]; }
  State& state(int place) { return states_[static_cast<std::size_t>(place)]; }
  /// Of the own agents.
  std::span<State> states() const {
    return {const_cast<State*>(states_.data()), static_cast<std::size_t>(region_.own)};
  }
  Local local(int place) const {
    const Place& p = places_[static_cast<std::size_t>(place)];
    return {names_.of[static_cast<std::size_t>(place)],
            names_.agents,
            static_cast<int>(A_.rows()),
            p.outputs,
            region_.degree(place),
            A_.data(),
            rows_.data() + p.first};
  }
  /// Itself, and those that it hears.
  std::vector<Known> known_to(int place) const {
    const auto known = [&](std::int32_t p) {
      const auto k = static_cast<std::size_t>(p);
      return Known{names_.of[k], region_.ids[k]};
    };
    std::vector<Known> all{known(place)};
    const auto k = static_cast<std::size_t>(place);
    for (std::size_t e = region_.first[k]; e < region_.first[k + 1]; ++e)
      all.push_back(known(region_.heard[e]));
    return all;
  }
  const double* measured(int place, const double* y) const {
    return y + places_[static_cast<std::size_t>(place)].offset;
  }
  void shape_of(std::size_t sender, std::int64_t t, Message& m) const {
    garrison::shape<F, n>(local(0), *gains_, names_.of[sender], t, m);
  }

  /// Brings the states up to date.
  void settle() const {
    if constexpr (Averages<F, n>) average_.settle(states());
  }
  template <class Action>
  void each(int begin, int end, const Action& action) {
    Message* const out = post_.outgoing();
    for (int k = begin; k < end; ++k) action(k, out[k]);
  }
  std::int64_t lost_here() const {
    const auto own = states();
    return std::count_if(own.begin(), own.end(),
                         [](const State& s) { return !usable<n>(F::template estimate<n>(s)); });
  }

  /// Engine::notice_missing, counted over all ranks.
  void notice_missing(int most, const double* y) {
    std::int64_t sensors[] = {0};
    for (int k = 0; k < region_.own; ++k) {
      const double* own = measured(k, y);
      const int outputs = places_[static_cast<std::size_t>(k)].outputs;
      sensors[0] += std::any_of(own, own + outputs, [](double v) { return std::isnan(v); }) ? 1 : 0;
    }
    exchange_.sum(sensors);
    if (sensors[0] <= most) return;
    for (State& s : states()) garrison::uncover<F, n>(*gains_, s);
  }

  /// A sample of a family whose rounds only average, over perfect links.
  void averaged_step(std::int64_t t, const double* y) {
    average_.gather(states());
    average_.template sense<F, n>(
        *gains_, A_.data(), t, states(), [&](int k) { return local(k); },
        [&](int k) { return measured(k, y); });
    const auto own = states();
    const auto same = std::count_if(own.begin(), own.end(), [&](const State& s) {
      return F::template same_side_information<n>(s, own[0]);
    });
    // Whether all agents of the network carry the same side information: all here alike, and as on rank 0.
    std::int64_t counts[] = {average_.lost(), region_.own - same, own[0].intact ? 1 : 0,
                             F::template bare<n>(own[0]) ? 0 : 1};
    exchange_.sum(counts);
    const bool alike = counts[1] == 0 && (counts[2] == 0 || counts[2] == exchange_.ranks()) && counts[3] == 0;
    if (counts[0] == 0 && alike) {
      const auto [alpha, omega] = F::averaging(*gains_);
      return average_.run(alpha, omega, F::rounds(*gains_));
    }
    settle();
    average_.forget();
    each(0, region_.own, [&](int k, Message& out) { F::template send<n>(state(k), out); });
    post_.post();
    rounds(t, counts[0] == 0);
  }

  /// Messages of own agents, and their states where others work out their rounds too.
  void send() {
    post_.send([&](int place, std::span<std::byte> out) {
      if (region_.depth() > 1) write_between_rounds(state(place), out);
    });
  }
  void receive(std::int64_t t) {
    post_.receive([&](std::size_t place, Message& m) { shape_of(place, t, m); },
                  [&](int place, std::span<const std::byte> in) {
                    if (place < region_.listed()) read_between_rounds(in, names_.agents, state(place));
                  });
  }

  /// `plain`: every estimate of the network can be worked with.
  void rounds(std::int64_t t, bool plain) {
    std::vector<int> lost;
    if (!plain) {
      ++overflows_;
      for (int k = 0; k < region_.own; ++k)
        if (!usable<n>(F::template estimate<n>(state(k)))) lost.push_back(k);
    }
    for (int round = 0; round < F::rounds(*gains_); ++round) {
      const auto fuse = [&](int k, Message& out) {
        F::template fuse<n>(local(k), *gains_, state(k), post_.inbox(k), round, out);
      };
      const Block block(round, F::rounds(*gains_), region_.depth());
      // Faults and lies take the message of every ghost.
      const bool overlapped = block.first && post_.as_wired(plain);
      if (block.first) {
        send();
        if (overlapped) each(0, region_.interior, fuse);
        receive(t);
      }
      const int end = region_.rings[block.reach];
      post_.collect(t, round, plain, end, [&](int receiver, std::size_t sender, Message& m) {
        garrison::shape<F, n>(local(receiver), *gains_, names_.of[sender], t, m);
      });
      each(overlapped ? region_.interior : 0, end, fuse);
      post_.post();
    }
    if (lost.empty()) return;
    const Inbox<Message> nobody(nullptr, {}, nullptr, 0);  // of a filter without rounds
    for (const int k : lost)
      F::template rejoin<n>(local(k), *gains_, F::rounds(*gains_) > 0 ? post_.inbox(k) : nobody, t, state(k));
    resets_ += static_cast<std::int64_t>(lost.size());
  }

  std::shared_ptr<const Gains> gains_;
  Matrix A_;
  const Region& region_;
  Exchange& exchange_;
  Names names_;
  Post<Message> post_;
  mutable PartAverage average_;
  Aligned<State> states_;  // by place, of ghosts too where their rounds are worked out here
  std::vector<Place> places_;
  Aligned<double> rows_;  // of all own C_i
  std::int64_t overflows_ = 0;
  std::int64_t resets_ = 0;
};

}  // namespace garrison::partition
