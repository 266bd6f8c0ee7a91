// SPDX-License-Identifier: Apache-2.0
// The step where some outputs of a sensor are missing: its factors without their rows, made when needed.
#pragma once

#include <vector>

#include "garrison/filters/rdkf/box_step.hpp"
#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

/// What design keeps of a sensor with several outputs; empty for one with none or one, which is there or not.
struct SensorRows {
  Matrix S;  ///< q x q, Sv
  Matrix C;  ///< q x n

  template <class V>
  void visit(V& v) {
    v("S", S);
    v("C", C);
  }
};

/// Factors of one sensor's step as if it had its present rows only: whitener, M and the rest from the block
/// of Sv and the rows of C that belong to them. They keep their full shape, missing rows being zeros, so that
/// nothing is allocated after `resize`; and they are kept for as long as the same rows are missing.
/// Threads: one at a time.
class PartialStep {
 public:
  /// `box`: for penalty l1, else for the others.
  void resize(const SensorRows& sensor, bool box);

  /// @param sensor as given to `resize`
  /// @param L n x n, lower Cholesky factor of Q; @param present a flag per row, at least one of them set
  /// @param penalty as in step_factors
  const StepFactors& step(const SensorRows& sensor, const Matrix& L, Penalty penalty,
                          const char* present) noexcept;
  const BoxFactors& box(const SensorRows& sensor, const Matrix& L, const char* present) noexcept;

 private:
  bool start(const char* present) noexcept;
  void whiten(const SensorRows& sensor) noexcept;

  StepFactors step_;
  BoxFactors box_;
  std::vector<char> made_;  // the rows that the factors are of
  std::vector<int> row_;    // of each present output, in order
  int count_ = 0;
  Matrix root_;  // whitener of the present rows, top left
  Aligned<double> room_;
};

}  // namespace garrison::rdkf
