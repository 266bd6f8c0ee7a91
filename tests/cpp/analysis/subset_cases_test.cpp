// SPDX-License-Identifier: Apache-2.0
// The table of lambda_0, varpi and tau_0 of the reference cases, and the closed form for orthogonal rows.
#include <doctest/doctest.h>

#include "../filters/saturation/cases.hpp"
#include "../random_system.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/analysis/subsets.hpp"

using namespace garrison;
using namespace garrison::saturation::cases;

TEST_CASE("the table of subset searches") {
  const Json table = load("07_lambda0_table");
  const Json& items = table["inputs"]["items"];
  REQUIRE(items.size() > 30);
  for (std::size_t k = 0; k < items.size(); ++k) {
    const Json& expected = table["expected"]["items"][k];
    const Matrix C = matrix(items[k]["C"]);
    const Matrix A = matrix(items[k]["A"]);
    const int s = items[k]["s"];
    CAPTURE(items[k]["name"].get<std::string>());
    CAPTURE(s);
    const auto found = lambda0(C, s);
    CHECK(found.exact);
    CHECK(std::abs(found.lower - number(expected["lambda0"])) <= 1e-9);
    CHECK(agree(varpi(C, A, s).upper, expected["varpi"]));
    CHECK(agree(tau0(C, A, s).upper, expected["tau0"]));
    CHECK(one_step_sparse_observable(C, s) == expected["one_step_s_sparse"].get<bool>());
    if (expected.contains("s_sparse_observable"))
      CHECK(s_sparse_observable(A, C, s) == expected["s_sparse_observable"].get<bool>());
    if (expected.contains("one_step_2s_sparse"))
      CHECK((2 * s <= C.rows() && one_step_sparse_observable(C, 2 * s)) ==
            expected["one_step_2s_sparse"].get<bool>());
    const auto closed = lambda0_orthogonal(C, s);
    if (expected.contains("orthogonal_closed_form") && !expected["orthogonal_closed_form"].is_null()) {
      REQUIRE(closed.has_value());
      CHECK(std::abs(*closed - number(expected["orthogonal_closed_form"])) <= 1e-12);
    }
    if (closed) CHECK(std::abs(*closed - found.lower) <= 1e-9);
  }
}

TEST_CASE("the closed form for parallel or orthogonal rows equals the search") {
  test::Rng rng(17);
  for (int instance = 0; instance < 100; ++instance) {
    const int n = test::whole(rng, 1, 4);
    const int N = test::whole(rng, n, 12);
    const int s = test::whole(rng, 0, N);
    const Matrix basis =
        Eigen::JacobiSVD<Matrix>(test::normal_matrix(rng, n, n), Eigen::ComputeFullU).matrixU();
    Matrix C(N, n);
    for (int i = 0; i < N; ++i)
      C.row(i) = (test::whole(rng, 0, 1) == 0 ? -1.0 : 1.0) * basis.row(test::whole(rng, 0, n - 1));
    const auto closed = lambda0_orthogonal(C, s);
    CAPTURE(instance);
    REQUIRE(closed.has_value());
    CHECK(std::abs(*closed - lambda0(C, s).lower) <= 1e-9);
  }
  CHECK(!lambda0_orthogonal(Matrix{{1, 0}, {0.6, 0.8}}, 0).has_value());
}
