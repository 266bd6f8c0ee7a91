// SPDX-License-Identifier: Apache-2.0
// Which region an agent keeps and passes on (R).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "agent_certifier.hpp"

namespace garrison::certificate {

double AgentCertifier::aged(double radius, int age) const {
  const auto k = static_cast<std::size_t>(age);
  return age == 0 ? radius : plan_->norm[k] * radius + plan_->added[k];
}

/// Whether a region may be used where one of age `fresh` was to be had: with Gaussian noise, choosing among
/// all ages by looking at the data would cost failure probability without end.
bool AgentCertifier::eligible(int age, int fresh) const {
  return plan_->deterministic() || age <= fresh + kChoice;
}

/// Whether a ball is smaller than the own one. No two balls are alike: what an agent ends with does not
/// depend on the way by which they came.
bool AgentCertifier::goes_before(const double* center, double radius, int age) const {
  const auto given = std::tuple(aged(radius, age), age, radius);
  const auto own = std::tuple(aged(memory_.ball_radius, memory_.age), memory_.age, memory_.ball_radius);
  if (given != own) return given < own;
  return std::lexicographical_compare(center, center + memory_.ball.size(), memory_.ball.begin(),
                                      memory_.ball.end());
}

/// Takes over a ball that is better than the own one.
void AgentCertifier::offer(const double* center, double radius, int age, int fresh) noexcept {
  if (memory_.age < 0 || fresh < memory_.fresh) region_since_ = next_round_;
  if (memory_.age >= 0) {
    memory_.fresh = std::min(memory_.fresh, fresh);
    if (!eligible(age, memory_.fresh)) return;
    if (eligible(memory_.age, memory_.fresh) && !goes_before(center, radius, age)) return;
  } else {
    memory_.fresh = fresh;
  }
  std::copy_n(center, memory_.ball.size(), memory_.ball.begin());
  memory_.ball_radius = radius;
  memory_.age = age;
}
void AgentCertifier::hear_relayed(const AgentCertifier& other) noexcept {
  const Memory& m = other.memory_;
  if (m.age >= 0) offer(m.ball.data(), m.ball_radius, m.age, m.fresh);
}
bool AgentCertifier::relays_the_same(const AgentCertifier& other) const {
  const Memory& m = memory_;
  const Memory& o = other.memory_;
  return m.age == o.age && m.fresh == o.fresh && m.ball_radius == o.ball_radius && m.ball == o.ball;
}
bool AgentCertifier::found_the_same(const AgentCertifier& other) const {
  const Memory& m = memory_;
  const Memory& o = other.memory_;
  return std::memcmp(&m.radius, &o.radius, sizeof(double)) == 0 && m.center == o.center && m.box == o.box;
}
void AgentCertifier::copy_relayed(const AgentCertifier& other) noexcept {
  memory_.ball = other.memory_.ball;
  memory_.ball_radius = other.memory_.ball_radius;
  memory_.age = other.memory_.age;
  memory_.fresh = other.memory_.fresh;
}

void AgentCertifier::relay_own() noexcept {
  if (std::isfinite(memory_.radius)) offer(memory_.center.data(), memory_.radius, 0, 0);
}

}  // namespace garrison::certificate
