// SPDX-License-Identifier: Apache-2.0
// The vehicles themselves: (1)-(3), and where their measurements stand in y.
#pragma once

#include <memory>
#include <span>

#include "garrison/core/model.hpp"
#include "garrison/core/world.hpp"
#include "garrison/filters/platoon/formation.hpp"

namespace garrison::platoon {

/// Outputs of vehicle i in this order: absolute position and velocity y_ii (attackable), then for all but
/// vehicle 0 the relative ones y_{i-1,i} = x_i - x_{i-1} (secured), then, in models of recorded data with
/// inputs, the input u_i(t) that was applied from t on (secured; NaN = what the filter commanded).
struct Outputs {
  bool relative;
  bool input;
  static Outputs of(int id, int outputs) noexcept {
    const int least = id > 0 ? 4 : 2;
    return {id > 0, outputs > least};
  }
  int at_input() const noexcept { return relative ? 4 : 2; }
};

/// The model of N vehicles with these outputs; C_i holds the rows as far as they depend on x_i alone.
/// @throws InvalidInput when vehicles < 3 or period is not > 0
GARRISON_EXPORT Model model(int vehicles, double period, bool inputs = false);
/// T of such a model. @throws InvalidInput when it is not one
double period_of(const Model& model);

/// Refuses recordings from which `owner`, a filter that counts on its own commands, cannot tell what the
/// vehicles did: without inputs, or with gaps in them. @throws InvalidInput
GARRISON_EXPORT void check_inputs(const char* owner, const Model& model,
                                  std::span<const double> measurements);

/// Columns per vehicle of recorded disturbances, vehicle by vehicle: d_i (2), n_ii (2), w_i, n_{i-1,i} (2).
/// The absolute sensor shows (1 + w_i) x_i + n_ii; what stands for vehicle 0's relative sensor is not read.
inline constexpr int kDisturbances = 7;

/// Noise laws: "uniform" in the balls of radius eps and mu, "extreme" on their surface, "one_sided" (as
/// printed in section 7 of the paper: every component uniform in (0, bound/sqrt 2)), "none", and "auto" =
/// uniform. x0 left out: everybody on the spot. Refuses a start further than q from the truth, because the
/// bounds and the detector rest on it. @throws InvalidInput
std::unique_ptr<World> make_world(const Setting& setting, const Formation& formation,
                                  const WorldOptions& options);

}  // namespace garrison::platoon
