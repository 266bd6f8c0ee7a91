// SPDX-License-Identifier: Apache-2.0
#include "partition/families.hpp"

#include <limits>

#include "partition/families/part_family.hpp"

namespace garrison::partition {
namespace {

constexpr const PartFamily* kFamilies[] = {&saturation_parts, &scalar_gain_parts,     &rdkf_parts,
                                           &dkf_parts,        &partial_sharing_parts, &structural_parts};

const PartFamily& family_of(const std::string& name, const std::string& which = "filter.name") {
  std::string known;
  for (const PartFamily* one : kFamilies) {
    if (one->name == name) return *one;
    known += (known.empty() ? "" : ", ") + std::string(one->name);
  }
  refuse(which, "\"" + name + "\"", "a filter that runs on many ranks: " + known);
}

}  // namespace

void require_family(const std::string& family, const std::string& which) { family_of(family, which); }

void require_params(const std::string& family, const ParamMap& params, const Model& one) {
  family_of(family).require(params, one);
}

std::string needs_whole(const std::string& family, const ParamMap& params, int agents) {
  return family_of(family).needs_whole(params, agents);
}

int rounds_of(const std::string& family, const ParamMap& params) { return family_of(family).rounds(params); }

bool needs_connected(const std::string& family) { return family_of(family).connected; }

std::unique_ptr<PartRunner> part_runner(const std::string& family, const ParamMap& params, const Whole* whole,
                                        const Model& own, const Region& region, Exchange& exchange) {
  const std::string why = needs_whole(family, params, std::numeric_limits<int>::max());
  if (whole == nullptr && !why.empty()) refuse("filter", family + " without the whole network", why);
  return family_of(family).runner(params, whole, own, region, exchange);
}

void require_sets(const std::string& which, const Region& region, double sets, int agents) {
  require_memory(which, amount(region.own, "set") + " of " + amount(agents, "agent"),
                 sets * region.places() * agents / 8.0);
}

}  // namespace garrison::partition
