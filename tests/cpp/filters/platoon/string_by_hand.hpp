// SPDX-License-Identifier: Apache-2.0
// A string of vehicles in closed loop with its world, whose states tests may look at, and in which vehicles
// are replaced and messages lost.
#pragma once

#include <doctest/doctest.h>

#include "garrison/filters/platoon/filter.hpp"
#include "random_platoon.hpp"

namespace garrison::test {

/// What must never happen in runs that meet the assumptions, and how far things went.
struct Promises {
  int bounds_violated = 0;
  int gaps_violated = 0;  // certified least gap above the gap, or spacing error below the true one
  int accused_clean = 0;
  int cleared_attacked = 0;
  int doubted = 0;
  double least_gap = kInfinity;
};

class StringByHand final : public Victims {
 public:
  StringByHand(const Platoon& p, const ParamMap& params, const Start& start, std::uint64_t seed,
               const std::string& law, const Matrix* disturbances = nullptr)
      : model_(p.model),
        gains_(garrison::Platoon::design(parse_params<garrison::Platoon::Params>("platoon", params), p.model,
                                         p.network)),
        rng_(seed) {
    world_ = garrison::Platoon::world(gains_, {start.x0, start.estimate, 0.0, law, disturbances, seed, 0});
    states_.resize(static_cast<std::size_t>(N()));
    messages_.resize(static_cast<std::size_t>(N()));
    fresh_.assign(static_cast<std::size_t>(N()), false);
    y_.resize(static_cast<std::size_t>(model_.total_outputs()));
    for (int i = 0; i < N(); ++i) init(i, start.estimate.col(i));
  }

  int N() const { return gains_.setting.vehicles; }
  const platoon::VehicleState& state(int i) const { return states_[static_cast<std::size_t>(i)]; }
  std::span<double> y() { return y_; }
  double error(int i) const {
    return platoon::length(state(i).x[0] - truth(i)[0], state(i).x[1] - truth(i)[1]);
  }
  const double* truth(int i) const { return world_->truth().data() + 2 * i; }
  double bound(int i) const { return garrison::Platoon::report<2>(local(i), gains_, state(i)).bound; }
  void attack(const std::vector<Attack>& plans) {
    plans_ = plans;  // what they start refers to them
    for (const Attack& plan : plans_)
      attacks_.push_back(plan->start(model_, Random(rng_(), 0, Purpose::attack), 1));
  }

  /// Vehicle i starts anew after the present sample, as an agent that is reset to x0 does.
  void replace(int i, const Vec<2>& x0) {
    init(i, x0);
    garrison::Platoon::uncover<2>(gains_, states_[static_cast<std::size_t>(i)]);
    fresh_[static_cast<std::size_t>(i)] = true;
  }

  /// One sample; every message is lost with probability `loss`, every measurement with `missing`.
  void step(std::int64_t t, double loss = 0.0, double missing = 0.0) {
    std::vector<double> u;
    for (const auto& s : states_) u.push_back(s.u);
    world_->next(t, u, y_);
    for (auto& attack : attacks_) attack->apply({static_cast<int>(t), y_, *this});
    for (int i = 0; i < N() && missing > 0.0; ++i)
      for (int k = 0; k < model_.outputs(i); k += 2)
        if (uniform(rng_, 0, 1) < missing) y_[at(i, k)] = y_[at(i, k + 1)] = kNaN;
    for (int i = 0; i < N(); ++i)
      garrison::Platoon::sense<2>(local(i), gains_, states_[static_cast<std::size_t>(i)],
                                  y_.data() + at(i, 0), t, messages_[static_cast<std::size_t>(i)]);
    for (int i = 0; i < N(); ++i) {
      std::vector<std::uint32_t> slots;
      std::vector<int> senders;
      for (int j = std::max(0, i - range()); j <= std::min(N() - 1, i + range()); ++j) {
        if (j == i || fresh_[static_cast<std::size_t>(j)] || uniform(rng_, 0, 1) < loss) continue;
        slots.push_back(static_cast<std::uint32_t>(j));
        senders.push_back(j);
      }
      const Inbox<platoon::VehicleMessage> inbox(messages_.data(), slots, senders.data(), 2 * range());
      auto& s = states_[static_cast<std::size_t>(i)];
      garrison::Platoon::fuse<2>(local(i), gains_, s, inbox, 0, messages_[static_cast<std::size_t>(i)]);
      if (fresh_[static_cast<std::size_t>(i)]) garrison::Platoon::rejoin<2>(local(i), gains_, inbox, t, s);
    }
    fresh_.assign(fresh_.size(), false);
  }

  /// Compares what all vehicles claim after a sample with the truth; `attacked`: whose sensors are.
  void judge(const std::vector<int>& attacked, Promises& all) const {
    for (int i = 0; i < N(); ++i) {
      const auto& s = state(i);
      if (error(i) > bound(i)) ++all.bounds_violated;
      if (s.trouble != 0) ++all.doubted;
      for (const int id : s.sets.attacked.listed())
        all.accused_clean += std::find(attacked.begin(), attacked.end(), id) == attacked.end() ? 1 : 0;
      for (const int id : attacked) all.cleared_attacked += s.sets.free.contains(id) ? 1 : 0;
      if (i == 0) continue;
      const double gap = truth(i - 1)[0] - truth(i)[0];
      all.least_gap = std::min(all.least_gap, gap);
      if (s.gap[0] > gap || std::abs(gap - gains_.formation.spacing) > s.gap[1]) ++all.gaps_violated;
    }
  }

  void expected(int agent, double* out) const override {
    garrison::Platoon::expected<2>(local(agent), gains_, state(agent), out);
  }
  double alarm_level(int agent) const override {
    return garrison::Platoon::alarm_level<2>(local(agent), gains_, state(agent));
  }

 private:
  int range() const { return gains_.setting.range; }
  std::size_t at(int i, int k) const { return static_cast<std::size_t>(model_.offset(i) + k); }
  Local local(int i) const { return {i, N(), 2, model_.outputs(i), 2 * range(), nullptr, nullptr}; }
  void init(int i, const Vec<2>& x0) {
    garrison::Platoon::init<2>(local(i), gains_, x0, states_[static_cast<std::size_t>(i)],
                               messages_[static_cast<std::size_t>(i)]);
  }

  Model model_;
  garrison::Platoon::Gains gains_;
  Rng rng_;
  std::unique_ptr<World> world_;
  std::vector<Attack> plans_;
  std::vector<std::unique_ptr<MeasurementAttack>> attacks_;
  std::vector<platoon::VehicleState> states_;
  std::vector<platoon::VehicleMessage> messages_;
  std::vector<bool> fresh_;  // replaced at this sample: sends nothing
  std::vector<double> y_;
};

}  // namespace garrison::test
