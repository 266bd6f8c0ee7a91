// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/response.hpp"

namespace garrison {

Vector driven(const Matrix& A, const Vector& x, const Matrix& B, const VectorRef& u) {
  if (A.rows() != x.size() || A.cols() != x.size() || B.rows() != A.rows() || B.cols() != u.size())
    refuse("B",
           std::to_string(B.rows()) + " x " + std::to_string(B.cols()) + " for " + amount(x.size(), "state") +
               " and " + amount(u.size(), "input"),
           "a row per state and a column per input, and A " + std::to_string(x.size()) + " x " +
               std::to_string(x.size()));
  Matrix both(A.rows(), A.cols() + B.cols());
  both << A, B;
  Vector together(x.size() + u.size());
  together << x, u;
  return both * together;
}

Response::Response(const Model& model) : A_(model.A()), B_(model.B()), s_(Vector::Zero(model.states())) {}

void Response::advance(const VectorRef& u) { advance(A_, B_, u); }

void Response::advance(const Matrix& A, const Matrix& B, const VectorRef& u) {
  if (u.size() != B.cols())
    refuse("inputs", amount(u.size(), "number"), std::to_string(B.cols()) + ", one per column of B");
  if (!u.allFinite())
    refuse("inputs", "a number that is not finite at time " + std::to_string(t_), "known inputs at all times",
           "what is not known is process noise");
  s_ = driven(A, s_, B, u);
  ++t_;
  if (!(s_.cwiseAbs().maxCoeff() < kHuge))
    refuse("inputs", "a response beyond 1e150 at time " + std::to_string(t_), "a plant that stays finite");
}

}  // namespace garrison
