// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/errors.hpp"
#include "garrison/filters/partial_sharing/filter.hpp"

namespace garrison {
namespace {

/// Beyond this many states of the whole network (N m) the dense eigenvalue problems take minutes.
constexpr Eigen::Index kLargestNetwork = 600;

std::string named(const std::vector<int>& agents) {
  std::string all;
  for (std::size_t k = 0; k < agents.size() && k < 8; ++k)
    all += (k > 0 ? ", " : " ") + std::to_string(agents[k]);
  return all + (agents.size() > 8 ? ", .." : "");
}

double mean_mse(const std::vector<Matrix>& phases, int agents) {
  return partial_sharing::mse(phases) / agents;
}

}  // namespace

Check PartialSharing::check(const Params& params, const Model& model, const Network& network) {
  using namespace partial_sharing;
  const Setting s = make_setting(params, model, network);
  Check c;
  const std::vector<int> lost = undetectable_agents(s);
  const auto detected = static_cast<double>(s.agents()) - static_cast<double>(lost.size());
  c.conditions.push_back({"detectable agents", detected, "= " + std::to_string(s.agents()), lost.empty(),
                          lost.empty() ? "every (A, H_i) is detectable: (11) has a limit"
                                       : "(11) does not settle for agents" + named(lost) +
                                             ": what they do not see grows, which neighbours do not help, or "
                                             "no noise drives a mode that stays"});
  const double rarest = s.selection.frequency().minCoeff();
  c.conditions.push_back(
      {"least sharing frequency", rarest, "> 0", rarest > 0.0,
       "every entry of every agent has its turn; a shift without common factor with the number "
       "of states sees to that"});
  const auto bytes = static_cast<double>(bytes_per_step(s));
  c.quantities.push_back(
      {"period", static_cast<double>(s.selection.period()), "samples per cycle of selections"});
  c.quantities.push_back({"bytes per sample", bytes, "payload of all messages"});
  double radius = kNaN;
  double lyapunov = kNaN;
  double star = kNaN;
  double local = kNaN;
  double cooperating = kNaN;
  const bool affordable = lost.empty() && s.size() <= kLargestNetwork;
  if (lost.empty()) {
    const std::vector<LocalGains> gains = steady_gains(s);
    local = 0.0;
    for (const LocalGains& g : gains) local += g.P.trace() / s.agents();
    if (affordable) {
      radius = cycle_radius(s, gains);
      lyapunov = gamma_lyapunov(s, gains);
      star = gamma_star(s, gains, s.shared_fraction());
      if (radius < 1.0) cooperating = mean_mse(periodic_covariance(s, gains, Matrix()), s.agents());
    }
  }
  const std::string why = affordable     ? ""
                          : lost.empty() ? " (not computed: the network is too large)"
                                         : " (needs detectable agents)";
  c.conditions.push_back({"cycle radius", radius, "< 1", radius < 1.0,
                          "exact: spectral radius of the error dynamics over a cycle, per sample" + why,
                          affordable || !lost.empty()});
  c.conditions.push_back(
      {"gamma_lyapunov", lyapunov, ">= gain", lyapunov >= s.gamma,
       "certified: up to here the errors' Lyapunov function cannot grow at any phase" + why, false});
  c.conditions.push_back({"gamma* (22)", star, ">= gain", star >= s.gamma,
                          star == 0.0
                              ? "advisory, and vacuous here: some agent's measurements do not span the state"
                              : "advisory: Theorem 1 does not hold as printed" + why,
                          false});
  c.quantities.push_back({"MSE without cooperation", local, "mean of tr P_i of (11), steady"});
  c.quantities.push_back(
      {"MSE", cooperating, "exact (29) in periodic steady state, mean over a cycle" + why});
  return c;
}

}  // namespace garrison
