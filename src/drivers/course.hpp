// SPDX-License-Identifier: Apache-2.0
// What is known of a plant from sample to sample besides its constant part, for one trial. Internal to the
// drivers.
#pragma once

#include <optional>
#include <span>

#include "functions.hpp"
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
  bool plain() const { return !response_ && !functions_ && options_.series == nullptr; }
  /// Moves to sample t >= 1 and tells the network what has changed.
  void enter(int t, Runner& runner);
  /// Moves to sample t >= 1 where A and C do not change.
  void enter(int t);
  /// What the response to the inputs adds to every estimate at the present sample; null = nothing.
  const double* shift() const { return response_ ? response_->state().data() : nullptr; }
  /// Measurements without what the inputs add to them, or those that a linear plant would have given where
  /// the plant is nonlinear; `y` itself where they are the same.
  std::span<const double> without(std::span<const double> y);
  /// Adds to measurements of one agent, n_i numbers, what `without` takes away.
  void add(int agent, double* y) const;
  /// What is wrong with a response of this size, or with rows of this length, in words; empty = nothing.
  std::string doubt() const;

 private:
  const Matrix& rows() const;
  /// Puts every agent at f of its own estimate, and tells it the rows of h there: with A = I its prediction
  /// is f(xhat_i), and its innovation y_i - h_i(f(xhat_i)).
  void linearise(Runner& runner);

  /// Takes the covariances of the measurements of sample t.
  void weigh(int t);

  const Model& model_;
  const RunOptions& options_;
  std::optional<Response> response_;
  Matrix stacked_;
  Vector added_;  // at the present sample: C s, or h_i(x_i) - C_i x_i of every agent
  std::vector<double> rest_;
  double largest_ = 0.0;
  std::optional<Functions> functions_;
  Matrix identity_;
  Matrix linearised_;     // dh/dx at the predictions
  Vector variance_;       // of all outputs, where it changes
  Matrix whitener_;       // likewise
  Matrix predictions_;    // n x N
  double longest_ = 0.0;  // row of h so far
  int t_ = 0;
};

}  // namespace garrison::detail
