// SPDX-License-Identifier: Apache-2.0
// Two members of a bank become one, where their number costs too much.
#include <algorithm>
#include <iterator>

#include "../require.hpp"
#include "core/spectrum.hpp"
#include "ellipsoid_union.hpp"
#include "garrison/certificate/memory/bank.hpp"

namespace garrison::certificate {

void Bank::merge(int most, const WindowLevels& z) {
  detail::require_least("most", most, 1);
  detail::require_least("z2", z.z2, 0.0);
  const int n = states();
  detail::EllipsoidUnion both(n, 2);
  std::vector<int> sources;
  const auto together = [&](const BankMember& one, const BankMember& other) {
    sources.clear();
    std::set_union(one.left_out.begin(), one.left_out.end(), other.left_out.begin(), other.left_out.end(),
                   std::back_inserter(sources));
    return sources.size();
  };
  const auto add = [&](const BankMember& m) {
    Matrix shape(n, n);
    detail::outer_sum(m.Psi * m.Psi.transpose(), z.z2 * z.z2 * m.P, shape);
    both.add(m.c, shape, 1.0, shape.diagonal().cwiseMax(0.0).cwiseSqrt());
  };
  members_.resize(alive_);
  Region region = witness_.region;
  region.center.resize(n);
  while (members_.size() > static_cast<std::size_t>(most)) {
    BankMember first = std::move(members_.front());
    members_.erase(members_.begin());
    std::size_t at = 0;
    for (std::size_t k = 1; k < members_.size(); ++k) {
      const auto size = together(first, members_[k]);
      const auto least = together(first, members_[at]);
      if (size < least ||
          (size == least && (members_[k].c - first.c).norm() < (members_[at].c - first.c).norm()))
        at = k;
    }
    BankMember& other = members_[at];
    both.clear();
    const bool unknown = first.free.count > 0 || other.free.count > 0;
    add(first);
    add(other);
    both.hull(region);
    Matrix shape(n, n);
    both.shape(region, shape);
    both.enclose(shape, region);
    together(first, other);
    std::vector<int> accused;
    std::set_intersection(first.accused.begin(), first.accused.end(), other.accused.begin(),
                          other.accused.end(), std::back_inserter(accused));
    other.left_out = sources;
    other.accused = accused;
    other.P.setZero();
    detail::hear_nothing(other.heard);
    if (unknown) {
      other.free.all(weight_);
      other.Psi.setZero();
    } else {
      other.c = region.center;
      other.Psi = region.stretch * garrison::detail::covariance_root(region.shape);
    }
    std::rotate(members_.begin() + static_cast<std::ptrdiff_t>(at),
                members_.begin() + static_cast<std::ptrdiff_t>(at) + 1, members_.end());
  }
  alive_ = members_.size();
}

}  // namespace garrison::certificate
