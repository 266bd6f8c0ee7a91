// SPDX-License-Identifier: Apache-2.0
// Observer, attack detector and controller of a string of vehicles (He, Hashemi, Johansson, Automatica 2021).
//
// Every vehicle measures its own state with a sensor that may be attacked, and the difference to the vehicle
// ahead with a secured one. One sample t >= 1 of vehicle i, everything from the values of t-1:
//   predict      xbar_i = A xhat_i(t-1) + (0, T u_i(t-1))                                          (15)
//   send         y_ii, y_{i-1,i}, xbar_i, its three sets and error bound to those at most L places away  (6)
//   detect       unite the sets, tests (27), (28), count (29)                                 [Algorithm 2]
//   observe      saturated innovations of all in range, or the best neighbour's prediction (12)-(14)  [1]
//   bound        alpha_i(t) from alpha_i(t-1) and what is known of the sensors                 (17)-(19)
//   steer        u_i(t)                                                                       [Algorithm 3]
// At t = 0 estimates are exchanged and u_i(0) follows; nothing is measured.
//
// Where we leave the print: the bound of vehicles that hear 2L others is the valid
// one (the published (17) is false), (28) compares with xbar_i(t), runs in (29) are maximal. Missing
// measurements and lost messages have gain 0 and the bound counts without them. A vehicle that has just
// (re)started takes the median of what all sensors in range say of it (S3), or its best source, or what they
// leave possible, and has a bound again from then on; while it is lost it follows the vehicle ahead by its
// secured sensor. Where too few are heard against those who may lie the prediction stands. A vehicle that
// lies in its messages is outside all of this: it can have anybody isolated by forging `attacked`, and its
// prediction steers its neighbours; drivers drop bounds when that is simulated. A vehicle whose data
// contradict the assumptions (more than b attackers, a sensor both attacked and free) says so in the signal
// `trouble` and from then on reports no bound and accuses nobody; the run says which assumptions can be
// false.
#pragma once

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

namespace garrison {

struct GARRISON_EXPORT Platoon {
  static constexpr std::string_view name = "platoon";
  static constexpr std::string_view title = "Observer, detector and controller of a string of vehicles";
  static constexpr std::string_view source = "He, Hashemi, Johansson, Automatica 2021, Algorithms 1, 2 and 3";
  static constexpr int first_sample = 0;
  static constexpr int only_states = 2;

  struct Params {
    double threshold = kNaN;
    bool adaptive = true;
    int attacked = 1;
    double process_noise = kNaN;
    double measurement_noise = kNaN;
    double absolute_position_noise = kNaN;
    double absolute_velocity_noise = kNaN;
    double relative_position_noise = kNaN;
    double relative_velocity_noise = kNaN;
    double initial_error = kNaN;
    double varpi = 2.0;
    std::vector<double> reference;
    double spacing = 20.0;
    double gs = kNaN;
    double gv = kNaN;
    double input_bound = kNaN;
    bool detector = true;
    std::string bound = "safe";
    std::string tie = "low";
    std::string count = "runs";
    bool pairs = false;
    bool neighbours = false;
    bool median = false;
    bool accuse_missing = false;
    std::vector<double> prior_attacked;
    std::vector<double> prior_suspected;
    std::vector<double> prior_free;

