// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include "garrison/core/model.hpp"

using namespace garrison;

namespace {
const Matrix kA = Matrix::Identity(2, 2);
const std::vector<Matrix> kC{Matrix::Ones(1, 2), Matrix::Identity(2, 2)};
Model with(Noise noise) { return {kA, kC, std::move(noise)}; }
}  // namespace

TEST_CASE("what is known of the noise must make sense") {
  const auto says = [](const Noise& noise, const char* words) {
    CHECK_THROWS_WITH_AS(with(noise), doctest::Contains(words), InvalidInput);
  };
  says({kInfinity, {}, {}, {}}, "process_bound: got inf, expected a finite number >= 0");
  says({kNaN, Vector::Ones(3), {}, {}}, "measurement_bound: got 3 numbers, expected one per agent (2)");
  says({kNaN, Vector{{0.1, -0.1}}, {}, {}}, "measurement_bound[1]: got -0.1");
  says({kNaN, Vector{{0.1, kInfinity}}, {}, {}}, "measurement_bound[1]: got inf");
  says({kNaN, {}, Matrix::Identity(3, 3), {}}, "process_covariance: got 3 x 3, expected 2 x 2");
  says({kNaN, {}, Matrix{{1, 2}, {0, 1}}, {}}, "not symmetric");
  says({kNaN, {}, Matrix{{1, 0}, {0, kNaN}}, {}}, "process_covariance[1, 1]: got nan");
  says({kNaN, {}, {}, {Matrix::Ones(1, 1)}}, "measurement_covariance: got 1 matrix");
  says({kNaN, {}, {}, {Matrix::Ones(1, 1), Matrix::Ones(1, 1)}}, "measurement_covariance[1]: got 1 x 1");
  says({kNaN, {}, {}, {-Matrix::Ones(1, 1), kA}}, "measurement_covariance[0]: got least eigenvalue -1");
}

TEST_CASE("a model keeps its rows flat, agent by agent") {
  const Model model = with({0.1, Vector{{0.2, 0.3}}, Matrix::Zero(2, 2), {}});
  CHECK(model.total_outputs() == 3);
  CHECK(model.offset(1) == 1);
  CHECK(model.measurement_bound() == 0.3);
  CHECK(std::isnan(with({}).measurement_bound()));
  Matrix stacked(3, 2);
  stacked << kC[0], kC[1];
  CHECK(model.stacked() == stacked);
  CHECK_THROWS_WITH_AS(Model(kA, {Matrix::Constant(1, 2, kInfinity)}),
                       doctest::Contains("C[0][0, 0]: got inf"), InvalidInput);
  CHECK_THROWS_AS(Model(Matrix(0, 0), kC), InvalidInput);
}
