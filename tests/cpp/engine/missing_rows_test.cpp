// SPDX-License-Identifier: Apache-2.0
// One missing output of several: every family still uses the others. saturation and scalar_gain take the step
// of a sensor without its row; partial_sharing, whose gains are designed for all rows, takes it for met
// exactly. rdkf and dkf: filters/rdkf/missing_rows_test.cpp; lfre: filters/lfre_test.cpp.
#include <doctest/doctest.h>

#include <set>

#include "../every_filter.hpp"
#include "../random_system.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;
using namespace garrison::test;

namespace {

constexpr int kAgents = 4;

/// Agents with three outputs of uncorrelated noise each; without row `row` of agent 1 unless row < 0.
Model model_without(int n, int row) {
  Rng rng(static_cast<std::uint64_t>(90 + n));
  const Matrix A = 0.5 * Matrix::Identity(n, n) + 0.1 * normal_matrix(rng, n, n);
  std::vector<Matrix> C;
  Noise noise;
  noise.process_covariance = 0.1 * Matrix::Identity(n, n);
  for (int i = 0; i < kAgents; ++i) {
    const Matrix all = normal_matrix(rng, 3, n);
    std::vector<int> rows;
    for (int r = 0; r < 3; ++r)
      if (i != 1 || r != row) rows.push_back(r);
    const auto q = static_cast<Eigen::Index>(rows.size());
    C.push_back(all(rows, Eigen::all));
    noise.measurement_covariance.push_back(0.2 * Matrix::Identity(q, q));
  }
  return {A, C, noise};
}

/// y with output `row` of agent 1 where the agent predicts it from its start.
Matrix met(const Model& model, const Matrix& start, const Matrix& y, int row) {
  Matrix out = y;
  out(0, 3 + row) = model.C(1).row(row).dot(model.A() * start.col(1));
  return out;
}

}  // namespace

TEST_CASE("a missing output leaves the others in use, in every family with several outputs per agent") {
  std::set<std::string> compared;
  std::set<std::string> single;
  for (const auto& filter : every_filter(false))
    for (const int n : {1, 3, 9}) {
      Rng rng(7);
      const Network network = connected_network(rng, kAgents);
      const Model whole = model_without(n, -1);
      std::shared_ptr<const Prepared> prepared;
      try {
        prepared = filter->prepare(whole, network);
      } catch (const InvalidInput&) {
        single.insert(filter->name());
        continue;
      }
      if (filter->name() == "rdkf" || filter->name() == "dkf" || filter->name() == "lfre") continue;
      compared.insert(filter->name());
      RunOptions o;
      o.start = normal_matrix(rng, n, kAgents);
      if (filter->name() == "saturation" || filter->name() == "scalar_gain") o.start = o.start.col(0).eval();
      const Matrix y = normal_matrix(rng, 1, 3 * kAgents);
      for (int row = 0; row < 3; ++row)
        for (const double nothing : {kNaN, kInfinity, -1e200}) {
          Matrix gap = y;
          gap(0, 3 + row) = nothing;
          // A sensor of saturation limits what is infinite, it does not miss it.
          if (filter->name() == "saturation" && !std::isnan(nothing)) continue;
          std::vector<int> rest;
          for (int k = 0; k < y.cols(); ++k)
            if (k != 3 + row) rest.push_back(k);
          const Record got = replay(whole, network, *filter, gap, Matrix(), o);
          const Record right = filter->name() == "partial_sharing"
                                   ? replay(whole, network, *filter, met(whole, o.start, y, row), Matrix(), o)
                                   : replay(model_without(n, row), network, *filter, y(0, rest), Matrix(), o);
          double largest = 0.0;
          for (std::size_t k = 0; k < got.estimate.size(); ++k)
            largest = std::max(largest, std::abs(got.estimate[k] - right.estimate[k]));
          CAPTURE(filter->name());
          CAPTURE(n);
          CAPTURE(nothing);
          CHECK(largest <= 1e-12);
        }
    }
  for (const char* family : {"saturation", "scalar_gain", "partial_sharing"})
    CHECK(compared.contains(family));
  CHECK(single == std::set<std::string>{"structural"});
}
