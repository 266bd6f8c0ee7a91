// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/scan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "require.hpp"

namespace garrison::certificate {
namespace {

struct Scan {
  std::vector<double> r, R, width;
  std::size_t need;
  double z2;
  std::vector<char> near_left, near_right;  // of the ends of the current elementary interval
  std::vector<char> set;
  std::vector<double> terms;

  std::size_t count() const { return static_cast<std::size_t>(std::count(set.begin(), set.end(), 1)); }

  /// F_S(x): the `need` largest (r_j - x)/R_j over S, and the room for noise over all of S.
  double F(double x) {
    terms.clear();
    double weight = 0.0;
    for (std::size_t j = 0; j < r.size(); ++j) {
      if (!set[j]) continue;
      terms.push_back((r[j] - x) / R[j]);
      weight += 1.0 / R[j];
    }
    std::partial_sort(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(need), terms.end(),
                      std::greater<>());
    double sum = 0.0;
    for (std::size_t j = 0; j < need; ++j) sum += terms[j];
    return sum + z2 * std::sqrt(weight);
  }

  /// Largest x of the relaxed set, -infinity when it is empty.
  double upper();
};

double Scan::upper() {
  const std::size_t m = r.size();
  std::vector<double> p;
  for (std::size_t j = 0; j < m; ++j) {
    p.push_back(r[j] - width[j]);
    p.push_back(r[j] + width[j]);
  }
  std::sort(p.begin(), p.end());
  p.erase(std::unique(p.begin(), p.end()), p.end());
  const double g = 1e-12 * (1.0 + std::max(std::abs(p.front()), std::abs(p.back())));
  const auto near = [&](double x, std::vector<char>& of) {
    of.resize(m);
    for (std::size_t j = 0; j < m; ++j)
      of[j] = static_cast<char>(r[j] - width[j] <= x + g && r[j] + width[j] >= x - g);
  };
  near(p.back(), near_right);
  set = near_right;  // the last end itself: an interval may be shorter than the guard
  if (count() >= need && F(p.back()) >= 0.0) return p.back();
  for (std::size_t k = p.size() - 1; k >= 1; --k) {
    near(p[k - 1], near_left);
    set.resize(m);
    for (std::size_t j = 0; j < m; ++j) set[j] = static_cast<char>(near_left[j] && near_right[j]);
    if (count() >= need) {
      double lo = p[k - 1];
      double hi = p[k];
      if (F(hi) >= 0.0) return hi;
      if (F(lo) >= 0.0) {
        while (true) {  // the outer end of the bisection: never inside the set
          const double mid = 0.5 * (lo + hi);
          if (!(mid > lo && mid < hi)) return hi;
          (F(mid) >= 0.0 ? lo : hi) = mid;
        }
      }
    }
    set = near_left;  // the isolated end itself: intervals may touch only there
    if (count() >= need && F(p[k - 1]) >= 0.0) return p[k - 1];
    std::swap(near_left, near_right);
  }
  return -kInfinity;
}

}  // namespace

Interval scan(const VectorRef& r, const VectorRef& R, int s, double z1, double z2) {
  detail::require_least("s", s, 0);
  detail::require_least("z1", z1, 0.0);
  detail::require_least("z2", z2, 0.0);
  detail::require_bounds("R", R, r.size());
  if (R.size() > 0 && !(R.minCoeff() > 1.0 / kHuge)) refuse("R", text(R.minCoeff()), "variances > 1e-150");
  Scan one;
  for (Eigen::Index j = 0; j < r.size(); ++j) {
    if (!(std::abs(r(j)) <= kHuge)) continue;
    one.r.push_back(r(j));
    one.R.push_back(R(j));
    one.width.push_back(z1 * std::sqrt(R(j)));
  }
  if (static_cast<std::size_t>(s) >= one.r.size()) return {};
  one.need = one.r.size() - static_cast<std::size_t>(s);
  one.z2 = z2;
  const double hi = one.upper();
  for (double& value : one.r) value = -value;
  const double lo = -one.upper();
  return lo <= hi ? Interval{lo, hi} : Interval{kNaN, kNaN};
}

}  // namespace garrison::certificate
