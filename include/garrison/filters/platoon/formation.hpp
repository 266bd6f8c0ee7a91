// SPDX-License-Identifier: Apache-2.0
// Where the string should be, and Algorithm 3 that steers it there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "garrison/filters/platoon/setting.hpp"

namespace garrison::platoon {

/// Position (m) and velocity (m/s) of one vehicle.
struct Motion {
  double s;
  double v;

  template <class V>
  void visit(V& visitor) {
    visitor("s", s);
    visitor("v", v);
  }
};

/// Reference x_0(t), spacing and gains of Algorithm 3, which all vehicles know.
struct Formation {
  std::vector<Motion> reference;  ///< x_0(0), x_0(1), ...; at constant velocity after the last one
  double period = kNaN;           ///< T
  double spacing = kNaN;          ///< x_i^*(t) = x_0(t) - (i spacing, 0), i = 0..N-1
  double gs = kNaN;               ///< g_s > 0
  double gv = kNaN;               ///< g_v > T g_s

  template <class V>
  void visit(V& v) {
    v("reference", reference);
    v("period", period);
    v("spacing", spacing);
    v("gs", gs);
    v("gv", gv);
  }

  /// False: there is nothing to steer by, the vehicles are only observed.
  bool steers() const noexcept { return !std::isnan(gs); }
  Motion reference_at(std::int64_t t) const noexcept {
    const auto known = static_cast<std::int64_t>(reference.size());
    if (t < known) return reference[static_cast<std::size_t>(t)];
    const Motion last = reference.back();
    return {last.s + static_cast<double>(t - known + 1) * period * last.v, last.v};
  }
  /// x_i^*(t).
  Motion desired(int id, std::int64_t t) const noexcept {
    const Motion x0 = reference_at(t);
    return {x0.s - id * spacing, x0.v};
  }
  /// One term of u_i in Algorithm 3: vehicle i at `own`, its neighbour (`places` behind it: -1 or 1) at
  /// `other`; Delta_{j,i} read as x_i^* - x_j^*, as its proof has it.
  double pull(const Motion& own, const Motion& other, int places) const noexcept {
    return gs * (other.s - own.s + places * spacing) + gv * (other.v - own.v);
  }
};

/// `reference`: s, v, s, v, ... for times 0, 1, ...; at least one pair. Refuses bad numbers and gains that
/// violate Assumption 4 for N vehicles. `owner` names the filter in messages. @throws InvalidInput
GARRISON_EXPORT Formation formation(const std::string& owner, const std::vector<double>& reference,
                                    double spacing, double gs, double gv, double period, int vehicles);

}  // namespace garrison::platoon
