// SPDX-License-Identifier: Apache-2.0
// The filter as a whole: (7) against least squares, penalties against each other, what is reported.
#include <doctest/doctest.h>

#include <Eigen/QR>

#include "garrison/drivers/simulate.hpp"
#include "garrison/filters/rdkf/steady_state.hpp"
#include "random_setting.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

double largest_gap(const Bulk<double>& a, const Bulk<double>& b) {
  REQUIRE(a.size() == b.size());
  double gap = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) gap = std::max(gap, std::abs(a[k] - b[k]));
  return gap;
}

std::shared_ptr<const AnyFilter> rdkf_with(double weight, const std::string& penalty) {
  return make_filter("rdkf", {{"weight", weight}, {"penalty", penalty}});
}

}  // namespace

TEST_CASE("the step of the distributed Kalman filter minimises (9)") {
  Rng rng(11);
  for (int instance = 0; instance < 30; ++instance) {
    const int n = whole(rng, 1, 9);
    const int N = whole(rng, 1, 5);
    const Model model = covariance_model(rng, n, N, uniform(rng, 0.3, 1.2));
    const Network network = connected_network(rng, N);
    const auto s = rdkf::setting(model, network);
    const auto steady = rdkf::steady_state(s);
    RunOptions o;
    o.start = normal_matrix(rng, n, N);
    const Matrix y = normal_matrix(rng, 1, model.total_outputs());
    const Record r = replay(model, network, *make_filter("dkf", {}), y, Matrix(), o);
    for (int i = 0; i < N; ++i) {
      // Stacked rows Sv^-1/2 (C x - y) and Pbar_j^-1/2 (x - A xhat_j) / sqrt(d_i).
      const auto& heard = s.neighbours[static_cast<std::size_t>(i)];
      const int q = model.outputs(i);
      Matrix rows(q + n * static_cast<int>(heard.size()), n);
      Vector right(rows.rows());
      rows.topRows(q) = s.M[static_cast<std::size_t>(i)];
      right.head(q) =
          s.whitener[static_cast<std::size_t>(i)] * y.row(0).segment(model.offset(i), q).transpose();
      for (std::size_t k = 0; k < heard.size(); ++k) {
        const auto j = static_cast<std::size_t>(heard[k]);
        const Matrix root = Eigen::LLT<Matrix>(steady.Pbar[j]).matrixL().solve(Matrix::Identity(n, n)) /
                            std::sqrt(static_cast<double>(heard.size()));
        rows.middleRows(q + n * static_cast<int>(k), n) = root;
        right.segment(q + n * static_cast<int>(k), n) = root * s.A * o.start.col(heard[k]);
      }
      const Vector best = Eigen::ColPivHouseholderQR<Matrix>(rows).solve(right);
      for (int k = 0; k < n; ++k) {
        const double got = r.estimate[static_cast<std::size_t>((N + i) * n + k)];
        CHECK(std::abs(got - best(k)) <= 1e-9 * (1.0 + best.norm()));
      }
    }
  }
}

