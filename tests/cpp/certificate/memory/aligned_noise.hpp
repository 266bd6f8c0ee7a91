// SPDX-License-Identifier: Apache-2.0
// The worst noise that the events of a bank allow: all of it at the edge, pulling one way.
#pragma once

#include <Eigen/QR>
#include <utility>
#include <vector>

#include "garrison/certificate/memory/window.hpp"

namespace garrison::test {

/// Deviations of all noises of a run, of unit variance.
struct NoiseCourse {
  Matrix v;  ///< step x output
  Matrix w;  ///< step x process noise: row t leads to step t + 1
};

/// Noises whose deviations are `length` long in all, and that move the error of least squares over the rows
/// that are `used(step, output)` furthest in one direction, at the last step. No event of theorem B fails
/// whose levels are all at least `length`: by Cauchy and Schwarz, at no step. C: output x n.
template <class Used>
NoiseCourse aligned_noise(const Matrix& A, const Matrix& root, const Matrix& C, const Vector& R, int steps,
                          const Vector& direction, double length, const Used& used) {
  const auto outputs = static_cast<int>(C.rows());
  const auto inputs = static_cast<int>(root.cols());
  const Eigen::Index n = A.rows();
  certificate::Window window(static_cast<int>(n), inputs, steps, outputs, steps * outputs);
  window.begin(steps);
  std::vector<std::pair<int, int>> measured;
  for (int t = 0; t < steps; ++t) {
    if (t > 0) window.advance(A, root, Vector::Zero(n));
    for (int r = 0; r < outputs; ++r) {
      const Vector c = C.row(r).transpose();
      if (used(t, r) && window.add(r, {c.data(), static_cast<std::size_t>(n)}, 0.0, R(r)))
        measured.emplace_back(t, r);
    }
  }
  Matrix N(window.rows(), window.unknowns());
  for (int r = 0; r < window.rows(); ++r) N.row(r) = window.N(r).transpose();
  const Vector scale = N.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const Matrix solved = Matrix(N * scale.asDiagonal())
                            .colPivHouseholderQr()
                            .solve(Matrix(Matrix::Identity(window.rows(), window.rows())));
  Vector eps = (window.E() * scale.asDiagonal() * solved).transpose() * direction;
  eps *= length / eps.norm();
  NoiseCourse course{Matrix::Zero(steps, outputs), Matrix::Zero(steps, inputs)};
  std::size_t at = 0;
  for (int r = 0; r < window.rows(); ++r) {
    if (window.source(r) >= 0) {
      course.v(measured[at].first, measured[at].second) = eps(r);
      ++at;
      continue;
    }
    Eigen::Index k = n;  // 0 = w~ + eps
    while (window.N(r)(k) == 0.0) ++k;
    course.w((k - n) / inputs, (k - n) % inputs) = -eps(r);
  }
  return course;
}

}  // namespace garrison::test
