// SPDX-License-Identifier: Apache-2.0
// Attacks on measurements, usable with every filter and composable in a list.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/attacks/schedule.hpp"
#include "garrison/core/model.hpp"

namespace garrison {

/// What an informed attacker may read: what each agent will predict and tolerate at the coming sample.
/// Threads: one at a time.
class GARRISON_EXPORT Victims {
 public:
  virtual ~Victims() = default;
  virtual void expected(int agent, double* out) const = 0;
  virtual double alarm_level(int agent) const = 0;
};

/// One sample on its way from the sensors to the filters.
struct Sample {
  std::int64_t t;
  std::span<double> y;  ///< all measurements, flat by agent; attacks rewrite it in place
  const Victims& victims;
};

/// A measurement attack in one trial: may keep state from sample to sample.
/// Threads: one at a time.
class GARRISON_EXPORT MeasurementAttack {
 public:
  virtual ~MeasurementAttack() = default;
  /// Called for every sample in order of time, also before the start (a recorder must see those).
  virtual void apply(const Sample& sample) = 0;
};

/// A recipe: immutable, shared by all trials.
/// Threads: constant once made; any number may share it.
class GARRISON_EXPORT AttackPlan {
 public:
  explicit AttackPlan(Schedule schedule) : schedule_(std::move(schedule)) {}
  virtual ~AttackPlan() = default;
  const Schedule& schedule() const { return schedule_; }
  /// Needs Victims: the attack depends on what the filter does, so trials cannot share a step.
  virtual bool closed_loop() const { return false; }
  /// The attack of one trial. `salt` tells attacks of one list apart.
  virtual std::unique_ptr<MeasurementAttack> start(const Model& model, const Random& random,
                                                   std::uint32_t salt) const = 0;

 private:
  Schedule schedule_;
};

using Attack = std::shared_ptr<const AttackPlan>;

/// y + value.
GARRISON_EXPORT Attack bias(Schedule schedule, double value);
/// y * factor (the paper's a_i = 2 (C_i x + v_i) is factor 3).
GARRISON_EXPORT Attack scale(Schedule schedule, double factor);
/// y = value, which may be nan, inf or 1e300.
GARRISON_EXPORT Attack constant(Schedule schedule, double value);
/// y + noise. law: "uniform" in [-size, size], "normal", "laplace" or "cauchy" with scale `size`; `replace`
/// drops y.
GARRISON_EXPORT Attack random_noise(Schedule schedule, const std::string& law, double size, bool replace);
/// The measurement is lost (NaN).
GARRISON_EXPORT Attack denial(Schedule schedule);
/// y(t - delay), recorded before the attack; the first sample while there is none that old. delay >= 1.
GARRISON_EXPORT Attack replayed(Schedule schedule, int delay);
/// y + slope * (t - start + 1).
GARRISON_EXPORT Attack ramp(Schedule schedule, double slope);
/// y + amplitude * sin(2 pi (t - start) / period + phase); period > 0 in samples, phase in radians.
GARRISON_EXPORT Attack sinusoid(Schedule schedule, double amplitude, double period, double phase);
/// y + a(t), a(t) = coefficient a(t-1) + size * normal noise, a = 0 before the start.
GARRISON_EXPORT Attack autoregressive(Schedule schedule, double coefficient, double size);
/// y_i + C_i d(t) with d(start) = offset, d(t+1) = A d(t) + push: all attacked sensors tell one story that
/// the plant could have produced. offset, push: n numbers (push may be empty = 0).
GARRISON_EXPORT Attack false_trajectory(Schedule schedule, Vector offset, Vector push);
/// y = what the agent expects + fraction * the deviation it tolerates: stealthy for |fraction| < 1.
GARRISON_EXPORT Attack stealthy(Schedule schedule, double fraction);

}  // namespace garrison
