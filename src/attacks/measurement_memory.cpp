// SPDX-License-Identifier: Apache-2.0
// Attacks that remember the past or watch the filter.
#include <algorithm>
#include <cmath>
#include <utility>

#include "garrison/attacks/measurement.hpp"

namespace garrison {
namespace {

/// A plan whose trials are of class Trial, built from the plan's own settings.
template <class Settings, class Trial, bool closed>
class Plan final : public AttackPlan {
 public:
  Plan(Schedule schedule, Settings settings)
      : AttackPlan(std::move(schedule)), settings_(std::move(settings)) {}
  bool closed_loop() const override { return closed; }
  std::unique_ptr<MeasurementAttack> start(const Model& model, const Random& random,
                                           std::uint32_t salt) const override {
    schedule().require_agents_below(model.agents());
    return std::make_unique<Trial>(schedule(), settings_, model, random, salt);
  }

 private:
  Settings settings_;
};

/// What every trial below starts from, and the walk over the numbers under attack.
template <class Settings>
class Stateful : public MeasurementAttack {
 public:
  Stateful(const Schedule& schedule, const Settings& settings, const Model& model, const Random& random,
           std::uint32_t salt)
      : schedule_(schedule), settings_(settings), model_(model), random_(random), salt_(salt) {}

 protected:
  template <class Change>
  void each(std::int64_t t, const Change& change) const {
    for (const int i : schedule_.agents(t))
      if (schedule_.strikes(random_, t, i, salt_))
        for (int r = 0; r < model_.exposed(i); ++r)
          change(i, r, static_cast<std::size_t>(model_.offset(i) + r));
  }

  const Schedule& schedule_;
  const Settings& settings_;
  const Model& model_;
  Random random_;
  std::uint32_t salt_;
};

struct Delay {
  int samples;
};
class Replayed final : public Stateful<Delay> {
 public:
  Replayed(const Schedule& schedule, const Delay& delay, const Model& model, const Random& random,
           std::uint32_t salt)
      : Stateful(schedule, delay, model, random, salt), past_(room(delay, model)) {}
  void apply(const Sample& s) override {
    const auto row = static_cast<std::size_t>(model_.total_outputs());
    const auto slot = static_cast<std::size_t>(seen_ % settings_.samples);
    double* oldest = past_.data() + (seen_ < settings_.samples ? 0 : slot * row);
    present_.assign(s.y.begin(), s.y.end());
    if (seen_ > 0) each(s.t, [&](int, int, std::size_t k) { s.y[k] = oldest[k]; });
    std::copy(present_.begin(), present_.end(), past_.data() + slot * row);
    ++seen_;
  }

 private:
  static std::size_t room(const Delay& delay, const Model& model) {
    const auto samples = static_cast<std::size_t>(delay.samples);
    const auto numbers = samples * static_cast<std::size_t>(model.total_outputs());
    require_memory("replay.delay", std::to_string(delay.samples), 8.0 * static_cast<double>(numbers));
    return numbers;
  }
  std::vector<double> past_;
  std::vector<double> present_;
  std::int64_t seen_ = 0;
};

struct Recursion {
  double coefficient;
  double size;
};
class Autoregressive final : public Stateful<Recursion> {
 public:
  Autoregressive(const Schedule& schedule, const Recursion& recursion, const Model& model,
                 const Random& random, std::uint32_t salt)
      : Stateful(schedule, recursion, model, random, salt), a_(Vector::Zero(model.total_outputs())) {}
  void apply(const Sample& s) override {
    each(s.t, [&](int i, int r, std::size_t k) {
      double& a = a_(static_cast<Eigen::Index>(k));
      const auto index = salt_ * 4096U + static_cast<std::uint32_t>(r);
      a = settings_.coefficient * a +
          settings_.size * random_.normal(s.t, static_cast<std::uint32_t>(i), index);
      s.y[k] += a;
    });
  }

 private:
  Vector a_;
};

struct Story {
  Vector offset;
  Vector push;
};
class FalseTrajectory final : public Stateful<Story> {
 public:
  FalseTrajectory(const Schedule& schedule, const Story& story, const Model& model, const Random& random,
                  std::uint32_t salt)
      : Stateful(schedule, story, model, random, salt), next_(model.states()) {
    const auto n = model.states();
    if (story.offset.size() != n)
      refuse("false_trajectory.offset", amount(story.offset.size(), "number"),
             std::to_string(n) + ", one per state");
    if (story.push.size() != 0 && story.push.size() != n)
      refuse("false_trajectory.push", amount(story.push.size(), "number"),
             "none or " + std::to_string(n) + ", one per state");
  }
  void apply(const Sample& s) override {
    if (schedule_.agents(s.t).empty()) return;
    if (d_.size() == 0) {
      d_ = settings_.offset;
    } else {
      next_.noalias() = model_.A() * d_;
      d_.swap(next_);
      if (settings_.push.size() != 0) d_ += settings_.push;
    }
    each(s.t, [&](int i, int r, std::size_t k) { s.y[k] += model_.C(i).row(r).dot(d_); });
  }

 private:
  Vector d_;
  Vector next_;
};

struct Margin {
  double fraction;
};
class Stealthy final : public Stateful<Margin> {
 public:
  Stealthy(const Schedule& schedule, const Margin& margin, const Model& model, const Random& random,
           std::uint32_t salt)
      : Stateful(schedule, margin, model, random, salt),
        expected_(static_cast<std::size_t>(model.total_outputs())) {}
  void apply(const Sample& s) override {
    each(s.t, [&](int i, int r, std::size_t k) {
      if (r == 0) s.victims.expected(i, expected_.data() + k);
      const double level = s.victims.alarm_level(i);
      if (std::isfinite(level)) s.y[k] = expected_[k] + settings_.fraction * level;
    });
  }

 private:
  std::vector<double> expected_;
};

}  // namespace

Attack replayed(Schedule schedule, int delay) {
  if (delay < 1) refuse("replay.delay", std::to_string(delay), "a whole number of samples >= 1");
  return std::make_shared<Plan<Delay, Replayed, false>>(std::move(schedule), Delay{delay});
}

Attack autoregressive(Schedule schedule, double coefficient, double size) {
  if (!std::isfinite(coefficient)) refuse("autoregressive.coefficient", text(coefficient), "a finite number");
  if (!(size >= 0.0)) refuse("autoregressive.size", text(size), "a number >= 0");
  return std::make_shared<Plan<Recursion, Autoregressive, false>>(std::move(schedule),
                                                                  Recursion{coefficient, size});
}

Attack false_trajectory(Schedule schedule, Vector offset, Vector push) {
  if (!offset.allFinite()) refuse("false_trajectory.offset", "a number that is not finite", "finite numbers");
  if (!push.allFinite()) refuse("false_trajectory.push", "a number that is not finite", "finite numbers");
  return std::make_shared<Plan<Story, FalseTrajectory, false>>(std::move(schedule),
                                                               Story{std::move(offset), std::move(push)});
}

Attack stealthy(Schedule schedule, double fraction) {
  if (!std::isfinite(fraction)) refuse("stealthy.fraction", text(fraction), "a finite number");
  return std::make_shared<Plan<Margin, Stealthy, true>>(std::move(schedule), Margin{fraction});
}

}  // namespace garrison