TEST_CASE(
    "huber with a large weight is the Kalman filter; l1 of single sensors is the norm; weight 0 ignores "
    "all") {
  Rng rng(12);
  const int N = 5;
  const Model model = covariance_model(rng, 3, N, 1.03);
  const Network network = connected_network(rng, N);
  const Matrix y = normal_matrix(rng, 30, model.total_outputs());
  const auto run = [&](const AnyFilter& f, const Model& m) { return replay(m, network, f, y, Matrix(), {}); };
  const Record dkf = run(*make_filter("dkf", {}), model);
  CHECK(largest_gap(run(*rdkf_with(1e9, "huber"), model).estimate, dkf.estimate) <= 1e-10);
  for (const double v : run(*rdkf_with(0.0, "norm"), model).estimate) CHECK(v == 0.0);  // starts at 0
  Noise noise;
  noise.process_covariance = 0.3 * Matrix::Identity(3, 3);
  std::vector<Matrix> C;
  for (int i = 0; i < N; ++i) {
    C.push_back(normal_matrix(rng, 1, 3));
    noise.measurement_covariance.push_back(Matrix::Constant(1, 1, 0.4));
  }
  const Model single(model.A(), C, noise);
  const Matrix y1 = normal_matrix(rng, 30, N);
  const Record norm = replay(single, network, *rdkf_with(0.7, "norm"), y1, Matrix(), {});
  const Record l1 = replay(single, network, *rdkf_with(0.7, "l1"), y1, Matrix(), {});
  CHECK(largest_gap(norm.estimate, l1.estimate) <= 1e-9);
  // Nobody has neighbours: the group is the agent itself.
  const Model alone(model.A(), {model.C(0)},
                    {kNaN, {}, Matrix::Identity(3, 3), {Matrix::Identity(3, 3)}, {}});
  const Matrix y2 = normal_matrix(rng, 20, 3);
  CHECK(largest_gap(replay(alone, Network(1, {}), *rdkf_with(0.5, "norm"), y2, Matrix(), {}).estimate,
                    replay(alone, Network(1, {}), *rdkf_with(0.5, "group"), y2, Matrix(), {}).estimate) <=
        1e-12);
}

TEST_CASE(
    "who is pulled is suspected, who is not is cleared, and a majority that stays saturated gives a "
    "warning") {
  Rng rng(13);
  const int N = 4;
  Noise noise;
  noise.process_covariance = 0.1 * Matrix::Identity(2, 2);
  noise.measurement_covariance.assign(4, Matrix::Identity(1, 1));
  const std::vector<Matrix> C{Matrix{{1, 0}}, Matrix{{0, 1}}, Matrix{{1, 1}}, Matrix{{1, -1}}};
  const Model model(1.05 * Matrix::Identity(2, 2), C, noise);
  const Network network = Network::ring(N);
  const auto filter = rdkf_with(1.0, "norm");
  Matrix y = Matrix::Zero(40, N);
  y.col(2).segment(5, 6).setConstant(1e5);
  RunOptions o;
  o.keep.signals = true;
  const Record one = replay(model, network, *filter, y, Matrix(), o);
  CHECK(one.warnings.empty());
  const auto at = [&](const Record& r, int t, int i) {
    return r.verdict[static_cast<std::size_t>(t * N + i)];
  };
  CHECK(at(one, 6, 2) == static_cast<std::uint8_t>(Verdict::suspected));
  CHECK(at(one, 5, 2) == static_cast<std::uint8_t>(Verdict::cleared));
  y.bottomRows(35) = 1e5 * normal_matrix(rng, 35, N);
  const Record all = replay(model, network, *filter, y, Matrix(), o);
  REQUIRE(all.warnings.size() == 1);
  CHECK(all.warnings[0].find("saturated for 35 steps") != std::string::npos);
  for (std::size_t k = 0; k < all.statistic.size(); ++k)
    CHECK(all.statistic[k] <= all.threshold[k] * (1.0 + 1e-10) + 1e-12);
}

TEST_CASE("a neighbour that is silent counts as holding the own estimate") {
  Rng rng(14);
  const Model model = covariance_model(rng, 2, 2, 1.0);
  const Network network = Network::path(2);
  const auto filter = rdkf_with(1.0, "norm");
  RunOptions o;
  o.start = Matrix::Constant(2, 2, 0.7);  // both hold the same estimate at first
  const Matrix y = normal_matrix(rng, 1, model.total_outputs());
  const Record heard = replay(model, network, *filter, y, Matrix(), o);
  o.link.drop = 1.0;
  const Record unheard = replay(model, network, *filter, y, Matrix(), o);
  CHECK(unheard.link.lost == 2);
  CHECK(largest_gap(heard.estimate, unheard.estimate) <= 1e-13);
}
