// SPDX-License-Identifier: Apache-2.0
// The families by name, for those who do not know their types.
#include "garrison/engine/any_filter.hpp"
#include "garrison/filters/families.hpp"

namespace garrison {

std::span<const FamilyInfo> families() {
  static const std::vector<FamilyInfo> all = [] {
    std::vector<FamilyInfo> list;
    Families::each([&]<class F> { list.push_back(family_info<F>()); });
    return list;
  }();
  return all;
}

std::shared_ptr<const AnyFilter> make_filter(const std::string& name, const ParamMap& params) {
  std::vector<std::string> known;
  for (const FamilyInfo& family : families()) {
    if (family.name == name) return family.make(params);
    known.push_back(family.name);
  }
  refuse_unknown("filter", name, known);
}

}  // namespace garrison
