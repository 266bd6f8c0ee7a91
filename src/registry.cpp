// SPDX-License-Identifier: Apache-2.0
// All filter families. A new one is declared and listed here.
#include <array>

#include "garrison/engine/any_filter.hpp"

namespace garrison {

FamilyInfo saturation_family();
FamilyInfo scalar_gain_family();
FamilyInfo lfre_family();
FamilyInfo rdkf_family();
FamilyInfo dkf_family();
FamilyInfo partial_sharing_family();
FamilyInfo structural_family();
FamilyInfo platoon_family();
FamilyInfo platoon_baseline_family();

std::span<const FamilyInfo> families() {
  static const std::array all{saturation_family(), scalar_gain_family(), lfre_family(),
                              rdkf_family(),       dkf_family(),         partial_sharing_family(),
                              structural_family(), platoon_family(),     platoon_baseline_family()};
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
