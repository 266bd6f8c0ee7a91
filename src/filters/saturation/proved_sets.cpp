// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/proved_sets.hpp"

#include "certificate/memory/choices.hpp"
#include "garrison/certificate/informed.hpp"

namespace garrison::saturation {
namespace {

/// Sets times the cube of all numbers: above it design would take minutes.
constexpr double kMostWork = 1e8;
constexpr int kMostSteps = 128;
/// Of the errors at t0, so much may be left after the last step (largest row sum).
constexpr double kForgotten = 1e-3;

struct OfSet {
  certificate::Gains fade, noise;
};

/// Both parts of theorem I, by asking it for one without the other.
OfSet of_set(const certificate::ErrorSystem& system, double b_w, const VectorRef& b_v) {
  const Vector nothing = Vector::Zero(b_v.size());
  const Vector ones = Vector::Ones(b_v.size());
  for (int steps = 4;; steps *= 2) {
    OfSet found{certificate::informed(system, ones, steps, 0.0, nothing), {}};
    const double left = found.fade.row(steps - 1).maxCoeff();
    if (left >= kForgotten && steps < kMostSteps && left < 1e9) continue;
    found.noise = certificate::informed(system, nothing, steps, b_w, b_v);
    return found;
  }
}

}  // namespace

ProvedSets proved_sets(const MatrixRef& A, const MatrixRef& C, const MatrixRef& J, int s, int diameter,
                       int rounds, double process_bound, const VectorRef& measurement_bound) {
  std::vector<int> sensors;
  for (Eigen::Index i = 0; i < C.rows(); ++i)
    if (!C.row(i).isZero(0.0)) sensors.push_back(static_cast<int>(i));
  const int m = static_cast<int>(sensors.size());
  const double numbers = static_cast<double>(A.rows() * C.rows());
  if (s < 1 || s > m || certificate::detail::choices(m, s) * numbers * numbers * numbers > kMostWork)
    return {};
  ProvedSets found;
  found.s = s;
  found.spread = certificate::lists_complete(0, diameter, rounds);
  found.first.push_back(0);
  std::vector<OfSet> all;
  std::vector<char> in(static_cast<std::size_t>(C.rows()), 0);
  certificate::detail::each_choice<char>(sensors, s, in, 1, [&] {
    const std::size_t begin = found.ids.size();
    for (std::size_t i = 0; i < in.size(); ++i)
      if (in[i] != 0) found.ids.push_back(static_cast<int>(i));
    const std::span<const int> silent(found.ids.data() + begin, static_cast<std::size_t>(s));
    all.push_back(of_set(certificate::error_system(A, C, J, silent), process_bound, measurement_bound));
    found.first.push_back(found.first.back() + static_cast<int>(all.back().fade.rows()));
    return true;
  });
  found.fade.resize(found.first.back(), C.rows());
  found.noise.resize(found.first.back(), C.rows());
  found.later.resize(3, found.sets());
  for (int k = 0; k < found.sets(); ++k) {
    const OfSet& one = all[static_cast<std::size_t>(k)];
    found.fade.middleRows(found.first[static_cast<std::size_t>(k)], one.fade.rows()) = one.fade;
    found.noise.middleRows(found.first[static_cast<std::size_t>(k)], one.noise.rows()) = one.noise;
    found.later.col(k) << one.fade.maxCoeff(), one.noise.maxCoeff(),
        one.fade.row(one.fade.rows() - 1).maxCoeff();
  }
  return found;
}

}  // namespace garrison::saturation