    static auto fields() {
      return std::make_tuple(
          field(&Params::threshold,
                {.name = "threshold",
                 .symbol = "beta",
                 .unit = "m, m/s",
                 .doc = "saturation threshold: beta_{i,0} of (25), or the static one; left out: the one with "
                        "the least certified limit under the adaptive threshold",
                 .least = 0.0,
                 .open = true}),
          field(&Params::adaptive, {.name = "adaptive",
                                    .symbol = "",
                                    .unit = "",
                                    .doc = "the threshold follows the error bound (25); false: static"}),
          field(&Params::attacked, {.name = "attacked",
                                    .symbol = "b",
                                    .unit = "sensors",
                                    .doc = "most absolute sensors attacked, 1..L"}),
          field(&Params::process_noise, {.name = "process_noise",
                                         .symbol = "eps",
                                         .unit = "m, m/s",
                                         .doc = "bound on the process noise of a vehicle per sample",
                                         .required = true,
                                         .least = 0.0}),
          field(&Params::measurement_noise, {.name = "measurement_noise",
                                             .symbol = "mu",
                                             .unit = "m, m/s",
                                             .doc = "length of the noise vector of every absolute and "
                                                    "relative sensor is at most mu; may be left "
                                                    "out when the four bounds on entries are given",
                                             .least = 0.0}),
          field(&Params::absolute_position_noise,
                {.name = "absolute_position_noise",
                 .symbol = "",
                 .unit = "m",
                 .doc = "bound on the noise of the absolute sensors' position; left out: measurement_noise",
                 .least = 0.0}),
          field(&Params::absolute_velocity_noise, {.name = "absolute_velocity_noise",
                                                   .symbol = "",
                                                   .unit = "m/s",
                                                   .doc = "the same for their velocity",
                                                   .least = 0.0}),
          field(&Params::relative_position_noise,
                {.name = "relative_position_noise",
                 .symbol = "",
                 .unit = "m",
                 .doc = "bound on the noise of the relative sensors' position; left out: measurement_noise",
                 .least = 0.0}),
          field(&Params::relative_velocity_noise, {.name = "relative_velocity_noise",
                                                   .symbol = "",
                                                   .unit = "m/s",
                                                   .doc = "the same for their velocity",
                                                   .least = 0.0}),
          field(&Params::initial_error, {.name = "initial_error",
                                         .symbol = "q",
                                         .unit = "m, m/s",
                                         .doc = "bound on the error of the first estimate",
                                         .required = true,
                                         .least = 0.0,
                                         .open = true}),
          field(&Params::varpi,
                {.name = "varpi",
                 .symbol = "varpi",
                 .unit = "1",
                 .doc = "1/varpi is the observer gain of vehicles that hear fewer than 2L others",
                 .least = 1.0,
                 .open = true}),
          field(
              &Params::reference,
              {.name = "reference",
               .symbol = "x_0",
               .unit = "m, m/s",
               .doc = "position and velocity of the reference at time 0, or at times 0, 1, ...; constant "
                      "velocity after the last pair. Without reference, gs and gv the filter only observes"}),
          field(&Params::spacing,
                {.name = "spacing", .symbol = "Delta", .unit = "m", .doc = "desired gap between vehicles"}),
          field(&Params::gs,
                {.name = "gs", .symbol = "g_s", .unit = "1/s^2", .doc = "controller gain on positions, > 0"}),
          field(&Params::gv, {.name = "gv",
                              .symbol = "g_v",
                              .unit = "1/s",
                              .doc = "controller gain on velocities, > T g_s"}),
          field(&Params::input_bound, {.name = "input_bound",
                                       .symbol = "",
                                       .unit = "m/s^2",
                                       .doc = "|u_i(t)| <= input_bound where inputs are not recorded, for a "
                                              "filter that only observes (no "
                                              "reference, gs and gv): T input_bound enters eps",
                                       .least = 0.0}),
          field(&Params::detector, {.name = "detector",
                                    .symbol = "",
                                    .unit = "",
                                    .doc = "Algorithm 2; false: the sets stay as given"}),
          field(
              &Params::bound,
              {.name = "bound",
               .symbol = "",
               .unit = "",
               .doc =
                   "\"safe\" (valid), \"tight\" (valid, smaller, more work) or \"printed\": (17) as printed, "
                   "which is false (counterexamples: cases process_noise_counterexample and "
                   "lemma1_counterexample) and is therefore never reported as a bound",
               .choices = {"safe", "tight", "printed"}}),
          field(&Params::tie, {.name = "tie",
                               .symbol = "",
                               .unit = "",
                               .doc = "(13), two sources equally near: lower label or smaller error bound",
                               .choices = {"low", "bound"}}),
          field(&Params::count, {.name = "count",
                                 .symbol = "",
                                 .unit = "",
                                 .doc = "(29): \"runs\" of suspects as printed, or \"cover\": send the pairs "
                                        "that fired and count the "
                                        "least number of sensors that explains them; never weaker",
                                 .choices = {"runs", "cover"}}),
          field(&Params::pairs,
                {.name = "pairs",
                 .symbol = "",
                 .unit = "",
                 .doc = "test (27) for all pairs in range and conclude from all explanations by at "
                        "most b attackers (not in the paper)"}),
          field(&Params::neighbours,
                {.name = "neighbours",
                 .symbol = "",
                 .unit = "",
                 .doc = "test (28) for the measurements of all neighbours (not in the paper)"}),
          field(&Params::median, {.name = "median",
                                  .symbol = "",
                                  .unit = "",
                                  .doc = "take the median of the reconstructed measurements where its bound "
                                         "is smaller (not in the paper)"}),
          field(&Params::accuse_missing,
                {.name = "accuse_missing",
                 .symbol = "",
                 .unit = "",
                 .doc = "a missing (NaN) absolute measurement counts as proof of attack"}),
          field(&Params::prior_attacked,
                {.name = "prior_attacked",
                 .symbol = "",
                 .unit = "",
                 .doc = "known before the start: pairs vehicle, sensor proved attacked"}),
          field(
              &Params::prior_suspected,
              {.name = "prior_suspected", .symbol = "", .unit = "", .doc = "the same for suspected sensors"}),
          field(&Params::prior_free, {.name = "prior_free",
                                      .symbol = "",
                                      .unit = "",
                                      .doc = "the same for sensors that are known to be free"}));
    }
  };

  using Gains = platoon::Shared;
  template <int n>
  using State = platoon::VehicleState;
  template <int n>
  using Message = platoon::VehicleMessage;

