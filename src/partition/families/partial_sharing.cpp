// SPDX-License-Identifier: Apache-2.0
// Partial sharing: an agent's gain follows from its own sensors, its selection from its id.
#include "garrison/filters/partial_sharing/filter.hpp"
#include "partition/families/part_family.hpp"

namespace garrison::partition {
namespace {

/// What `part` of the family does for one agent, for those of a rank.
PartialSharing::Gains cut(const PartialSharing::Gains& all, const Cast& cast) {
  PartialSharing::Gains g{all.gamma, {}, {}, {}, all.Q, all.P0, all.before, all.given, all.freeze};
  Matrix start = Matrix::Zero(static_cast<Eigen::Index>(cast.ids.size()), all.selection.states());
  g.W.resize(cast.ids.size());
  g.steady.resize(all.steady.empty() ? 0 : cast.ids.size());
  for (std::size_t k = 0; k < cast.ids.size(); ++k) {
    const auto id = static_cast<std::size_t>(cast.ids[k]);
    for (const int a : all.selection.entries(cast.ids[k])) start(static_cast<Eigen::Index>(k), a) = 1.0;
    if (cast.own[k] == 0) continue;
    g.W[k] = all.W[id];
    if (!g.steady.empty()) g.steady[k] = all.steady[id];
  }
  g.selection = {start, all.selection.shift()};
  return g;
}

/// Covariances and sensors of the own agents, selections of the ghosts too.
PartialSharing::Gains gains_here(const PartialSharing::Params& params, const Model& own, const Cast& cast) {
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

std::unique_ptr<PartRunner> runner(const ParamMap& given, const Whole* whole, const Model& own,
                                   const Region& region, Exchange& exchange) {
  const auto params = params_of<PartialSharing>(given);
  const Cast cast(region);
  auto gains = whole == nullptr ? gains_here(params, own, cast)
                                : cut(PartialSharing::design(params, whole->model, whole->network), cast);
  return cast_engine<PartialSharing>(std::move(gains), own, region, exchange);
}

std::string why_whole(const ParamMap& given, int) {
  const auto p = params_of<PartialSharing>(given);
  return p.selection.empty() && p.shared_each.empty() ? "" : "selections are given agent by agent";
}

void require(const ParamMap& given, const Model& one) {
  if (why_whole(given, 1).empty())
    PartialSharing::design(params_of<PartialSharing>(given), one, Network(1, {}));
}

}  // namespace

const PartFamily partial_sharing_parts{PartialSharing::name, false, require, one_round, why_whole, runner};

}  // namespace garrison::partition
