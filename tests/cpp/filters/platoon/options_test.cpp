// SPDX-License-Identifier: Apache-2.0
// Every pair of options of the families of vehicles keeps their promises: bounds, accusations, bits,
// recovery.
#include <doctest/doctest.h>

#include <cstring>

#include "../../agents_by_hand.hpp"
#include "../../option_pairs.hpp"
#include "random_platoon.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

constexpr int kVehicles = 7;
constexpr int kRange = 3;
constexpr int kSteps = 60;
constexpr int kVictim = 2;

/// A string that all options are tried on, and where its estimates start.
struct String {
  Model model = platoon::model(kVehicles, 0.05, true);
  Network network = Network::band(kVehicles, kRange);
  Start start;
  String() {
    platoon::Setting s;
    s.vehicles = kVehicles;
    s.q = 8.0;
    Rng rng(5);
    start = random_start(rng, s);
  }
};

const ParamMap kBase{{"process_noise", 0.02},
                     {"measurement_noise", 0.1},
                     {"initial_error", 8.0},
                     {"reference", std::vector<double>{200.0, 10.0}},
                     {"gs", 1.0},
                     {"gv", 2.0}};

/// What is told in advance is true: vehicle 1 knows of the victim, vehicle 3 of another's innocence.
const OptionValues kValues{{"threshold", {kNaN, 0.5}},
                           {"attacked", {std::int64_t{1}, std::int64_t{2}}},
                           {"process_noise", {0.02, 0.05}},
                           {"measurement_noise", {0.1, 0.2}},
                           {"absolute_position_noise", {kNaN, 0.08}},
                           {"absolute_velocity_noise", {kNaN, 0.08}},
                           {"relative_position_noise", {kNaN, 0.08}},
                           {"relative_velocity_noise", {kNaN, 0.08}},
                           {"initial_error", {8.0, 20.0}},
                           {"varpi", {2.0, 4.0}},
                           {"reference", {std::vector<double>{200.0, 10.0}, std::vector<double>{}}},
                           {"spacing", {20.0, 30.0}},
                           {"gs", {1.0, kNaN}},
                           {"gv", {2.0, kNaN}},
                           {"input_bound", {kNaN, 50.0}},
                           {"prior_attacked", {std::vector<double>{}, std::vector<double>{1.0, kVictim}}},
                           {"prior_suspected", {std::vector<double>{}, std::vector<double>{1.0, kVictim}}},
                           {"prior_free", {std::vector<double>{}, std::vector<double>{3.0, 4.0}}}};

/// Null where design refuses these options together.
std::shared_ptr<const Prepared> prepared(const std::string& family, const ParamMap& params,
                                         const String& string) {
  try {
    return make_filter(family, params)->prepare(string.model, string.network);
  } catch (const Error&) {
    return nullptr;
  }
}

Record run(const Prepared& p, const String& string, std::vector<Attack> attacks) {
  RunOptions o;
  o.seed = 3;
  o.threads = 1;
  o.start = string.start.estimate;
  o.attacks = std::move(attacks);
  return simulate(p, {kSteps, string.start.x0, 0.0, "extreme", {}}, o);
}

/// The bounds that were looked at; none may be exceeded, and nobody but the victim be accused.
std::size_t check_bounds(const Record& r, bool attacked) {
  std::size_t bounds = 0;
  bool outside = false;
  for (std::size_t k = 0; k < r.error.size(); ++k) {
    bounds += std::isnan(r.bound[k]) ? 0 : 1;
    outside = outside || r.error[k] > r.bound[k];  // false where there is none
  }
  CHECK_FALSE(outside);
  for (const auto& accusation : r.accusations)
    for (const auto& set : accusation.sets)
      for (const int one : set) {
        CHECK(attacked);
        CHECK(one == kVictim);
      }
  return bounds;
}

void check_bits(const Prepared& p, const Record& r, const String& string) {
  AgentsByHand agents(p, string.network);
  for (int i = 0; i < kVehicles; ++i) agents[i].reset(string.start.estimate.col(i));
  const auto M = static_cast<std::size_t>(string.model.total_outputs());
  Bulk<double> out;
  for (std::size_t t = 0; t <= kSteps; ++t) {
    agents.step(static_cast<std::int64_t>(t), [&](int i) {
      const double* y = r.measurements.data() + t * M + string.model.offset(i);
      return Vector(Eigen::Map<const Vector>(y, string.model.outputs(i)));
    });
    agents.append_estimates(out);
  }
  REQUIRE(out.size() == r.estimate.size());
  CHECK(std::memcmp(out.data(), r.estimate.data(), out.size() * sizeof(double)) == 0);
}

double last_error(const Record& r) {
  double most = 0.0;
  for (std::size_t k = r.error.size() - kVehicles; k < r.error.size(); ++k) most = std::max(most, r.error[k]);
  return most;
}

}  // namespace

TEST_CASE("every pair of option values keeps the promises to vehicles") {
  const String string;
  for (const FamilyInfo& family : families()) {
    if (family.name != "platoon" && family.name != "platoon_baseline") continue;
    const bool proves = family.name == "platoon";
    ParamMap base = kBase;
    if (!proves) {
      base.erase("initial_error");
      base["kind"] = std::string("pwm");
    }
    int ran = 0;
    int refused = 0;
    std::size_t bounds = 0;
    for (const ParamMap& params : option_pairs(family.params, base, kValues)) {
      const std::string about = family.name + ": " + shown(params);
      CAPTURE(about);
      const auto p = prepared(family.name, params, string);
      (p == nullptr ? refused : ran) += 1;
      if (p == nullptr) continue;
      const bool told = about.find("prior_") != std::string::npos;
      const Record quiet = run(*p, string, {});
      check_bits(*p, quiet, string);
      const Record lied = run(*p, string, {bias(Schedule(5, {kVictim}), 40.0)});
      const Record glitch = run(*p, string, {bias(Schedule(5, {kVictim}, 6), 40.0)});
      if (!proves) {
        CHECK(std::isfinite(last_error(lied)));
        continue;
      }
      bounds += check_bounds(lied, true) + check_bounds(glitch, true);
      if (!told) bounds += check_bounds(quiet, false);  // else it is false that the victim is attacked
      CHECK(last_error(glitch) <= last_error(quiet) + 0.5);
    }
    MESSAGE(family.name << ": " << ran << " combinations ran, " << refused << " were refused, " << bounds
                        << " bounds were looked at");
    CHECK(ran > refused);
    CHECK((bounds > 0) == proves);
  }
}
