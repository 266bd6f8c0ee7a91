// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/platoon/world.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "garrison/core/params.hpp"
#include "garrison/core/random.hpp"
#include "garrison/filters/platoon/detector.hpp"

namespace garrison::platoon {
namespace {

enum class Law { none, uniform, extreme, one_sided };

Law law_of(const std::string& name) {
  if (name == "uniform" || name == "auto") return Law::uniform;
  if (name == "extreme") return Law::extreme;
  if (name == "one_sided") return Law::one_sided;
  if (name != "none")
    refuse_unknown("noise", name,
                   std::vector<std::string>{"auto", "uniform", "extreme", "one_sided", "none"});
  return Law::none;
}

/// A vector in the ellipse whose half axes are the bounds on its entries; a hair below them, so that rounding
/// cannot break the assumption.
void draw(Law law, const Random& random, std::int64_t t, std::uint32_t key, const Bound& bound, double* out) {
  const double u = random.uniform(t, key, 0);
  const double w = random.uniform(t, key, 1);
  const double most[2] = {bound.position * (1.0 - 1e-12), bound.velocity * (1.0 - 1e-12)};
  const double angle = 2.0 * std::numbers::pi * w;
  for (int k = 0; k < 2; ++k) {
    if (law == Law::none)
      out[k] = 0.0;
    else if (law == Law::one_sided)
      out[k] = most[k] * (k == 0 ? u : w) * std::numbers::sqrt2 / 2.0;
    else
      out[k] = (law == Law::extreme ? most[k] : most[k] * std::sqrt(u)) *
               (k == 0 ? std::cos(angle) : std::sin(angle));
  }
}

class Vehicles final : public World {
 public:
  Vehicles(const Setting& s, const Formation& f, const WorldOptions& o)
      : setting_(s),
        law_(law_of(o.noise)),
        recorded_(o.disturbances),
        process_(o.seed, o.trial, Purpose::process),
        measurement_(o.seed, o.trial, Purpose::measurement),
        x_(2 * static_cast<std::size_t>(s.vehicles)),
        start_(o.start) {
    require_recorded();
    const Random random(o.seed, o.trial, Purpose::start);
    for (int i = 0; i < s.vehicles; ++i) {
      const Motion spot = f.desired(i, 0);
      double* x = state(i);
      x[0] = o.x0.size() == 0 ? spot.s : o.x0(2 * i);
      x[1] = o.x0.size() == 0 ? spot.v : o.x0(2 * i + 1);
      double shift[2];
      draw(o.start_error > 0.0 ? Law::uniform : Law::none, random, 0, key(i, 0),
           {o.start_error, o.start_error, o.start_error}, shift);
      start_(0, i) += shift[0];
      start_(1, i) += shift[1];
      const double error = length(start_(0, i) - x[0], start_(1, i) - x[1]);
      if (error > s.q * (1.0 + 1e-9))
        refuse("start",
               "an initial estimate of vehicle " + std::to_string(i) + " that is off by " + text(error),
               "at most initial_error = " + text(s.q), "bounds and detector rest on it");
    }
  }

  const Matrix& start() const override { return start_; }
  std::span<const double> truth() const override { return x_; }

  void next(std::int64_t t, std::span<const double> control, std::span<double> y) override {
    const double T = setting_.period;
    if (t > 0) {
      for (int i = 0; i < setting_.vehicles; ++i) {
        double d[2];
        disturb(t - 1, i, 0, process_, {setting_.eps, setting_.eps, setting_.eps}, d);
        double* x = state(i);
        x[0] += T * x[1] + d[0];
        x[1] += T * control[static_cast<std::size_t>(i)] + d[1];
      }
    }
    std::size_t at = 0;
    for (int i = 0; i < setting_.vehicles; ++i) {
      const double* x = state(i);
      const double* ahead = i > 0 ? state(i - 1) : x;
      const double w = recorded_ == nullptr ? 0.0 : (*recorded_)(t, kDisturbances * i + 4);
      double n[2];
      disturb(t, i, 2, measurement_, absolute_noise(setting_), n);
      for (int k = 0; k < 2; ++k) y[at++] = x[k] + n[k] + w * x[k];
      if (i > 0) {
        disturb(t, i, 5, measurement_, relative_noise(setting_), n);
        for (int k = 0; k < 2; ++k) y[at++] = x[k] - ahead[k] + n[k];
      }
      if (y.size() > 4 * static_cast<std::size_t>(setting_.vehicles)) y[at++] = kNaN;
    }
  }

