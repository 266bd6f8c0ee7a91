// SPDX-License-Identifier: Apache-2.0
// What is known of a plant from sample to sample besides its constant part, for one trial. Internal to the
// drivers.
#pragma once

#include <optional>
#include <span>

#include "garrison/core/response.hpp"
#include "garrison/drivers/simulate.hpp"

namespace garrison::detail {

/// Refuses inputs and matrices over time that do not fit the model, the steps or the filter. @throws
/// InvalidInput
void require_course(const Prepared& prepared, const RunOptions& options, int steps);

class Course {
 public:
  Course(const Model& model, const RunOptions& options);

  /// Nothing is known but the model.
  bool plain() const { return !response_ && options_.series == nullptr; }
  /// Moves to sample t >= 1 and tells the network what has changed.
  void enter(int t, Runner& runner);
  /// Moves to sample t >= 1 where A and C do not change.
  void enter(int t);
  /// What the response to the inputs adds to every estimate at the present sample; null = nothing.
  const double* shift() const { return response_ ? response_->state().data() : nullptr; }
  /// Measurements without what the inputs add to them; `y` itself where there are none.
  std::span<const double> without(std::span<const double> y);
  /// Adds to measurements of one agent, n_i numbers, what the inputs add to them.
  void add(int agent, double* y) const;
  /// Digits that double precision leaves of a response of this size are told in words; empty = enough.
  std::string doubt() const;

 private:
  const Matrix& rows() const;

  const Model& model_;
  const RunOptions& options_;
  std::optional<Response> response_;
  Matrix stacked_;
  Vector added_;  // C s at the present sample
  std::vector<double> rest_;
  double largest_ = 0.0;
  int t_ = 0;
};

}  // namespace garrison::detail
