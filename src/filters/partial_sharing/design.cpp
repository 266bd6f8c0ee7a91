// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "garrison/filters/partial_sharing/filter.hpp"
#include "garrison/filters/partial_sharing/setting.hpp"

namespace garrison {
namespace {

std::vector<double> flat(const Matrix& m) { return {m.data(), m.data() + m.size()}; }

/// Steady gains of every agent; agents with the same sensors share the work.
std::vector<PartialSharing::Steady> steady(const partial_sharing::Setting& s) {
  std::vector<PartialSharing::Steady> all;
  std::map<std::vector<double>, std::size_t> known;
  for (int i = 0; i < s.agents(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    std::vector<double> sensor = flat(s.H[at]);
    sensor.insert(sensor.end(), s.R[at].data(), s.R[at].data() + s.R[at].size());
    const auto [entry, fresh] = known.emplace(std::move(sensor), all.size());
    if (!fresh) {
      all.push_back(all[entry->second]);
      continue;
    }
    const partial_sharing::LocalGains gains = steady_gains(s, i);
    partial_sharing::LocalRecursion recursion(s, i);
    recursion.restart(gains.P);
    recursion.step();
    all.push_back({flat(gains.P), flat(recursion.consensus_gain()), flat(recursion.filter_gain())});
  }
  return all;
}

}  // namespace

PartialSharing::Gains PartialSharing::design(const Params& params, const Model& model,
                                             const Network& network) {
  const partial_sharing::Setting s = partial_sharing::make_setting(params, model, network);
  Gains g;
  g.gamma = s.gamma;
  g.selection = s.selection;
  g.Q = s.Q;
  g.given = params.start_is_prediction;
  g.freeze = params.gains != "varying";
  g.P0 = g.given ? s.P0 : partial_sharing::predicted(s.A, s.P0, s.Q);
  if (!g.freeze && !g.given) g.before = s.P0;
  for (int i = 0; i < s.agents(); ++i)
    g.W.push_back(flat(partial_sharing::whitener(s.R[static_cast<std::size_t>(i)], i).transpose()));
  if (params.gains == "steady") g.steady = steady(s);
  return g;
}

void PartialSharing::require_series(const Series& series, const Model& model) {
  const std::size_t samples = series.measurement_covariance.size();
  for (std::size_t t = 0; t < samples; ++t)
    for (int i = 0; i < model.agents(); ++i)
      if (model.outputs(i) > 0 &&
          whitener(measurement_covariance_at(series, model, i, static_cast<int>(t) + 1)).size() == 0)
        refuse("measurement_covariance[" + std::to_string(t) + "] of agent " + std::to_string(i) + " (R)",
               "a matrix that is not positive definite", "a symmetric positive definite one",
               "a measurement without noise is not covered: give it a small variance");
}

}  // namespace garrison