 private:
  double* state(int i) { return x_.data() + 2 * i; }
  static std::uint32_t key(int vehicle, int column) {
    return 8U * static_cast<std::uint32_t>(vehicle) + static_cast<std::uint32_t>(column);
  }
  /// Two of a vehicle's disturbances, beginning with `column`.
  void disturb(std::int64_t t, int vehicle, int column, const Random& random, const Bound& bound,
               double* out) const {
    if (recorded_ == nullptr) return draw(law_, random, t, key(vehicle, column), bound, out);
    for (int k = 0; k < 2; ++k) out[k] = (*recorded_)(t, kDisturbances * vehicle + column + k);
  }
  void require_recorded() const {
    if (recorded_ != nullptr && recorded_->cols() != kDisturbances * setting_.vehicles)
      refuse("noise", amount(recorded_->cols(), "column") + " of recorded disturbances",
             std::to_string(kDisturbances * setting_.vehicles) + ", " + std::to_string(kDisturbances) +
                 " per vehicle");
    for (int i = 0; recorded_ != nullptr && i < setting_.vehicles; ++i)
      if (!recorded_->middleCols(kDisturbances * i, 2).allFinite())
        refuse("noise", "process noise (d) of vehicle " + std::to_string(i) + " that is not finite",
               "finite numbers", "only sensors may show what is not");
  }

  Setting setting_;
  Law law_;
  const Matrix* recorded_;
  Random process_;
  Random measurement_;
  std::vector<double> x_;
  Matrix start_;
};

}  // namespace

Model model(int vehicles, double period, bool inputs) {
  if (vehicles < 3) refuse("vehicles (N)", std::to_string(vehicles), "at least 3");
  require_memory("vehicles (N)", std::to_string(vehicles), 300.0 * vehicles);  // C_i and what belongs to it
  if (!(period > 0.0) || !std::isfinite(period)) refuse("period (T)", text(period), "a finite number > 0");
  Matrix A(2, 2);
  A << 1.0, period, 0.0, 1.0;
  std::vector<Matrix> C;
  for (int i = 0; i < vehicles; ++i) {
    Matrix rows = Matrix::Zero((i > 0 ? 4 : 2) + (inputs ? 1 : 0), 2);
    rows.topRows(2).setIdentity();
    if (i > 0) rows.middleRows(2, 2).setIdentity();
    C.push_back(std::move(rows));
  }
  return {std::move(A), std::move(C), {}, std::vector<int>(static_cast<std::size_t>(vehicles), 2)};
}

double period_of(const Model& m) {
  const char* const advice = "platoon.model(vehicles, period) makes it";
  if (m.states() != 2) refuse("model", amount(m.states(), "state"), "position and velocity", advice);
  const double T = m.A()(0, 1);
  if (m.A()(0, 0) != 1.0 || m.A()(1, 0) != 0.0 || m.A()(1, 1) != 1.0 || !(T > 0.0))
    refuse("A", "another matrix", "(1 T; 0 1) with T > 0", advice);
  for (int i = 0; i < m.agents(); ++i) {
    const int rows = m.outputs(i) - (i > 0 ? 4 : 2);
    if (rows < 0 || rows > 1 || rows != m.outputs(0) - 2)
      refuse("C[" + std::to_string(i) + "]", amount(m.outputs(i), "row"),
             i > 0 ? "2 absolute, 2 relative measurements (and the input, for all vehicles or none)"
                   : "2 absolute measurements (and the input, for all vehicles or none)",
             advice);
  }
  return T;
}

std::unique_ptr<World> make_world(const Setting& setting, const Formation& formation,
                                  const WorldOptions& options) {
  return std::make_unique<Vehicles>(setting, formation, options);
}

}  // namespace garrison::platoon
