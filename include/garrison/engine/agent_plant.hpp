// SPDX-License-Identifier: Apache-2.0
// The plant of one agent on its own: its design's, or the one that it was told of.
#pragma once

#include "garrison/core/change.hpp"
#include "garrison/engine/agent.hpp"

namespace garrison {

/// Threads: several may read; whoever changes it is alone.
class AgentPlant {
 public:
  /// Another plant: matrices of this agent alone, null = the design's; Q is a covariance, whoever tells it
  /// sees to that. Refused, with nothing changed: size, number.
  Refusal take(const Change& told, const AgentPart& who, Local& local) {
    const auto n = who.A.rows();
    const auto q = who.C_transposed.cols();
    for (const auto& [given, rows, cols] :
         {Expected{told.A, n, n}, {told.C, q, n}, {told.Q, n, n}, {told.W, q, q}}) {
      if (given == nullptr) continue;
      if (given->rows() != rows || given->cols() != cols) return Refusal::size;
      if (!(given->array().abs() < kHuge).all()) return Refusal::number;  // nor nan
    }
    A_ = told.A != nullptr ? *told.A : who.A;
    C_transposed_ = told.C != nullptr ? Matrix(told.C->transpose()) : who.C_transposed;
    change_ = {};
    keep(told.Q, Q_, change_.Q);
    keep(told.W, W_, change_.W);
    local.A = A_.data();
    local.C = C_transposed_.data();
    varying_ = true;
    return Refusal::none;
  }
  /// Back to the design's.
  void constant(const AgentPart& who, Local& local) noexcept {
    local = local_of(who);
    change_ = {};
    varying_ = false;
  }
  bool varying() const noexcept { return varying_; }
  /// Covariances that are not the design's.
  const Change& change() const noexcept { return change_; }

 private:
  struct Expected {
    const Matrix* given;
    Eigen::Index rows, cols;
  };
  static void keep(const Matrix* given, Matrix& own, const Matrix*& told) {
    if (given == nullptr) return;
    own = *given;
    told = &own;
  }

  Matrix A_, C_transposed_, Q_, W_;
  Change change_;  // into them
  bool varying_ = false;
};

}  // namespace garrison
