// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/coordinates.hpp"

#include <random>

#include "core/solvers.hpp"
#include "filters/saturation/cases.hpp"
#include "garrison/filters/saturation/feasibility.hpp"

namespace garrison::saturation {
namespace {

using namespace cases;

Matrix matrix(const Json& rows) {
  Matrix M(rows.size(), rows[0].size());
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    for (Eigen::Index k = 0; k < M.cols(); ++k)
      M(i, k) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  return M;
}

/// lambda0 (6) by enumeration, N <= 16.
double lambda0_of(const Matrix& C, int s) {
  double least = kInfinity;
  for (unsigned removed = 0; removed < (1u << C.rows()); ++removed) {
    if (__builtin_popcount(removed) != s) continue;
    Matrix sum = Matrix::Zero(C.cols(), C.cols());
    for (Eigen::Index i = 0; i < C.rows(); ++i)
      if (!(removed >> i & 1u)) sum += C.row(i).transpose() * C.row(i);
    least = std::min(least, Eigen::SelfAdjointEigenSolver<Matrix>(sum).eigenvalues()[0]);
  }
  return std::max(least, 0.0);
}

TEST_CASE(
    "saturation coordinates: diagonal scaling of the paper's system, figures of "
    "docs/filters/saturation.md#s-coordinates") {
  Matrix A(2, 2);
  A << 1.0, 0.1, 0.0, 1.0;
  Matrix C(30, 2);
  for (int i = 0; i < 30; ++i) C.row(i) << (i < 18), (i >= 18);
  const Vector b_v = Vector::Constant(30, 0.01);
  const Coordinates z = scale_states(A, C, 0.02, b_v, Eigen::Vector2d(1.0, 10.0));
  const double a = z.A.operatorNorm();
  CHECK(a == doctest::Approx(1.0050).epsilon(1e-4));
  CHECK(z.rows.C.isApprox(C));
  CHECK(z.b_w == doctest::Approx(0.2));
  CHECK(z.stretch == doctest::Approx(10.0));
  CHECK(z.shrink == doctest::Approx(1.0));
  CHECK(z.rows.b_v[0] == doctest::Approx(0.01));
  CHECK(z.rows.b_v[29] == doctest::Approx(0.1));  // velocities are ten times as large in z
  const Setting s{.agents = 30, .a = a, .lambda0 = 7.0, .attacked = 5};
  CHECK(minimal_rounds(s, 0.9256414492364503) == 59);
}

TEST_CASE("saturation coordinates: whitening makes (11) true on a narrow fan") {
  const Json c = load("07_lambda0_table")["inputs"]["items"];
  const auto fan =
      std::find_if(c.begin(), c.end(), [](const Json& item) { return item["name"] == "narrow fan n=2"; });
  REQUIRE(fan != c.end());
  const Matrix C = matrix((*fan)["C"]);
  const Coordinates z = whiten(matrix((*fan)["A"]), C, 0.01, Vector::Constant(C.rows(), 0.01));
  CHECK((z.T.transpose() * z.T).isApprox(C.transpose() * C, 1e-12));
  for (int s = 0; s <= 4; ++s) CHECK(lambda0_of(z.rows.C, s) > 15.0 * lambda0_of(C, s));
  CHECK(lambda0_of(C, 1) < 1.0);
  CHECK(lambda0_of(z.rows.C, 1) > 1.0);
}

TEST_CASE("saturation coordinates: trajectories and noise bounds carry over, 1000 random systems") {
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto filled = [&](int rows, int columns) {
    return Matrix(Matrix::NullaryExpr(rows, columns, [&] { return uniform(engine); }));
  };
  for (int trial = 0; trial < 1000; ++trial) {
    const int n = 1 + trial % 5;
    const int N = n + trial % 4;
    const Matrix A = filled(n, n), C = filled(N, n), T = filled(n, n) + 2.0 * Matrix::Identity(n, n);
    const Vector x = filled(n, 1), w = filled(n, 1), v = filled(N, 1);
    const Vector b_v = v.cwiseAbs();
    const Coordinates z = trial % 2 == 0 ? transform(A, C, w.norm(), b_v, T) : whiten(A, C, w.norm(), b_v);
    CHECK((z.T * z.T_inverse).isApprox(Matrix::Identity(n, n), 1e-8));
    CHECK((z.A * (z.T * x)).isApprox(z.T * (A * x), 1e-7));
    CHECK((z.T * w).norm() <= z.b_w * (1 + 1e-12));
    // Scaled measurement minus scaled noise is C_i z; the noise stays within its transformed bound.
    const Vector y = z.rows.scale.cwiseProduct(C * x + v);
    const Vector noise = y - z.rows.C * (z.T * x);
    CHECK((noise.cwiseAbs() - z.rows.b_v).maxCoeff() <= 1e-6 * (1.0 + y.norm()));
    for (int i = 0; i < N; ++i) CHECK(z.rows.C.row(i).norm() == doctest::Approx(1.0).epsilon(1e-13));
    CHECK(x.norm() <= z.shrink * (z.T * x).norm() * (1 + 1e-9));
    CHECK((z.T * x).norm() <= z.stretch * x.norm() * (1 + 1e-9));
  }
}

TEST_CASE("saturation coordinates: rows of any length, also very small and very large") {
  Matrix C(3, 2);
  C << 3.0, 4.0, 1e-200, 0.0, 0.0, -1e200;
  const UnitRows unit = normalise_rows(C, Eigen::Vector3d(0.5, 1e-201, 0.0));
  CHECK(unit.C.row(0).isApprox(Eigen::RowVector2d(0.6, 0.8)));
  CHECK(unit.C.row(1).isApprox(Eigen::RowVector2d(1.0, 0.0)));
  CHECK(unit.C.row(2).isApprox(Eigen::RowVector2d(0.0, -1.0)));
  CHECK(unit.b_v.isApprox(Eigen::Vector3d(0.1, 0.1, 0.0)));
  CHECK(unit.scale[0] == doctest::Approx(0.2));
}

TEST_CASE("saturation coordinates: bad input") {
  Matrix C = Matrix::Identity(3, 2);  // the last row is zero
  const Matrix A = Matrix::Identity(2, 2);
  const Vector b_v = Vector::Constant(3, 0.1);
  CHECK_THROWS_WITH_AS(normalise_rows(C, b_v), doctest::Contains("C[2]: got a zero row"), InvalidInput);
  C(2, 0) = kNaN;
  CHECK_THROWS_AS(normalise_rows(C, b_v), InvalidInput);
  C(2, 0) = 1.0;
  CHECK_NOTHROW(normalise_rows(C, b_v));
  CHECK_THROWS_AS(normalise_rows(C, Vector::Constant(2, 0.1)), InvalidInput);
  CHECK_THROWS_WITH_AS(normalise_rows(C, -b_v), doctest::Contains("b_v[0]: got -0.1"), InvalidInput);
  CHECK_THROWS_AS(transform(A, C, -1.0, b_v, A), InvalidInput);
  CHECK_THROWS_WITH_AS(transform(A, C, 0.1, b_v, Matrix::Ones(2, 2)), doctest::Contains("invertible"),
                       InvalidInput);
  CHECK_THROWS_WITH_AS(transform(A, C, 0.1, b_v, Matrix::Identity(3, 3)), doctest::Contains("T: got 3 x 3"),
                       InvalidInput);
  CHECK_THROWS_AS(scale_states(A, C, 0.1, b_v, Eigen::Vector2d(1.0, 0.0)), InvalidInput);
  C.col(1).setZero();
  CHECK_THROWS_WITH_AS(whiten(A, C, 0.1, b_v), doctest::Contains("positive definite"), InvalidInput);
  CHECK_THROWS_AS(whiten(A, Matrix::Ones(3, 3), 0.1, b_v), InvalidInput);
}

}  // namespace
}  // namespace garrison::saturation
