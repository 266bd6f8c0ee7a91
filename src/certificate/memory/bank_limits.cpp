// SPDX-License-Identifier: Apache-2.0
#include "bank_limits.hpp"

#include <cmath>

namespace garrison::certificate::detail {
namespace {

/// Squared deviations, in those with which the rows of n steps see a coordinate, beyond which it counts as
/// unknown. Rows are tested with what rounding leaves of this: 1e-16 of it must stay far below 1.
constexpr double kKnown = 1e12;

/// The error P + Psi of a coordinate that is largest in that unit; -1 where all are known.
Eigen::Index least_known(const BankMember& m, const Vector& weight) noexcept {
  Eigen::Index at = -1;
  double most = kKnown;
  for (Eigen::Index i = 0; i < m.P.rows(); ++i) {
    const double spread = weight(i) * (m.P(i, i) + m.Psi.row(i).squaredNorm());
    if (spread <= most) continue;  // not a number is the most
    most = spread;
    at = i;
  }
  return at;
}

/// What lies along the free directions says nothing beside what is free: it is taken off, or in an unstable
/// plant it would grow until nothing else could be told from it.
void take_off_free(BankMember& m, const Vector& weight, Vector& along, Vector& moved) noexcept {
  for (int j = 0; j < m.free.count; ++j) {
    const auto u = m.free.U.col(j);
    along.array() = weight.array() * u.array();
    m.c -= along.dot(m.c) * u;
    for (Eigen::Index k = 0; k < m.Psi.cols(); ++k) m.Psi.col(k) -= along.dot(m.Psi.col(k)) * u;
    moved = m.P.lazyProduct(along);
    const double square = along.dot(moved);
    for (Eigen::Index k = 0; k < m.P.cols(); ++k)
      m.P.col(k) -= moved(k) * u + u(k) * moved - (square * u(k)) * u;
  }
}

}  // namespace

void forget_unknown(BankMember& m, const Vector& weight, Vector& room, Vector& other) noexcept {
  for (Eigen::Index at = least_known(m, weight); at >= 0; at = least_known(m, weight)) {
    // The column of what is very large points along it.
    room = m.P.col(at);
    for (Eigen::Index k = 0; k < m.Psi.cols(); ++k) room += m.Psi(at, k) * m.Psi.col(k);
    if (!m.free.add(room, weight)) {
      m.free.all(weight);
      m.c.setZero();
      m.P.setZero();
      m.Psi.setZero();
      return;
    }
    take_off_free(m, weight, room, other);
  }
  take_off_free(m, weight, room, other);
}

}  // namespace garrison::certificate::detail
