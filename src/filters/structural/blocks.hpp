// SPDX-License-Identifier: Apache-2.0
// One agent's view: what it sees, and the directions in which a gain can act.
#pragma once

#include <Eigen/QR>
#include <string>

#include "core/solvers.hpp"
#include "garrison/filters/structural/setting.hpp"

namespace garrison::structural::detail {

/// D_i = sum of c_j c_j' over the agents j whose measurements i receives.
inline Matrix seen(const Setting& s, Eigen::Index i) {
  Matrix D = Matrix::Zero(s.n(), s.n());
  for (Eigen::Index j = 0; j < s.N(); ++j)
    if (s.U(i, j) != 0.0) D += s.C.row(j).transpose() * s.C.row(j);
  return D;
}

/// What a gain design needs of agent i, its gain being K_i = M B' on an orthonormal basis B of span{c_j}.
struct View {
  Matrix basis;  ///< B, n x d
  Matrix H;      ///< B'D_i, d x n
  Matrix noise;  ///< B'Rz_i B, d x d, Rz_i = sum c_j R_jl c_l' over what i receives
};

inline View view(const Setting& s, Eigen::Index i) {
  std::vector<Eigen::Index> heard;
  for (Eigen::Index j = 0; j < s.N(); ++j)
    if (s.U(i, j) != 0.0) heard.push_back(j);
  const auto m = static_cast<Eigen::Index>(heard.size());
  Matrix rows(m, s.n());
  Matrix R(m, m);
  for (Eigen::Index a = 0; a < m; ++a) {
    rows.row(a) = s.C.row(heard[static_cast<std::size_t>(a)]);
    for (Eigen::Index b = 0; b < m; ++b)
      R(a, b) =
          s.R.size() == 0 ? 0.0 : s.R(heard[static_cast<std::size_t>(a)], heard[static_cast<std::size_t>(b)]);
  }
  View v;
  const Eigen::JacobiSVD<Matrix> svd(rows, Eigen::ComputeThinV);
  const Vector values = svd.singularValues();
  Eigen::Index d = 0;
  while (d < values.size() && values(d) > 1e-13 * values(0)) ++d;
  if (values.size() == 0 || !(values(0) > 0.0)) d = 0;
  v.basis = svd.matrixV().leftCols(d);
  const Matrix CB = rows * v.basis;  // m x d
  v.H = CB.transpose() * rows;
  v.noise = CB.transpose() * R * CB;
  return v;
}

/// Pseudo-inverse of a symmetric positive semidefinite matrix, cut-off 1e-13 relative.
Matrix pseudo_inverse(const Matrix& S);

/// M of the gain that minimises the trace of (I - K D) P (I - K D)' + K Rz K': P H'(H P H' + B'Rz B)^+.
inline Matrix best_gain(const View& v, const Matrix& P) {
  const Matrix PH = P * v.H.transpose();
  return PH * pseudo_inverse(v.H * PH + v.noise);
}

/// What to do where no gains are found: about the states' units where these are far apart, else `otherwise`.
std::string advice(const Setting& s, const std::string& otherwise);

}  // namespace garrison::structural::detail
