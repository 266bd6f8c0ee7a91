// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/table.hpp"

#include "recursion.hpp"
#include "require.hpp"

namespace garrison::certificate {
namespace {

/// Row m: what bounded noise adds over m lags.
Gains noise_sums(const Gains& w, const std::vector<Gains>& g, double bw, const VectorRef& bv) {
  Gains sums = Gains::Zero(w.rows() + 1, w.cols());
  for (Eigen::Index k = 0; k < w.rows(); ++k)
    sums.row(k + 1) = sums.row(k) + w.row(k) * bw + (g[static_cast<std::size_t>(k)] * bv).transpose();
  return sums;
}

}  // namespace

Table table(const Kernels& k, const TableOptions& options, double bw, const VectorRef& bv) {
  detail::require_table(k, options);
  detail::require_least("bw", bw, 0.0);
  detail::require_bounds("bv", bv, k.system.agents());
  detail::Recursion recursion(k, options, noise_sums(k.wb, k.gb, bw, bv), noise_sums(k.we, k.ge, bw, bv));
  const Vector b = bv;
  const Vector own = k.system.row_length * bw;
  const auto next = [&](const Vector& eta) { return recursion.inputs(eta + own, b); };
  Table t = recursion.run([&](int, const Vector& eta) { return next(eta); });
  t.steady = recursion.steady(t, next);
  return t;
}

}  // namespace garrison::certificate
