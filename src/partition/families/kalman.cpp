// SPDX-License-Identifier: Apache-2.0
// The distributed Kalman filter and its resilient form: gains of neighbours depend on each other.
#include <type_traits>

#include "garrison/filters/rdkf/filter.hpp"
#include "garrison/filters/rdkf/setting.hpp"
#include "partition/families/part_family.hpp"
#include "partition/families/rdkf_here.hpp"

namespace garrison::partition {
namespace {

/// What `part` of the family does for one agent, for those of a rank.
Rdkf::Gains cut(const Rdkf::Gains& all, const Cast& cast) {
  Rdkf::Gains g = all;
  g.agents.assign(cast.ids.size(), {});
  for (std::size_t k = 0; k < cast.ids.size(); ++k) {
    const rdkf::AgentGains& from = all.agents[static_cast<std::size_t>(cast.ids[k])];
    if (cast.own[k] == 0) {
      g.agents[k].J = from.J;
      continue;
    }
    g.agents[k] = from;
    for (int& id : g.agents[k].heard) id = cast.name_of(id);
  }
  return g;
}

template <class F>
std::unique_ptr<PartRunner> runner(const ParamMap& given, const Whole* whole, const Model& own,
                                   const Region& region, Exchange& exchange) {
  const auto params = params_of<F>(given);
  auto gains = whole == nullptr ? rdkf_here(params, own, region, exchange)
                                : cut(F::design(params, whole->model, whole->network), Cast(region));
  return cast_engine<Rdkf>(std::move(gains), own, region, exchange);
}

std::string why_whole(int agents) {
  return agents <= kDesignedWhole ? "covariances of all agents depend on each other" : "";
}

/// Covariances of one agent.
template <class F>
void require(const ParamMap& given, const Model& one) {
  if constexpr (std::is_same_v<F, Rdkf>) Rdkf::require_fitting(params_of<Rdkf>(given));
  rdkf::part_setting(one, Network(1, {}));
}

}  // namespace

const PartFamily rdkf_parts{Rdkf::name,
                            true,
                            require<Rdkf>,
                            one_round,
                            [](const ParamMap& given, int agents) {
                              const auto p = params_of<Rdkf>(given);
                              return p.penalty == "group" ? "penalty \"group\" needs the neighbours' sensors"
                                                          : why_whole(agents);
                            },
                            runner<Rdkf>};

const PartFamily dkf_parts{
    Dkf::name,  true, require<Dkf>, one_round, [](const ParamMap&, int agents) { return why_whole(agents); },
    runner<Dkf>};

}  // namespace garrison::partition
