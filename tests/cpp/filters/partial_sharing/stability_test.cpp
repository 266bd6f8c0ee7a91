// SPDX-License-Identifier: Apache-2.0
// gamma* (22) where some agent does not see the whole state.
#include <doctest/doctest.h>

#include "garrison/filters/partial_sharing/errors.hpp"
#include "random_setting.hpp"

using namespace garrison;

TEST_CASE("gamma* of an agent whose rows do not span the state is exactly 0, of full ones it is positive") {
  test::Rng rng(5);
  for (int k = 0; k < 50; ++k) {
    const int n = test::whole(rng, 2, 5);
    const int N = test::whole(rng, 2, 4);
    const bool deficient = k % 2 == 0;
    Noise noise;
    noise.process_covariance = Matrix::Identity(n, n);
    std::vector<Matrix> C;
    for (int i = 0; i < N; ++i) {
      const int rows = deficient && i == 0 ? n - 1 : n;
      C.push_back(test::normal_matrix(rng, rows, n));
      noise.measurement_covariance.push_back(Matrix::Identity(rows, rows));
    }
    const Model model(0.5 * Matrix::Identity(n, n), C, noise);
    const auto s = partial_sharing::make_setting({}, model, test::connected_network(rng, N));
    const double star = partial_sharing::gamma_star(s, partial_sharing::steady_gains(s), s.shared_fraction());
    CAPTURE(k);
    CHECK((deficient ? star == 0.0 : star > 0.0));
  }
}
