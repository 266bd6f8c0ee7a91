// SPDX-License-Identifier: Apache-2.0
// What a family tells of itself to run on many ranks. A new one: its file here, its line in families.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "garrison/core/dispatch.hpp"
#include "partition/cast.hpp"
#include "partition/families.hpp"
#include "partition/part_engine.hpp"

namespace garrison::partition {

struct PartFamily {
  std::string_view name;
  /// Its design refuses a network that is not connected.
  bool connected;
  /// Refuses what the design refuses of parameters whatever the network, before it is cut.
  void (*require)(const ParamMap& params, const Model& one);
  int (*rounds)(const ParamMap& params);
  std::string (*needs_whole)(const ParamMap& params, int agents);
  std::unique_ptr<PartRunner> (*runner)(const ParamMap& params, const Whole* whole, const Model& own,
                                        const Region& region, Exchange& exchange);
};

extern const PartFamily saturation_parts;
extern const PartFamily scalar_gain_parts;
extern const PartFamily rdkf_parts;
extern const PartFamily dkf_parts;
extern const PartFamily partial_sharing_parts;
extern const PartFamily structural_parts;

template <class F>
typename F::Params params_of(const ParamMap& given) {
  return parse_params<typename F::Params>(std::string(F::name), given);
}

/// `require` of a family whose design looks at the whole network first.
inline void nothing_before(const ParamMap&, const Model&) {}

/// `rounds` of a family that exchanges messages once a sample.
inline int one_round(const ParamMap&) { return 1; }

/// The agents of a rank with gains by the names of `names`.
template <class F>
std::unique_ptr<PartRunner> part_engine(typename F::Gains gains, const Model& own, const Region& region,
                                        Exchange& exchange, Names names) {
  auto shared = std::make_shared<const typename F::Gains>(std::move(gains));
  return dispatch(own.states(), [&]<int n>() -> std::unique_ptr<PartRunner> {
    return std::make_unique<PartEngine<F, n>>(shared, own, region, exchange, std::move(names));
  });
}

/// The same with gains that know own agents and ghosts only, by their names in `Cast`.
template <class F>
std::unique_ptr<PartRunner> cast_engine(typename F::Gains gains, const Model& own, const Region& region,
                                        Exchange& exchange) {
  return part_engine<F>(std::move(gains), own, region, exchange, {region.names(), region.places()});
}

/// A set of agents in each state and message is the square of the network in bits.
/// @throws InvalidInput when `sets` of them for every own agent are more than memory holds
void require_sets(const std::string& which, const Region& region, double sets, int agents);

}  // namespace garrison::partition
