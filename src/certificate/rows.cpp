// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/rows.hpp"

#include <algorithm>
#include <cmath>

#include "require.hpp"

namespace garrison::certificate {
namespace {

constexpr int kMostSources = 1'000'000;

}  // namespace

Rows::Rows(int states, int sources, int capacity) {
  detail::require_least("states", states, 1);
  detail::require_least("sources", sources, 1);
  detail::require_least("capacity", capacity, 1);
  detail::require_room("rows", static_cast<double>(states) * capacity + sources);
  C_.resize(states, capacity);
  y_.resize(capacity);
  variance_.resize(capacity);
  width_.resize(capacity);
  source_.resize(static_cast<std::size_t>(capacity));
  count_.resize(static_cast<std::size_t>(sources));
}

void Rows::clear() {
  std::fill(count_.begin(), count_.end(), 0);
  size_ = 0;
  present_ = 0;
}

bool Rows::add(int source, std::span<const double> c, double y, double variance, double width) {
  if (source < 0 || source >= sources() || size_ == capacity() || static_cast<int>(c.size()) != states())
    return false;
  double largest = 0.0;
  for (const double entry : c) {
    if (!(std::abs(entry) <= kHuge)) return false;
    largest = std::max(largest, std::abs(entry));
  }
  if (largest == 0.0 || !(std::abs(y) <= kHuge) || !(variance > 0.0 && variance <= kHuge) ||
      !(width >= 0.0 && width <= kHuge))
    return false;
  C_.col(size_) = Eigen::Map<const Vector>(c.data(), C_.rows());
  y_(size_) = y;
  variance_(size_) = variance;
  width_(size_) = width;
  source_[static_cast<std::size_t>(size_)] = source;
  ++size_;
  if (count_[static_cast<std::size_t>(source)]++ == 0) ++present_;
  return true;
}

bool Rows::follow(const Rows& other) {
  const auto m = static_cast<std::size_t>(other.size_);
  const auto numbers = m * static_cast<std::size_t>(C_.rows());
  if (size_ == other.size_ && std::equal(source_.data(), source_.data() + m, other.source_.data()) &&
      std::equal(variance_.data(), variance_.data() + m, other.variance_.data()) &&
      std::equal(C_.data(), C_.data() + numbers, other.C_.data()))
    return false;
  size_ = other.size_;
  present_ = other.present_;
  std::copy_n(other.source_.data(), m, source_.data());
  std::copy_n(other.variance_.data(), m, variance_.data());
  std::copy_n(other.C_.data(), numbers, C_.data());
  count_ = other.count_;
  return true;
}

GivenRows given_rows(const VectorRef& y, const MatrixRef& C, const VectorRef& R, const VectorRef& widths,
                     std::span<const int> sources) {
  const Eigen::Index m = y.size();
  if (C.cols() < 1) refuse("C", detail::shape(C), "at least one column");
  detail::require_shape("C", C, m, C.cols());
  detail::require_bounds("R", R, m);
  if (m > 0 && !(R.minCoeff() > 0.0)) refuse("R", text(R.minCoeff()), "variances > 0");
  if (widths.size() > 0) detail::require_bounds("widths", widths, m);
  if (!sources.empty() && static_cast<Eigen::Index>(sources.size()) != m)
    refuse("sources", std::to_string(sources.size()), amount(m, "number"), "one per row");
  int most = static_cast<int>(m);
  for (const int source : sources) {
    if (source < 0 || source >= kMostSources)
      refuse("sources", std::to_string(source), "a number in 0.." + std::to_string(kMostSources - 1));
    most = std::max(most, source + 1);
  }
  GivenRows given{Rows(static_cast<int>(C.cols()), std::max(most, 1), std::max(static_cast<int>(m), 1)), {}};
  Vector row(C.cols());
  for (Eigen::Index j = 0; j < m; ++j) {
    row = C.row(j);
    const int source = sources.empty() ? static_cast<int>(j) : sources[static_cast<std::size_t>(j)];
    if (given.rows.add(source, {row.data(), static_cast<std::size_t>(row.size())}, y(j), R(j),
                       widths.size() > 0 ? widths(j) : 0.0))
      given.position.push_back(static_cast<int>(j));
  }
  return given;
}

}  // namespace garrison::certificate