  /// `model` from platoon::model, `network` from Network::band. @throws InvalidInput
  static Gains design(const Params& params, const Model& model, const Network& network);
  /// Admissible thresholds, theorems 1, 2 and 4, Assumption 4.
  static Check check(const Params& params, const Model& model, const Network& network);
  /// Refuses recordings of vehicles whose inputs are neither recorded nor bounded: the filter would take what
  /// it commands itself for what they did. A column of inputs that are all NaN says that they did.
  /// @throws InvalidInput
  static void check_log(const Gains& gains, const Model& model, std::span<const double> measurements);
  /// What `refuted` means, and which assumptions can be false.
  static std::vector<std::string> refuted_words(unsigned bits);
  static std::unique_ptr<World> world(const Gains& gains, const WorldOptions& options);
  static int rounds(const Gains&) { return 1; }
  /// Of a design file: the gains have what this vehicle reads.
  static bool fits(const Gains& g, const Local& l, std::span<const int> neighbours) noexcept {
    return platoon::fits(g, l, neighbours);
  }

  template <int n>
  static void init(const Local& l, const Gains& g, const Vec<n>& x0, State<n>& s, Message<n>& m) {
    platoon::start(l, g, x0, s, m);
  }
  template <int n>
  static void sense(const Local& l, const Gains& g, State<n>& s, const double* y, std::int64_t t,
                    Message<n>& m) noexcept {
    platoon::sense(l, g, s, y, t, m);
  }
  template <int n>
  static void fuse(const Local& l, const Gains& g, State<n>& s, const Inbox<Message<n>>& inbox, int,
                   Message<n>&) noexcept {
    platoon::fuse(l, g, s, inbox);
  }
  template <int n>
  static void rejoin(const Local& l, const Gains& g, const Inbox<Message<n>>& inbox, std::int64_t t,
                     State<n>& s) noexcept {
    platoon::rejoin(l, g, s, inbox, t);
  }
  /// No bound, no test and no steering until the next sample in which enough is heard (observe).
  template <int n>
  static void uncover(const Gains& g, State<n>& s) noexcept {
    s.alpha = {};
    s.u = g.formation.steers() ? 0.0 : kNaN;
  }
  /// What vehicle `id` needs of the gains: the rest of the priors is dropped.
  static Gains part(const Gains& all, int id, std::span<const int>) {
    Gains g = all;
    g.priors.assign(all.priors.size(), {});
    if (!g.priors.empty()) g.priors[static_cast<std::size_t>(id)] = all.priors[static_cast<std::size_t>(id)];
    return g;
  }
  template <int n>
  static Report report(const Local& l, const Gains& g, const State<n>& s) noexcept {
    return report_of(l, g, s);
  }
  template <int n>
  static unsigned refuted(const State<n>& s) noexcept {
    return s.trouble;
  }
  template <int n>
  static const Vec<n>& estimate(const State<n>& s) noexcept {
    return s.x;
  }
  template <int n>
  static void accused_into(const State<n>& s, AgentSet& set) noexcept {
    if (s.trouble != 0) return;  // nothing is proved where an assumption is false
    for (const int id : s.sets.attacked.listed()) set.insert(id);
  }
  template <int n>
  static double control(const State<n>& s) noexcept {
    return s.u;
  }
  template <int n>
  static void expected(const Local& l, const Gains& g, const State<n>& s, double* out) noexcept {
    expected_of(l, g, s, out);
  }
  /// Per component, so that a deviation of both by it is just what (28) tolerates at the next sample.
  template <int n>
  static double alarm_level(const Local&, const Gains& g, const State<n>& s) noexcept {
    return platoon::innovation_level(g.setting, predicted(g.setting, s.alpha).norm) / 1.4142135623730951;
  }

  static constexpr std::size_t signal_count = 9;
  static std::vector<std::string> signal_names() {
    return {"alpha",  "threshold", "control",   "prediction_position", "prediction_velocity",
            "source", "trouble",   "least_gap", "spacing_error"};
  }
  /// alpha_i; beta_i; u_i; xbar_i; j_i (-1 = none); bits of platoon::Trouble; certified least gap to the
  /// vehicle ahead, and largest certified difference to the desired one.
  template <int n>
  static void signals(const Local&, const Gains&, const State<n>& s, double* out) noexcept {
    const double all[] = {s.alpha.norm,
                          s.beta,
                          s.u,
                          s.prediction[0],
                          s.prediction[1],
                          static_cast<double>(s.source),
                          static_cast<double>(s.trouble),
                          s.gap[0],
                          s.gap[1]};
    std::copy(std::begin(all), std::end(all), out);
  }
  static std::vector<std::string> detail_names() { return {"attacked", "suspected", "free", "gains"}; }
  /// The three sets as sorted ids (also where they are no longer published), and k_{i,m} (14) of vehicles
  /// that hear 2L others (empty for the rest).
  template <int n>
  static void detail(const Local& l, const Gains& g, const State<n>& s, std::size_t which,
                     std::vector<double>& out) {
    detail_of(l, g, s, which, out);
  }

 private:
  static Report report_of(const Local& l, const Gains& g, const platoon::VehicleState& s) noexcept;
  static void expected_of(const Local& l, const Gains& g, const platoon::VehicleState& s,
                          double* out) noexcept;
  static void detail_of(const Local& l, const Gains& g, const platoon::VehicleState& s, std::size_t which,
                        std::vector<double>& out);
};

}  // namespace garrison
