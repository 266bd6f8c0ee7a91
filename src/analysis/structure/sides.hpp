// SPDX-License-Identifier: Apache-2.0
// A pattern seen from its columns and from its rows.
#pragma once

#include <optional>

#include "garrison/analysis/structure/matching.hpp"

namespace garrison::structure {

/// The transposed pattern is made when it is first asked for, and only once.
class Sides {
 public:
  /// `pattern` must outlive this.
  explicit Sides(const Pattern& pattern) : columns_(&pattern) {}
  const Pattern& columns() const { return *columns_; }
  const Pattern& rows() {
    if (!rows_) rows_ = columns_->transposed();
    return *rows_;
  }

 private:
  const Pattern* columns_;
  std::optional<Pattern> rows_;
};

Matching maximum_matching(Sides& sides);

}  // namespace garrison::structure
