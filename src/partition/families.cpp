// SPDX-License-Identifier: Apache-2.0
#include "partition/families.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "garrison/core/dispatch.hpp"
#include "garrison/filters/saturation/params.hpp"
#include "garrison/filters/scalar_gain.hpp"
#include "partition/cut.hpp"
#include "partition/part_engine.hpp"
#include "partition/rdkf_here.hpp"

namespace garrison::partition {
namespace {

constexpr std::array<const char*, 6> kFamilies{"saturation", "scalar_gain",     "rdkf",
                                               "dkf",        "partial_sharing", "structural"};

template <class F>
std::unique_ptr<PartRunner> engine(typename F::Gains gains, const Model& own, const Region& region,
                                   Exchange& exchange, Names names) {
  auto shared = std::make_shared<const typename F::Gains>(std::move(gains));
  return dispatch(own.states(), [&]<int n>() -> std::unique_ptr<PartRunner> {
    return std::make_unique<PartEngine<F, n>>(shared, own, region, exchange, std::move(names));
  });
}
template <class F>
std::unique_ptr<PartRunner> cut_engine(const typename F::Gains& all, const Model& own, const Region& region,
                                       Exchange& exchange) {
  const Cast cast(region);
  return engine<F>(cut(all, cast), own, region, exchange, {region.names(), cast.size()});
}

/// The gains of a saturation filter without bounds are the same for all agents, whoever they are: its own
/// design makes them, for a network of one.
template <class F>
Saturation::Gains alike(typename F::Params params, const Model& own) {
  if constexpr (requires { params.attacked; }) params.attacked = 0;  // enters bounds only
  return F::design(params, Model(own.A(), {own.C(0)}), Network(1, {}));
}

/// A set of agents in each state and message is the square of the network in bits.
void require_sets(const std::string& which, const Region& region, double sets, int agents) {
  require_memory(which, std::to_string(region.own) + " sets of " + std::to_string(agents) + " agents",
                 sets * region.places() * agents / 8.0);
}

/// No rank knows lambda_max, but it is at least the largest degree plus one. All ranks together.
void require_step(double step, const Region& region, Exchange& exchange) {
  double most[] = {0.0};
  for (int place = 0; place < region.own; ++place) most[0] = std::max<double>(most[0], region.degree(place));
  exchange.largest(most);
  if (most[0] > 0.0 && !std::isnan(step) && !(step < 2.0 / (most[0] + 1.0)))
    refuse("step", text(step), "a number in (0, 2 / lambda_max), and lambda_max >= " + text(most[0] + 1.0),
           "garrison-mpi spectrum prints the best one");
}

template <class F>
std::unique_ptr<PartRunner> saturation(const std::string& family, const ParamMap& given, const Whole* whole,
                                       const Model& own, const Region& region, Exchange& exchange) {
  const auto params = parse_params<typename F::Params>(family, given);
  require_step(params.step, region, exchange);
  auto gains = whole == nullptr ? alike<F>(params, own) : F::design(params, whole->model, whole->network);
  if (gains.detector) require_sets("saturation.detector", region, 3.0, region.agents);
  Names names{region.ids, region.agents};
  return engine<Saturation>(std::move(gains), own, region, exchange, std::move(names));
}

/// Covariances and sensors of the own agents, selections of the ghosts too.
PartialSharing::Gains partial_sharing_here(PartialSharing::Params params, const Model& own,
                                           const Cast& cast) {
  const int m = own.states();
  const std::vector<int> shared(cast.ids.size(), params.shared == 0 ? m : params.shared);
  const auto selection =
      params.starts == "random"
          ? partial_sharing::Selection::random(m, shared, params.shift,
                                               static_cast<std::uint64_t>(params.selection_seed), cast.ids)
          : partial_sharing::Selection::coordinated(m, shared, params.shift);
  auto gains = PartialSharing::design(params, own, Network(own.agents(), {}));
  gains.selection = selection;
  std::vector<std::vector<double>> W(cast.ids.size());
  std::vector<PartialSharing::Steady> steady(gains.steady.empty() ? 0 : cast.ids.size());
  for (std::size_t name = 0, k = 0; name < cast.ids.size(); ++name) {
    if (cast.own[name] == 0) continue;
    W[name] = std::move(gains.W[k]);
    if (!steady.empty()) steady[name] = std::move(gains.steady[k]);
    ++k;
  }
  gains.W = std::move(W);
  gains.steady = std::move(steady);
  return gains;
}

template <class F>
std::unique_ptr<PartRunner> kalman(const typename F::Params& params, const Whole* whole, const Model& own,
                                   const Region& region, Exchange& exchange) {
  if (whole != nullptr)
    return cut_engine<Rdkf>(F::design(params, whole->model, whole->network), own, region, exchange);
  return engine<Rdkf>(rdkf_here(params, own, region, exchange), own, region, exchange,
                      {region.names(), region.places()});
}

std::string saturation_needs(const Saturation::Params& p) {
  if (std::isnan(p.step))
    return "the best step follows from the spectrum of the network: give \"step\" (garrison-mpi spectrum "
           "prints it)";
  if (p.chebyshev) return "Chebyshev weights follow from the spectrum of the network";
  return std::isnan(p.initial_error) ? "" : "bounds follow from all sensors: leave initial_error out";
}

}  // namespace

void require_family(const std::string& family) {
  if (std::find(kFamilies.begin(), kFamilies.end(), family) != kFamilies.end()) return;
  std::string known;
  for (const char* one : kFamilies) known += (known.empty() ? "" : ", ") + std::string(one);
  refuse("filter.name", "\"" + family + "\"", "a filter that runs on many ranks: " + known);
}

std::string needs_whole(const std::string& family, const ParamMap& params, int agents) {
  require_family(family);
  if (family == "saturation") return saturation_needs(parse_params<Saturation::Params>(family, params));
  if (family == "scalar_gain")
    return saturation_needs(ScalarGain::unsaturated(parse_params<ScalarGain::Params>(family, params)));
  if (family == "partial_sharing") {
    const auto p = parse_params<PartialSharing::Params>(family, params);
    return p.selection.empty() && p.shared_each.empty() ? "" : "selections are given agent by agent";
  }
  if (family == "structural") return "gains follow from the whole network";
  if (family == "rdkf" && parse_params<Rdkf::Params>(family, params).penalty == "group")
    return "penalty \"group\" needs the neighbours' sensors";
  return agents <= kDesignedWhole ? "covariances of all agents depend on each other" : "";
}

int rounds_of(const std::string& family, const ParamMap& params) {
  require_family(family);
  if (family == "saturation") return parse_params<Saturation::Params>(family, params).rounds;
  if (family == "scalar_gain") return parse_params<ScalarGain::Params>(family, params).rounds;
  return 1;
}

bool needs_connected(const std::string& family) {
  return family != "partial_sharing" && family != "structural";
}

std::unique_ptr<PartRunner> part_runner(const std::string& family, const ParamMap& params, const Whole* whole,
                                        const Model& own, const Region& region, Exchange& exchange) {
  const std::string why = needs_whole(family, params, std::numeric_limits<int>::max());
  if (whole == nullptr && !why.empty()) refuse("filter", family + " without the whole network", why);
  if (family == "saturation") return saturation<Saturation>(family, params, whole, own, region, exchange);
  if (family == "scalar_gain") return saturation<ScalarGain>(family, params, whole, own, region, exchange);
  if (family == "partial_sharing") {
    const auto p = parse_params<PartialSharing::Params>(family, params);
    if (whole != nullptr)
      return cut_engine<PartialSharing>(PartialSharing::design(p, whole->model, whole->network), own, region,
                                        exchange);
    const Cast cast(region);
    return engine<PartialSharing>(partial_sharing_here(p, own, cast), own, region, exchange,
                                  {region.names(), cast.size()});
  }
  if (family == "structural") {
    require_sets("structural", region, 1.0, region.places());
    return cut_engine<Structural>(
        Structural::design(parse_params<Structural::Params>(family, params), whole->model, whole->network),
        own, region, exchange);
  }
  if (family == "dkf") return kalman<Dkf>(Dkf::Params{}, whole, own, region, exchange);
  return kalman<Rdkf>(parse_params<Rdkf::Params>(family, params), whole, own, region, exchange);
}

}  // namespace garrison::partition
