// SPDX-License-Identifier: Apache-2.0
// The three controllers that the paper compares with and only names; definitions are ours,
// docs/filters/baselines.md#platoon-baseline.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "garrison/core/conditions.hpp"
#include "garrison/core/filter.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/world.hpp"
#include "garrison/filters/platoon/vehicle.hpp"
#include "garrison/filters/platoon/world.hpp"

namespace garrison {

/// Algorithm 3 on other signals. Estimates are uncertified.
/// - "pwm": measurements in place of all estimates.
/// - "ptd": the same, those of the neighbours one sample old and moved with the formation.
/// - "pbe": every vehicle corrects its own prediction with 1/varpi, and takes the entrywise mean of what all
/// in
///   range say of it, without the b largest and b smallest (fewer where too few are in range).
/// A measurement that is missing or not finite is replaced by the last good one (pwm, ptd) or not used (pbe).
struct GARRISON_EXPORT PlatoonBaseline {
  static constexpr std::string_view name = "platoon_baseline";
  static constexpr std::string_view title = "Unprotected and trimmed-mean control of a string of vehicles";
  static constexpr std::string_view source =
      "baselines PWM, PTD (Lin, Jia 2009), PBE (Mitra, Sundaram 2019) of the "
      "platoon paper; our definitions";
  static constexpr int first_sample = 0;
  static constexpr int only_states = 2;

  struct Params {
    std::string kind;
    int attacked = 1;
    double varpi = 2.0;
    std::vector<double> reference;
    double spacing = 20.0;
    double gs = kNaN;
    double gv = kNaN;
    double process_noise = 0.0;
    double measurement_noise = 0.0;

    static auto fields() {
      return std::make_tuple(
          field(&Params::kind, {.name = "kind",
                                .symbol = "",
                                .unit = "",
                                .doc = "which controller: pwm, ptd or pbe",
                                .required = true,
                                .choices = {"pwm", "pbe", "ptd"}}),
          field(&Params::attacked, {.name = "attacked",
                                    .symbol = "b",
                                    .unit = "sensors",
                                    .doc = "pbe: values trimmed from each end",
                                    .least = 0}),
          field(&Params::varpi, {.name = "varpi",
                                 .symbol = "varpi",
                                 .unit = "1",
                                 .doc = "pbe: 1/varpi is the gain of the local update",
                                 .least = 1.0}),
          field(&Params::reference,
                {.name = "reference",
                 .symbol = "x_0",
                 .unit = "m, m/s",
                 .doc = "position and velocity of the reference at time 0, or at times 0, 1, ...",
                 .required = true}),
          field(&Params::spacing,
                {.name = "spacing", .symbol = "Delta", .unit = "m", .doc = "desired gap between vehicles"}),
          field(&Params::gs, {.name = "gs",
                              .symbol = "g_s",
                              .unit = "1/s^2",
                              .doc = "controller gain on positions, > 0",
                              .required = true}),
          field(&Params::gv, {.name = "gv",
                              .symbol = "g_v",
                              .unit = "1/s",
                              .doc = "controller gain on velocities, > T g_s",
                              .required = true}),
          field(&Params::process_noise, {.name = "process_noise",
                                         .symbol = "eps",
                                         .unit = "m, m/s",
                                         .doc = "of the simulated vehicles",
                                         .least = 0.0}),
          field(&Params::measurement_noise, {.name = "measurement_noise",
                                             .symbol = "mu",
                                             .unit = "m, m/s",
                                             .doc = "of the simulated sensors",
                                             .least = 0.0}));
    }
  };

  enum class Kind : std::uint8_t { pwm, pbe, ptd };
  struct Gains {
    Kind kind = Kind::pwm;
    platoon::Shared shared;

    template <class V>
    void visit(V& v) {
      v.choice("kind", kind, 3);
      v("shared", shared);
    }
  };
  struct Driver : platoon::VehicleState {
    double heard[2][2] = {};  // y_jj(t-1) of the vehicles ahead and behind
    bool known[2] = {false, false};

    template <class V>
    void visit(V& v) {
      platoon::VehicleState::visit(v);
      v("heard", heard);
      v("known", known);
    }
  };
  template <int n>
  using State = Driver;
  template <int n>
  using Message = platoon::VehicleMessage;

  /// @throws InvalidInput
  static Gains design(const Params& params, const Model& model, const Network& network);
  /// Assumption 4 alone.
  static Check check(const Params& params, const Model& model, const Network& network);
  /// As Platoon::check_log. @throws InvalidInput
  static void check_log(const Gains&, const Model& model, std::span<const double> measurements) {
    platoon::check_inputs("platoon_baseline", model, measurements);
  }
  static std::unique_ptr<World> world(const Gains& gains, const WorldOptions& options);
  static int rounds(const Gains&) { return 1; }
  /// Of a design file: the gains have what this vehicle reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
    return platoon::fits(g.shared, l, neighbours);
  }

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    s = Driver{};
    platoon::start(l, g.shared, x0, s, m);
  }
  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t t,
                    Message<n>& m) noexcept {
    sense_one(l, g, s, y, t, m);
  }
  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>&) noexcept {
    fuse_one(l, g, s, inbox);
  }
  /// Where the measurements of the sample see the vehicle; nothing else is remembered for long.
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t t,
                     State<n>& s) noexcept {
    platoon::rejoin(l, g.shared, s, inbox, t);
  }
  template <int n>
  static Report report(const Local&, const Gains&, const State<n>& s) noexcept {
    Report r;
    r.verdict = s.has_y ? Verdict::not_tested : Verdict::silent;
    return r;
  }
  template <int n>
  static const Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  template <int n>
  static void accused_into(const State<n>&, AgentSet&) noexcept {}
  template <int n>
  static double control(const State<n>& s) noexcept {
    return s.u;
  }
  template <int n>
  static void expected(const Local& l, const Gains& g, const State<n>& s, double* out) noexcept {
    for (int r = 0; r < l.outputs; ++r) out[r] = kNaN;
    out[0] = s.x[0] + g.shared.setting.period * s.x[1];
    out[1] = s.x[1] + g.shared.setting.period * s.u;
  }
  template <int n>
  static double alarm_level(const Local&, const Gains&, const State<n>&) noexcept {
    return std::numeric_limits<double>::infinity();
  }
  static constexpr std::size_t signal_count = 1;
  static std::vector<std::string> signal_names() { return {"control"}; }
  template <int n>
  static void signals(const Local&, const Gains&, const State<n>& s, double* out) noexcept {
    out[0] = s.u;
  }

 private:
  static void sense_one(const Local& l, const Gains& g, Driver& s, const double* y, std::int64_t t,
                        platoon::VehicleMessage& m) noexcept;
  static void fuse_one(const Local& l, const Gains& g, Driver& s,
                       const Inbox<platoon::VehicleMessage>& inbox) noexcept;
};

}  // namespace garrison
