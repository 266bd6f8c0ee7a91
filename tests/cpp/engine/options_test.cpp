// SPDX-License-Identifier: Apache-2.0
// Every pair of option values of a family keeps the family's promises: bounds, accusations, bits, recovery.
#include <doctest/doctest.h>

#include <cstring>
#include <map>
#include <set>

#include "../agents_by_hand.hpp"
#include "../option_pairs.hpp"
#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/design_file.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

constexpr int kAgents = 5;
constexpr int kSteps = 60;
constexpr int kBad = 20;  // sample of the one bad measurement

/// Numbers to try, by the parameter's name; switches and texts are tried in all their values. `states`: n.
OptionValues numbers(int states) {
  std::vector<double> poles;
  for (int k = 0; k < states; ++k) poles.push_back(0.3 + 0.1 * k);
  return {
      {"threshold", {0.5, 4.0}},
      {"rounds", {std::int64_t{1}, std::int64_t{12}}},
      {"step", {kNaN, 0.2}},
      {"attacked", {std::int64_t{0}, std::int64_t{1}}},
      {"initial_error", {kNaN, 2.0}},
      {"weight", {0.0, 0.5, 5.0}},
      {"smoothing", {0.0, 0.1}},
      {"gain", {0.1, 0.3}},
      {"shared", {std::int64_t{0}, std::int64_t{1}}},
      {"shared_each", {std::vector<double>{}, std::vector<double>(kAgents, 1.0)}},
      {"selection", {std::vector<double>{}}},  // a table of its own: partial_sharing/side_by_side_test.cpp
      {"selection_seed", {std::int64_t{0}, std::int64_t{3}}},
      {"shift", {std::int64_t{1}}},
      {"start_variance", {1.0, 0.0}},
      {"start_covariance", {std::vector<double>{}}},
      {"faulty", {std::int64_t{0}, std::int64_t{1}}},
      {"poles", {std::vector<double>{}, poles}}};
}

double largest(const Bulk<double>& values) {
  double most = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) most = std::max(most, std::abs(values[k]));
  return most;
}

/// Null where design refuses these options together.
std::shared_ptr<const Prepared> prepared(const std::string& family, const ParamMap& params,
                                         const Model& model, const Network& network) {
  try {
    return make_filter(family, params)->prepare(model, network);
  } catch (const Error&) {
    return nullptr;
  }
}

void check_bits(const Prepared& p, const Record& r, const Matrix& y) {
  AgentsByHand agents(p, p.network());
  Bulk<double> out;
  agents.append_estimates(out);
  for (Eigen::Index t = 0; t < y.rows(); ++t) {
    agents.step(t + 1, [&](int i) { return Vector::Constant(1, y(t, i)); });
    agents.append_estimates(out);
  }
  REQUIRE(out.size() == r.estimate.size());
  CHECK(std::memcmp(out.data(), r.estimate.data(), out.size() * sizeof(double)) == 0);
}

/// Honest sensors: bounds hold, nobody is accused, the agents alone have the same bits, of a design that went
/// through a file: what the gains do not list in `visit` would be lost there. Then one bad sample
/// of one sensor: at the end the estimate is back.
std::size_t check_promises(const Prepared& p) {
  PlantOptions plant;
  plant.steps = kSteps;
  RunOptions o;
  o.seed = 4;
  const Record r = simulate(p, plant, o);
  std::size_t bounds = 0;
  bool outside = false;
  for (std::size_t k = 0; k < r.error.size(); ++k) {
    bounds += std::isnan(r.bound[k]) ? 0 : 1;
    outside = outside || r.error[k] > r.bound[k] * (1.0 + 1e-12);  // false where there is none
  }
  CHECK_FALSE(outside);
  for (const auto& accusation : r.accusations)
    for (const auto& set : accusation.sets) CHECK(set.empty());
  const Matrix y = Eigen::Map<const Eigen::Matrix<double, Dynamic, Dynamic, Eigen::RowMajor>>(
      r.measurements.data(), kSteps, kAgents);
  check_bits(*read_design(write_design(p)), r, y);
  Matrix glitch = y;
  glitch(kBad, 2) += 50.0;
  const Record bad = replay(p.model(), p.network(), p.filter(), glitch, Matrix(), o);
  double gap = 0.0;
  const std::size_t row = bad.estimate.size() / (kSteps + 1);
  for (std::size_t k = kSteps * row; k < bad.estimate.size(); ++k)
    gap = std::max(gap, std::abs(bad.estimate[k] - r.estimate[k]));
  CHECK(gap <= 0.3 + largest(r.error));
  return bounds;
}

}  // namespace

TEST_CASE("every pair of option values keeps the promises of its family") {
  const std::map<std::string, ParamMap> without_default{
      {"saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{12}}, {"initial_error", 2.0}}},
      {"partial_sharing", {{"gain", 0.1}}}};
  const std::set<std::string> bounded{"saturation", "rdkf"};  // bounds must have been there to be looked at
  const std::set<std::string> elsewhere{"structural", "platoon", "platoon_baseline"};  // tables of their own
  for (const FamilyInfo& family : families()) {
    if (elsewhere.count(family.name) != 0) continue;
    CAPTURE(family.name);
    const auto given = without_default.find(family.name);
    const ParamMap base = given == without_default.end() ? ParamMap{} : given->second;
    int ran = 0;
    int refused = 0;
    std::size_t bounds = 0;
    for (const int n : {1, 2}) {
      Rng rng(static_cast<std::uint64_t>(70 + n));
      const Model model = scalar_model(rng, n, kAgents, 0.8, 0.02, 0.01);
      const Network network = connected_network(rng, kAgents, 0.8);
      for (const ParamMap& params : option_pairs(family.params, base, numbers(n))) {
        const std::string about = family.name + " n=" + std::to_string(n) + ": " + shown(params);
        CAPTURE(about);
        const auto p = prepared(family.name, params, model, network);
        (p == nullptr ? refused : ran) += 1;
        if (p != nullptr) bounds += check_promises(*p);
      }
    }
    MESSAGE(family.name << ": " << ran << " combinations ran, " << refused << " were refused, " << bounds
                        << " bounds were looked at");
    CHECK_MESSAGE(ran > refused, "values that run belong into `without_default` and `numbers` above");
    if (bounded.count(family.name) != 0) CHECK(bounds > 0);
  }
}
