// SPDX-License-Identifier: Apache-2.0
// Filters that together take every path of every family that watches one common plant.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "garrison/engine/any_filter.hpp"

namespace garrison::test {

/// `bounded`: also those that need the model's noise bounds. The families of vehicles have tests of their own
/// (filters/platoon/random_platoon.hpp); a test fails where a family is in neither list.
inline std::vector<std::shared_ptr<const AnyFilter>> every_filter(bool bounded = true) {
  std::vector<std::shared_ptr<const AnyFilter>> all{
      make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}}),
      make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{4}}, {"chebyshev", true}}),
      make_filter("scalar_gain", {{"rounds", std::int64_t{2}}}),
      make_filter("lfre", {}),
      make_filter("dkf", {}),
      make_filter("rdkf", {{"weight", 0.5}}),
      make_filter("rdkf", {{"weight", 0.5}, {"penalty", std::string("l1")}}),
      make_filter("rdkf", {{"weight", 0.5}, {"penalty", std::string("group")}}),
      make_filter("structural", {}),
      make_filter("structural",
                  {{"window", std::int64_t{3}}, {"isolate", true}, {"settle", std::int64_t{0}}}),
      make_filter("partial_sharing", {{"gain", 0.1}, {"starts", "coordinated"}, {"shared", std::int64_t{1}}}),
      make_filter("partial_sharing", {{"gain", 0.1}, {"gains", "varying"}})};
  if (bounded) {
    const ParamMap base{{"rounds", std::int64_t{12}}, {"attacked", std::int64_t{2}}, {"initial_error", 2.0}};
    ParamMap detector = base;
    detector.insert({{"threshold", 0.5}, {"detector", true}});
    ParamMap adaptive = base;
    adaptive.insert({"adaptive", true});
    all.push_back(make_filter("saturation", detector));
    all.push_back(make_filter("saturation", adaptive));
    ParamMap gaussian = detector;
    gaussian.insert({{"table", true}, {"failure", 1e-3}, {"horizon", std::int64_t{15}}});
    all.push_back(make_filter("saturation", gaussian));
    for (ParamMap* lossy : {&detector, &adaptive}) {
      lossy->insert({{"table", true}, {"recovery", true}});
      all.push_back(make_filter("saturation", *lossy));
    }
    all.push_back(
        make_filter("rdkf", {{"weight", 0.5}, {"penalty", std::string("huber")}, {"initial_error", 2.0}}));
  }
  // A family without a line above runs as it comes, where it can.
  for (const FamilyInfo& family : families()) {
    const bool listed =
        std::any_of(all.begin(), all.end(), [&](const auto& f) { return f->name() == family.name; });
    const bool needs =
        std::any_of(family.params.begin(), family.params.end(), [](const auto& p) { return p.required; });
    if (listed || needs) continue;
    if (auto filter = family.make({}); !filter->own_states()) all.push_back(std::move(filter));
  }
  return all;
}

}  // namespace garrison::test
