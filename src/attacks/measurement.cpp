// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/measurement.hpp"

#include <cmath>
#include <numbers>

namespace garrison {
namespace {

/// Where one number is: time, agent, and which of its outputs.
struct Spot {
  std::int64_t t;
  std::int64_t since;  // start of the attack phase
  int agent;
  int output;
};

/// An attack that changes each attacked number by itself: y <- change(y, spot, random, salt).
template <class Change>
class Pointwise final : public AttackPlan {
 public:
  Pointwise(Schedule schedule, Change change) : AttackPlan(std::move(schedule)), change_(std::move(change)) {}

  std::unique_ptr<MeasurementAttack> start(const Model& model, const Random& random,
                                           std::uint32_t salt) const override {
    schedule().require_agents_below(model.agents());
    return std::make_unique<Trial>(*this, model, random, salt);
  }

 private:
  struct Trial final : MeasurementAttack {
    Trial(const Pointwise& plan, const Model& model, const Random& random, std::uint32_t salt)
        : plan_(plan), model_(model), random_(random), salt_(salt) {}
    void apply(const Sample& s) override {
      const std::int64_t since = plan_.schedule().since(s.t);
      for (const int i : plan_.schedule().agents(s.t)) {
        if (!plan_.schedule().strikes(random_, s.t, i, salt_)) continue;
        for (int r = 0; r < model_.exposed(i); ++r) {
          double& y = s.y[static_cast<std::size_t>(model_.offset(i) + r)];
          y = plan_.change_(y, Spot{s.t, since, i, r}, random_, salt_);
        }
      }
    }
    const Pointwise& plan_;
    const Model& model_;
    Random random_;
    std::uint32_t salt_;
  };

  Change change_;
};

template <class Change>
Attack pointwise(Schedule schedule, Change change) {
  return std::make_shared<Pointwise<Change>>(std::move(schedule), std::move(change));
}

void require_finite(const char* which, double value) {
  if (!std::isfinite(value)) refuse(which, text(value), "a finite number");
}

std::uint32_t draw_index(std::uint32_t salt, int output, int draw) {
  return salt * 4096U + 2U * static_cast<std::uint32_t>(output) + static_cast<std::uint32_t>(draw);
}

double noise(const std::string& law, const Spot& at, const Random& random, std::uint32_t salt) {
  const auto agent = static_cast<std::uint32_t>(at.agent);
  if (law == "normal") return random.normal(at.t, agent, draw_index(salt, at.output, 0));
  const double u = random.uniform(at.t, agent, draw_index(salt, at.output, 1));
  if (law == "uniform") return 2.0 * u - 1.0;
  if (law == "cauchy") return std::tan(std::numbers::pi * (u - 0.5));
  return u < 0.5 ? std::log(std::max(2.0 * u, 0x1.0p-53)) : -std::log(std::max(2.0 - 2.0 * u, 0x1.0p-53));
}

}  // namespace

Attack bias(Schedule schedule, double value) {
  require_finite("bias.value", value);
  return pointwise(std::move(schedule),
                   [=](double y, const Spot&, const Random&, std::uint32_t) { return y + value; });
}

Attack scale(Schedule schedule, double factor) {
  require_finite("scale.factor", factor);
  return pointwise(std::move(schedule),
                   [=](double y, const Spot&, const Random&, std::uint32_t) { return y * factor; });
}

Attack constant(Schedule schedule, double value) {
  return pointwise(std::move(schedule),
                   [=](double, const Spot&, const Random&, std::uint32_t) { return value; });
}

Attack random_noise(Schedule schedule, const std::string& law, double size, bool replace) {
  if (law != "uniform" && law != "normal" && law != "laplace" && law != "cauchy")
    refuse("random.law", "\"" + law + "\"", "one of: uniform, normal, laplace, cauchy");
  if (!(size >= 0.0)) refuse("random.size", text(size), "a number >= 0");
  return pointwise(std::move(schedule),
                   [=](double y, const Spot& at, const Random& random, std::uint32_t salt) {
                     return (replace ? 0.0 : y) + size * noise(law, at, random, salt);
                   });
}

Attack denial(Schedule schedule) { return constant(std::move(schedule), kNaN); }

Attack ramp(Schedule schedule, double slope) {
  require_finite("ramp.slope", slope);
  return pointwise(std::move(schedule), [=](double y, const Spot& at, const Random&, std::uint32_t) {
    return y + slope * static_cast<double>(at.t - at.since + 1);
  });
}

Attack sinusoid(Schedule schedule, double amplitude, double period, double phase) {
  require_finite("sinusoid.amplitude", amplitude);
  if (!(period > 0.0)) refuse("sinusoid.period", text(period), "a number of samples > 0");
  return pointwise(std::move(schedule), [=](double y, const Spot& at, const Random&, std::uint32_t) {
    return y + amplitude *
                   std::sin(2.0 * std::numbers::pi * static_cast<double>(at.t - at.since) / period + phase);
  });
}

}  // namespace garrison
