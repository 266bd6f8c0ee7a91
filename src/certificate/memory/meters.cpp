// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/meters.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "../require.hpp"
#include "../top.hpp"
#include "garrison/certificate/kernels.hpp"
#include "garrison/core/budget.hpp"
#include "row_parts.hpp"
#include "undetectable_search.hpp"

namespace garrison::certificate {
namespace {

using detail::kNear;

bool of_full_rank(const Matrix& part) {
  if (part.rows() < part.cols()) return false;
  Eigen::ColPivHouseholderQR<Matrix> qr(part);
  qr.setThreshold(kNear);
  return qr.rank() == part.cols();
}

bool determines(const MatrixRef& H) {
  if (H.rows() < H.cols()) return false;
  const auto parts = detail::row_parts(H);
  return std::all_of(parts.begin(), parts.end(),
                     [&](const detail::RowPart& p) { return of_full_rank(H(p.rows, p.columns)); });
}

/// Projector onto the range of one part.
Matrix hat(const Matrix& part) {
  const Eigen::HouseholderQR<Matrix> qr(part);
  const Matrix Q = qr.householderQ() * Matrix::Identity(part.rows(), part.cols());
  return Q * Q.transpose();
}

/// The rows that are left; `out` need not be sorted.
template <class Index>
Matrix without(const MatrixRef& H, const std::vector<Index>& out) {
  Matrix rest(H.rows() - static_cast<Eigen::Index>(out.size()), H.cols());
  Eigen::Index at = 0;
  for (Eigen::Index r = 0; r < H.rows(); ++r)
    if (std::find(out.begin(), out.end(), static_cast<Index>(r)) == out.end()) rest.row(at++) = H.row(r);
  return rest;
}

[[noreturn]] void refuse_rank() {
  refuse("H", "rows that do not determine the state", "full column rank", "remove the reference");
}

void require_rows(const MatrixRef& H) {
  if (H.rows() < 1 || H.cols() < 1) refuse("H", detail::shape(H), "at least 1 x 1");
  detail::require_shape("H", H, H.rows(), H.cols());
  detail::require_room("H", static_cast<double>(H.rows()) * static_cast<double>(H.rows()));
}

}  // namespace

Meters meters(const MatrixRef& H, std::span<const int> source) {
  require_rows(H);
  const Eigen::Index m = H.rows();
  if (!source.empty() && static_cast<Eigen::Index>(source.size()) != m)
    refuse("source", std::to_string(source.size()), amount(m, "number"), "one per row");
  std::vector<std::vector<Eigen::Index>> rows_of;
  for (Eigen::Index r = 0; r < m; ++r) {
    const int of = source.empty() ? static_cast<int>(r) : source[static_cast<std::size_t>(r)];
    if (of < 0 || of >= static_cast<int>(m))
      refuse("source", std::to_string(of), "0.." + std::to_string(m - 1));
    if (rows_of.size() <= static_cast<std::size_t>(of)) rows_of.resize(static_cast<std::size_t>(of) + 1);
    rows_of[static_cast<std::size_t>(of)].push_back(r);
  }
  if (!determines(H)) refuse_rank();
  Matrix Lam = Matrix::Zero(m, m);
  for (const detail::RowPart& p : detail::row_parts(H)) Lam(p.rows, p.rows) = hat(H(p.rows, p.columns));
  const auto count = static_cast<Eigen::Index>(rows_of.size());
  const auto block_norm = [&](Eigen::Index a, Eigen::Index b) {
    return spectral_norm(Lam(rows_of[static_cast<std::size_t>(a)], rows_of[static_cast<std::size_t>(b)]));
  };
  Meters found;
  found.leverage.resize(count);
  std::vector<std::vector<double>> across(rows_of.size());
  for (Eigen::Index a = 0; a < count; ++a) {
    found.leverage(a) = block_norm(a, a);
    if (found.leverage(a) > 1.0 - kNear && !determines(without(H, rows_of[static_cast<std::size_t>(a)])))
      found.critical.push_back(static_cast<int>(a));
    for (Eigen::Index b = 0; b < count; ++b)
      if (b != a) across[static_cast<std::size_t>(a)].push_back(block_norm(a, b));
  }
  std::vector<double> leverages(found.leverage.begin(), found.leverage.end());
  const auto bound = [&](int k) {
    if (k == 0) return 0.0;
    double rows = 0.0;  // largest row sum of the block norms
    for (Eigen::Index a = 0; a < count; ++a)
      rows = std::max(rows, found.leverage(a) + detail::top(across[static_cast<std::size_t>(a)], k - 1));
    return std::min(detail::top(leverages, k), rows);
  };
  for (int k = 0; k <= std::min(static_cast<int>(count), 12); ++k) found.bound.push_back(bound(k));
  while (found.removable < static_cast<int>(count) && bound(found.removable + 1) < 1.0 - kNear)
    ++found.removable;
  return found;
}

SmallestAttack smallest_undetectable(const MatrixRef& H, int most, double tries) {
  require_rows(H);
  detail::require_least("most", most, 1);
  detail::require_least("tries", tries, 1.0);
  if (!(H.rowwise().norm().minCoeff() > 1.0 / kHuge))
    refuse("H", "a row of zeros", "rows that measure something");
  const Matrix unit = H.rowwise().normalized();
  std::vector<detail::Search> searches;  // the smallest set is one of a single part
  for (detail::RowPart& p : detail::row_parts(unit)) {
    Matrix part = unit(p.rows, p.columns);
    if (!of_full_rank(part)) refuse_rank();
    Matrix projector = hat(part);
    searches.emplace_back(
        std::move(p.rows), std::move(projector),
        [part = std::move(part)](const std::vector<int>& set) { return !determines(without(part, set)); },
        tries);
  }
  SmallestAttack found;
  bool complete = true;
  for (int k = 1; k <= std::min(most, static_cast<int>(H.rows())); ++k) {
    for (detail::Search& search : searches) {
      found.example = search.find(k, complete);
      if (!found.example.empty()) {
        found.size = k;
        return found;
      }
      if (!complete) return found;
    }
    found.searched = k;
  }
  return found;
}

}  // namespace garrison::certificate
