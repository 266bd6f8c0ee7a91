// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/online/plan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "certificate/memory/choices.hpp"
#include "certificate/require.hpp"
#include "core/hops.hpp"
#include "garrison/certificate/online/evidence.hpp"
#include "garrison/certificate/propagate.hpp"
#include "garrison/certificate/quantiles.hpp"

namespace garrison::certificate {
namespace {

// Shares of the failure probability: see Plan.
constexpr double kSampleShare = 0.75 / (3.0 * (kChoice + 2));
constexpr double kAgeingShare = 0.25 / (kChoice + 1);
/// Of W and R where there is a bank; the rest is the bank's.
constexpr double kBesideBank = 0.5;
/// Epochs of a bank: more samples than 2^62 do not come.
constexpr int kEpochs = 62;
// Bounds of noise, with room for what rounding does to measurements of states a million times as large: where
// inputs are known, what is left of these measurements is small, and does not show it. kFollows is part of
// it.
constexpr double kRounded = 1.0 + 1e-8;

void require_wanted(const Wanted& wanted, const Model& model) {
  if (!(wanted.failure >= 0.0 && wanted.failure < 1.0))
    refuse("failure", text(wanted.failure), "a probability in [0, 1)", "0 = deterministic");
  if (wanted.attacked < 0) refuse("attacked", std::to_string(wanted.attacked), "a whole number >= 0");
  if (wanted.subsets < 0 || wanted.subsets > 1000000)
    refuse("subsets", std::to_string(wanted.subsets), "a whole number in 0..1000000");
  const bool given = wanted.z1 != 0.0 || wanted.z2 != 0.0;
  if (given && !(wanted.z1 > 0.0 && wanted.z1 < kHuge && wanted.z2 > 0.0 && wanted.z2 < kHuge))
    refuse("levels", text(wanted.z1) + " and " + text(wanted.z2), "two numbers > 0, in standard deviations");
  if (given && wanted.failure == 0.0)
    refuse("levels", "levels with failure = 0", "none", "noise within its bounds exceeds no level");
  if (wanted.memory && wanted.failure == 0.0)
    refuse("memory", "true with failure = 0", "failure > 0",
           "a bank of filters rests on covariances; bounded noise has windows (certificate.subsets_window)");
  if (wanted.memory && given)
    refuse("memory", "true with levels", "one of them",
           "levels are those of single samples; a bank rests on white noise of the model's covariances");
  if (wanted.memory && model.noise().process_covariance.size() == 0)
    refuse("memory", "true with a model without process_covariance", "the covariance of the process noise");
  if (wanted.failure == 0.0) {
    if (model.noise().measurement_bound.size() == 0)
      refuse("failure", "0 with a model without measurement_bound", "bounds on all measurement noises",
             "give the model measurement_bound, or take failure > 0");
  } else if (model.noise().measurement_covariance.empty()) {
    refuse("failure", text(wanted.failure) + " with a model without measurement_covariance",
           "covariances of all measurement noises",
           "give the model measurement_covariance, or take failure = 0");
  }
}

/// Sources of all rows, numbered in the order of their first row.
std::vector<int> source_numbers(const Model& model) {
  std::vector<int> numbers;
  std::map<std::string, int> seen;
  const auto& names = model.labels().sources;
  for (int i = 0; i < model.agents(); ++i)
    for (int r = 0; r < model.outputs(i); ++r) {
      const std::string name =
          names.empty() ? std::to_string(i) : names[static_cast<std::size_t>(model.offset(i) + r)];
      numbers.push_back(seen.emplace(name, static_cast<int>(seen.size())).first->second);
    }
  return numbers;
}

double variance_of(const Model& model, int agent, int output, double width) {
  const auto& all = model.noise().measurement_covariance;
  // Bounded noise is only weighed with it.
  if (all.empty()) return width > 0.0 ? width * width / 3.0 : 1e-12;
  const Matrix& R = all[static_cast<std::size_t>(agent)];
  for (Eigen::Index k = 0; k < R.cols(); ++k)
    if (k != output && R(output, k) != 0.0)
      refuse("measurement_covariance[" + std::to_string(agent) + "]", "correlated outputs",
             "a diagonal matrix, for a certificate", "split or combine the outputs");
  if (!(R(output, output) > 0.0))
    refuse("measurement_covariance[" + std::to_string(agent) + "]", text(R(output, output)),
           "variances > 0, for a certificate");
  return R(output, output);
}

/// How many rows, each a column here, are not zero.
int sensing_rows(const Matrix& rows) {
  int count = 0;
  for (Eigen::Index r = 0; r < rows.cols(); ++r) count += rows.col(r).isZero(0.0) ? 0 : 1;
  return count;
}

/// How many ages keep all numbers small, without designing for minutes in large dimensions.
int ages_of(const Matrix& A) {
  const double n = static_cast<double>(A.rows());
  const int most = std::clamp(static_cast<int>(2e7 / (n * n * n)), 20, kMostAge);
  double norm = 1.0;
  Matrix power = Matrix::Identity(A.rows(), A.rows());
  int k = 0;
  while (k < most && norm < 1e30) {
    power = A * power;
    norm = power.norm();
    ++k;
  }
  return norm < 1e30 ? k : std::max(0, k - 1);
}

void age_table(Plan& plan, const Model& model) {
  const Noise& noise = model.noise();
  const bool gaussian = !plan.deterministic() && noise.process_covariance.size() > 0;
  if (!gaussian && std::isnan(noise.process_bound)) return;
  const int most = ages_of(model.A());
  const auto aged = gaussian ? Propagation::gaussian(model.A(), most, noise.process_covariance,
                                                     kAgeingShare * plan.own_failure())
                             : Propagation::bounded(model.A(), most, kRounded * noise.process_bound);
  for (int k = 0; k <= most; ++k) {
    plan.norm.push_back(aged.norm(k));
    plan.added.push_back(aged.added(k));
  }
}

/// Sources that an agent hears, its own among them.
int sources_heard(const Plan& plan, const Network& network, int agent) {
  if (plan.wanted.spread == Spread::flooded) return plan.sources;
  std::set<int> sources;
  const auto add = [&](int j) {
    const auto at = static_cast<std::size_t>(j);
    for (int r = plan.first[at]; r < plan.first[at + 1]; ++r)
      sources.insert(plan.source[static_cast<std::size_t>(r)]);
  };
  add(agent);
  for (const int j : network.neighbours(agent)) add(j);
  return static_cast<int>(sources.size());
}

void require_banks(const Plan& plan, const Network& network) {
  const double n = plan.states();
  double numbers = 0.0;
  for (int i = 0; i < network.agents(); ++i) {
    const int sources = sources_heard(plan, network, i);
    if (sources <= plan.wanted.attacked) continue;
    const double members = detail::choices(sources, plan.wanted.attacked);
    if (!(members <= kMostBankMembers))
      refuse("memory",
             "true where agent " + std::to_string(i) + " hears " + amount(sources, "source") + " with " +
                 std::to_string(plan.wanted.attacked) + " attacked: " + text(members) + " filters",
             "at most " + std::to_string(kMostBankMembers),
             plan.wanted.spread == Spread::flooded ? "take \"local\" or \"direct\", or a smaller `attacked`"
                                                   : "take a smaller `attacked`");
    numbers += members * n * (2.0 * n + 1.0);
  }
  detail::require_room("memory", numbers);
}

void plan_banks(Plan& plan, const Model& model, const Network& network) {
  require_banks(plan, network);
  BankPlan& bank = plan.bank;
  const double share = 0.5 * (plan.wanted.failure - plan.own_failure());
  bank.Q = model.noise().process_covariance;
  for (int k = 0; k <= kEpochs; ++k)
    bank.z1.push_back(two_sided(std::ldexp(share / ((k + 1.0) * (k + 2.0)) / plan.all_rows, -k)));
  bank.z2 = chi(0.5 * share, model.states());
  bank.zc = two_sided(0.5 * share / model.states());
}

/// Plan::reach. Not known of networks that are so large that it would take long.
int reach_of(const Network& network) {
  constexpr int kMostAgents = 1000;
  if (network.agents() > kMostAgents) return kUnknownReach;
  return garrison::detail::diameter(network).value_or(kUnknownReach);
}

bool consistent_bank(const Plan& plan) {
  const BankPlan& bank = plan.bank;
  if (!plan.wanted.memory) return bank.Q.size() == 0 && bank.z1.empty();
  const auto level = [](double z) { return z > 0.0 && z < kHuge; };
  return bank.Q.rows() == plan.states() && bank.Q.cols() == plan.states() && !bank.z1.empty() &&
         std::all_of(bank.z1.begin(), bank.z1.end(), level) && level(bank.z2) && level(bank.zc);
}

}  // namespace

double Plan::own_failure() const { return wanted.memory ? kBesideBank * wanted.failure : wanted.failure; }

int Plan::place(int agent) const {
  const auto at = std::lower_bound(ids.begin(), ids.end(), agent);
  return at == ids.end() || *at != agent ? -1 : static_cast<int>(at - ids.begin());
}
int Plan::outputs(int agent) const {
  const int at = place(agent);
  return at < 0 ? 0 : first[static_cast<std::size_t>(at) + 1] - first[static_cast<std::size_t>(at)];
}

double Plan::derived(std::size_t row, const double* x) const {
  const double* const c = rows.data() + row * static_cast<std::size_t>(states());
  double y = 0.0;
  for (int k = 0; k < states(); ++k) y += c[k] * x[k];
  return y;
}
Told Plan::tell(int agent, const double* y, const double* x, double* out) const {
  const int rows_here = outputs(agent);
  const auto begin = static_cast<std::size_t>(first[static_cast<std::size_t>(place(agent))]);
  bool follows = derives(agent) && x != nullptr;
  for (int k = 0; k < rows_here && follows; ++k) {
    const std::size_t row = begin + static_cast<std::size_t>(k);
    const auto r = static_cast<Eigen::Index>(row);
    out[k] = derived(row, x);
    follows = std::abs(out[k] - y[k]) <= kFollows * (deterministic() ? width(r) : std::sqrt(variance(r)));
  }
  if (follows) return Told::derived;
  std::copy_n(y, rows_here, out);
  return derives(agent) ? Told::as_numbers : Told::never_derived;
}

Plan make_plan(const Wanted& wanted, const Model& model, const Network& network) {
  require_wanted(wanted, model);
  const double numbers = static_cast<double>(model.agents()) * model.total_outputs();
  if (wanted.spread == Spread::flooded && numbers > 1e8)
    refuse("certificate", "flooded with " + amount(model.agents(), "agent"),
           "a smaller network: every agent keeps all measurements", "take \"local\"");
  Plan plan;
  plan.wanted = wanted;
  plan.agents = network.agents();
  plan.A = model.A();
  plan.rows = model.stacked().transpose();
  plan.all_rows = sensing_rows(plan.rows);
  if (plan.all_rows == 0) refuse("certificate", "a model without sensors", "at least one measurement");
  plan.source = source_numbers(model);
  plan.sources = 1 + *std::max_element(plan.source.begin(), plan.source.end());
  if (wanted.attacked >= plan.sources)
    refuse("attacked", std::to_string(wanted.attacked),
           "less than the number of sources, " + std::to_string(plan.sources));
  plan.variance.resize(plan.rows.cols());
  plan.width = Vector::Zero(plan.rows.cols());
  plan.first.push_back(0);
  for (int i = 0; i < model.agents(); ++i) {
    plan.ids.push_back(i);
    for (int r = 0; r < model.outputs(i); ++r) {
      const int row = model.offset(i) + r;
      if (model.noise().measurement_bound.size() > 0)
        plan.width(row) = plan.deterministic() ? kRounded * model.noise().measurement_bound(i) : 0.0;
      plan.variance(row) = variance_of(model, i, r, plan.width(row));
    }
    plan.first.push_back(model.offset(i) + model.outputs(i));
  }
  if (wanted.z1 > 0.0) {
    plan.z1 = wanted.z1;
    plan.z2_full = plan.z2_partial = wanted.z2;
  } else if (!plan.deterministic()) {
    const double share = kSampleShare * plan.own_failure();
    plan.z1 = two_sided(share / plan.all_rows);
    plan.z2_full = chi(share, model.states());
    plan.z2_partial = chi(share / model.agents(), model.states());
  }
  plan.reach = reach_of(network);
  age_table(plan, model);
  if (wanted.memory) plan_banks(plan, model, network);
  return plan;
}

Plan part_of(const Plan& plan, int id, std::span<const int> neighbours) {
  if (plan.wanted.spread == Spread::flooded) return plan;
  Plan part = plan;
  part.ids.assign(neighbours.begin(), neighbours.end());
  part.ids.push_back(id);
  std::sort(part.ids.begin(), part.ids.end());
  part.first.assign(1, 0);
  std::vector<Eigen::Index> taken;
  for (const int agent : part.ids) {
    const auto place = static_cast<std::size_t>(plan.place(agent));
    for (int r = plan.first[place]; r < plan.first[place + 1]; ++r) taken.push_back(r);
    part.first.push_back(static_cast<int>(taken.size()));
  }
  part.rows = plan.rows(Eigen::all, taken);
  part.variance = plan.variance(taken);
  part.width = plan.width(taken);
  part.source.clear();
  for (const auto r : taken) part.source.push_back(plan.source[static_cast<std::size_t>(r)]);
  return part;
}

bool consistent(const Plan& plan) {
  const auto m = static_cast<Eigen::Index>(plan.source.size());
  bool fine =
      consistent_bank(plan) && plan.first.size() == plan.ids.size() + 1 && plan.first.front() == 0 &&
      plan.first.back() == m && std::is_sorted(plan.first.begin(), plan.first.end()) &&
      std::adjacent_find(plan.ids.begin(), plan.ids.end(), std::greater_equal<>()) == plan.ids.end() &&
      plan.rows.cols() == m && plan.rows.rows() == plan.states() && plan.states() >= 1 &&
      plan.A.cols() == plan.states() && plan.variance.size() == m && plan.width.size() == m &&
      plan.norm.size() == plan.added.size() && plan.ages() <= kMostAge &&
      plan.all_rows >= sensing_rows(plan.rows);
  for (const int source : plan.source) fine = fine && source >= 0 && source < plan.sources;
  return fine && !plan.ids.empty() && plan.ids.front() >= 0 && plan.ids.back() < plan.agents;
}

}  // namespace garrison::certificate
