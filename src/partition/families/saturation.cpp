// SPDX-License-Identifier: Apache-2.0
// Saturation and scalar gains: all agents have the same ones, so agents keep their public ids.
#include <cmath>

#include "garrison/filters/saturation/filter.hpp"
#include "garrison/filters/scalar_gain.hpp"
#include "partition/families/part_family.hpp"

namespace garrison::partition {
namespace {

/// The gains of a filter without bounds are the same for all agents, whoever they are: its own design makes
/// them, for a network of one.
template <class F>
Saturation::Gains alike(typename F::Params params, const Model& own) {
  if constexpr (requires { params.attacked; }) params.attacked = 0;  // enters bounds only
  return F::design(params, Model(own.A(), {own.C(0)}), Network(1, {}));
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
std::unique_ptr<PartRunner> runner(const ParamMap& given, const Whole* whole, const Model& own,
                                   const Region& region, Exchange& exchange) {
  const auto params = params_of<F>(given);
  require_step(params.step, region, exchange);
  auto gains = whole == nullptr ? alike<F>(params, own) : F::design(params, whole->model, whole->network);
  if (gains.detector) require_sets("saturation.detector", region, 3.0, region.agents);
  return part_engine<Saturation>(std::move(gains), own, region, exchange, {region.ids, region.agents});
}

std::string why_whole(const Saturation::Params& p) {
  if (std::isnan(p.step))
    return "the best step follows from the spectrum of the network: give \"step\" (garrison-mpi spectrum "
           "prints it)";
  if (p.chebyshev) return "Chebyshev weights follow from the spectrum of the network";
  return std::isnan(p.initial_error) ? "" : "bounds follow from all sensors: leave initial_error out";
}

std::string why_whole(const ScalarGain::Params& p) { return why_whole(ScalarGain::unsaturated(p)); }

/// With bounds or a detector more is asked, but of the whole network, which is designed first then.
template <class F>
void require(const ParamMap& given, const Model& one) {
  const auto params = params_of<F>(given);
  if (why_whole(params).empty()) alike<F>(params, one);
}

template <class F>
int rounds(const ParamMap& given) {
  return params_of<F>(given).rounds;
}

template <class F>
constexpr PartFamily parts() {
  return {F::name,
          true,
          require<F>,
          rounds<F>,
          [](const ParamMap& given, int) { return why_whole(params_of<F>(given)); },
          runner<F>};
}

}  // namespace

const PartFamily saturation_parts = parts<Saturation>();
const PartFamily scalar_gain_parts = parts<ScalarGain>();

}  // namespace garrison::partition
