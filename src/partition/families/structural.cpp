// SPDX-License-Identifier: Apache-2.0
// The structural filter's estimator: its gains are designed for the whole network, then cut.
#include "garrison/filters/structural/filter.hpp"
#include "partition/families/part_family.hpp"

namespace garrison::partition {
namespace {

/// `count` numbers of each agent.
std::vector<double> rows_of(const std::vector<double>& all, const Cast& cast, std::size_t count) {
  std::vector<double> rows;
  if (all.empty()) return rows;
  for (const int id : cast.ids) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(count) * id;
    rows.insert(rows.end(), first, first + static_cast<std::ptrdiff_t>(count));
  }
  return rows;
}

/// What `part` of the family does for one agent, for those of a rank.
Structural::Gains cut(const Structural::Gains& all, const Cast& cast) {
  const std::size_t N = all.has_sensor.size();
  const std::size_t n = all.rows.size() / N;
  Structural::Gains g = all;
  g.rows = rows_of(all.rows, cast, n);
  g.std = rows_of(all.std, cast, 1);
  g.innovation_std = rows_of(all.innovation_std, cast, 1);
  g.precision = rows_of(all.precision, cast, all.precision.size() / N);
  g.covariance = rows_of(all.covariance, cast, n * n);
  g.noise = rows_of(all.noise, cast, 1);
  g.doubt = rows_of(all.doubt, cast, 1);
  g.haste = rows_of(all.haste, cast, 1);
  g.has_sensor.clear();
  g.offsets.assign(1, 0);
  g.heard.clear();
  g.columns.clear();
  for (std::size_t k = 0; k < cast.ids.size(); ++k) {
    const auto id = static_cast<std::size_t>(cast.ids[k]);
    g.has_sensor.push_back(all.has_sensor[id]);
    for (int e = all.offsets[id]; e < all.offsets[id + 1] && cast.own[k] != 0; ++e) {
      Structural::Heard heard = all.heard[static_cast<std::size_t>(e)];
      heard.id = cast.name_of(heard.id);
      if (heard.first >= 0) {
        const auto column = all.columns.begin() + heard.first;
        heard.first = static_cast<int>(g.columns.size());
        g.columns.insert(g.columns.end(), column, column + static_cast<std::ptrdiff_t>(n));
      }
      g.heard.push_back(heard);
    }
    g.offsets.push_back(static_cast<int>(g.heard.size()));
  }
  return g;
}

std::unique_ptr<PartRunner> runner(const ParamMap& given, const Whole* whole, const Model& own,
                                   const Region& region, Exchange& exchange) {
  require_sets("structural", region, 1.0, region.places());
  const auto params = params_of<Structural>(given);
  auto gains = cut(Structural::design(params, whole->model, whole->network), Cast(region));
  return cast_engine<Structural>(std::move(gains), own, region, exchange);
}

}  // namespace

const PartFamily structural_parts{
    Structural::name,
    false,
    nothing_before,
    one_round,
    [](const ParamMap&, int) -> std::string { return "gains follow from the whole network"; },
    runner};

}  // namespace garrison::partition
