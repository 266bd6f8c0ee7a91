// SPDX-License-Identifier: Apache-2.0
// Certificates of runs whose C, or every matrix, changes from sample to sample: they hold at the edge of
// their promise, with losses and liars; with rows that do not change they are the same bits; what they cannot
// rest on is refused.
#include <doctest/doctest.h>

#include <cstring>
#include <iostream>

#include "../certificate/random_network.hpp"
#include "garrison/certificate/online/plan.hpp"
#include "garrison/drivers/simulate.hpp"

using namespace garrison;
using certificate::Spread;
using certificate::Wanted;

namespace {

constexpr std::uint64_t kSeed = 20261203;
#if defined(__SANITIZE_ADDRESS__)
constexpr int kSystems = 20;
#else
constexpr int kSystems = 120;
#endif
constexpr int kSteps = 25;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Case {
  Matrix A, root;
  Vector deviation;
  Model model;
  Network network;
  std::vector<int> outputs;
};

Case draw(test::Rng& rng) {
  const int n = test::whole(rng, 1, 3);
  Matrix A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
  A *= test::uniform(rng, 0.7, 1.1) / Eigen::JacobiSVD<Matrix>(A).singularValues()(0);
  const Matrix root = 0.2 * test::normal_matrix(rng, n, n);
  const int N = test::whole(rng, 4, 7);
  std::vector<Matrix> C, R;
  std::vector<int> outputs;
  std::vector<double> deviation;
  for (int i = 0; i < N; ++i) {
    outputs.push_back(test::whole(rng, 1, 2));
    C.push_back(test::normal_matrix(rng, outputs.back(), n));
    Vector variance(outputs.back());
    for (double& r : variance) {
      r = std::pow(10.0, test::uniform(rng, -1.0, 1.0));
      deviation.push_back(std::sqrt(r));
    }
    R.emplace_back(variance.asDiagonal());
  }
  Noise noise;
  noise.process_covariance = root * root.transpose();
  noise.measurement_covariance = R;
  return {A,
          root,
          Eigen::Map<Vector>(deviation.data(), static_cast<Eigen::Index>(deviation.size())),
          Model(A, C, noise),
          test::connected_network(rng, N, 0.7),
          outputs};
}

/// Random rows in every sample, some of them zero.
std::vector<Matrix> changing(test::Rng& rng, const Model& model) {
  std::vector<Matrix> C;
  for (int t = 0; t < kSteps; ++t) {
    C.push_back(test::normal_matrix(rng, model.total_outputs(), model.states()));
    for (Eigen::Index r = 0; r < C.back().rows(); ++r)
      if (test::whole(rng, 0, 9) == 0) C.back().row(r).setZero();
  }
  return C;
}

double edge(const certificate::Plan& plan) {
  double least = std::min({plan.z1, plan.z2_full, plan.z2_partial});
  if (plan.wanted.memory) least = std::min({least, plan.bank.z1.front(), plan.bank.z2, plan.bank.zc});
  return (1.0 - 1e-9) * least;
}

std::shared_ptr<const Prepared> prepared(const Case& d, int k) {
  Wanted wanted{k % 3 == 0 ? Spread::local : k % 3 == 1 ? Spread::direct : Spread::flooded, 1e-6, 1, 1000};
  wanted.memory = k % 2 == 0;
  const auto filter = make_filter("scalar_gain", {{"rounds", std::int64_t{3}}});
  return certified(*filter->prepare(d.model, d.network), wanted);
}

/// A, covariances of the process noise and variances of every sample, and roots of both.
struct Motion {
  std::vector<Matrix> A, root, deviation;
};
Motion motion(test::Rng& rng, const Case& d, bool moves) {
  Motion found;
  for (int t = 0; t < kSteps; ++t) {
    const double by = moves ? test::uniform(rng, 0.3, 3.0) : 1.0;
    const auto n = static_cast<int>(d.A.rows());
    found.A.push_back(moves ? Matrix(d.A + 0.3 * test::normal_matrix(rng, n, n)) : d.A);
    found.root.push_back(by * d.root);
    found.deviation.emplace_back(d.deviation);
    if (!moves) continue;
    for (double& one : found.deviation.back().reshaped()) one *= test::uniform(rng, 0.3, 3.0);
  }
  return found;
}

/// The blocks of all agents below each other.
Matrix blocks(const Model& model, const Vector& deviation) {
  Matrix all = Matrix::Zero(deviation.size(), 2);
  for (int i = 0; i < model.agents(); ++i)
    for (int r = 0; r < model.outputs(i); ++r)
      all(model.offset(i) + r, r) = deviation(model.offset(i) + r) * deviation(model.offset(i) + r);
  bool wide = false;
  for (int i = 0; i < model.agents(); ++i) wide = wide || model.outputs(i) > 1;
  return wide ? all : Matrix(all.leftCols(1));
}

struct Tally {
  int bounds = 0;
  int remembered = 0;
  double largest = 0.0;
};

/// Runs at the edge of their promise; moves: A and covariances change, too.
Tally at_the_edge(bool moves) {
  test::Rng rng(kSeed + (moves ? 10 : 0));
  Tally tally;
  auto& [bounds, remembered, largest] = tally;
  for (int k = 0; k < kSystems; ++k) {
    CAPTURE(k);
    const Case d = draw(rng);
    const auto design = prepared(d, k);
    const auto n = static_cast<int>(d.A.rows());
    const int liar = test::whole(rng, 0, d.model.agents() - 1);
    const auto C = changing(rng, d.model);
    const Motion now = motion(rng, d, moves);
    const Eigen::Index outputs = d.deviation.size();
    // Deviations of all noises of the run together: by Cauchy and Schwarz no event of any certificate fails.
    const Vector all = edge(*design->certificate()) *
                       test::unit_vector(rng, kSteps * static_cast<int>(outputs + d.root.cols()));
    Eigen::Index at = 0;
    const auto next = [&](Eigen::Index count) {
      at += count;
      return Vector(all.segment(at - count, count));
    };
    Rows y(kSteps, outputs);
    Rows truth(kSteps + 1, n);
    Vector x = 10.0 * test::normal_matrix(rng, n, 1);
    truth.row(0) = x.transpose();
    for (int t = 0; t < kSteps; ++t) {
      const auto here = static_cast<std::size_t>(t);
      x = now.A[here] * x + now.root[here] * next(d.root.cols());
      truth.row(t + 1) = x.transpose();
      const Vector v = now.deviation[here].cwiseProduct(next(outputs));
      y.row(t) = (C[static_cast<std::size_t>(t)] * x + v).transpose();
      for (int r = 0; r < d.outputs[static_cast<std::size_t>(liar)]; ++r)
        y(t, d.model.offset(liar) + r) += k % 4 < 2 ? 7.0 : 500.0;
    }
    RunOptions o;
    o.seed = static_cast<std::uint64_t>(k);
    o.keep.box = true;
    if (k % 5 > 1) o.link = {0.2, 0.1, 2, {{2, -1, 5, 9}}, {}};
    const auto series = std::make_shared<Series>();
    series->C = C;
    if (moves) {
      series->A = now.A;
      for (const Matrix& root : now.root) series->process_covariance.emplace_back(root * root.transpose());
      for (const Matrix& one : now.deviation) series->measurement_covariance.push_back(blocks(d.model, one));
    }
    o.series = series;
    const Record record = replay(*design, Log{y.data(), truth.data(), 1, kSteps}, o);
    const auto N = static_cast<std::size_t>(d.model.agents());
    for (std::size_t row = N; row < (kSteps + 1) * N; ++row) {
      CHECK(static_cast<CertificateKind>(record.bound_kind[row]) != CertificateKind::refuted);
      CHECK(static_cast<CertificateKind>(record.bound_kind[row]) != CertificateKind::varying);
      CHECK(std::isnan(record.published[row]));  // no theorem of the family covers it
      CHECK_FALSE(record.error[row] > record.bound[row]);
      for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j)
        CHECK_FALSE(std::abs(record.estimate[row * static_cast<std::size_t>(n) + j] -
                             truth(static_cast<Eigen::Index>(row / N), static_cast<Eigen::Index>(j))) >
                    record.box[row * static_cast<std::size_t>(n) + j]);
      if (!std::isfinite(record.bound[row])) continue;
      ++bounds;
      remembered += static_cast<CertificateKind>(record.bound_kind[row]) == CertificateKind::memory ? 1 : 0;
      largest = std::max(largest, record.error[row] / record.bound[row]);
    }
    for (const auto& one : record.doubted) CHECK(one.doubts.refuted + one.doubts.apart == 0);
    for (const auto& proof : record.proved)
      for (const auto& sources : proof.sets)
        for (const int source : sources) CHECK(source == liar);
  }
  std::cout << (moves ? "all that changes: " : "rows that change: ") << bounds << " bounds, " << remembered
            << " of them with memory, largest error/bound " << largest << "\n";
  return tally;
}

}  // namespace

TEST_CASE("certificates hold at the edge of their promise where rows change in every sample") {
  const Tally found = at_the_edge(false);
  CHECK(found.bounds > 60 * kSystems);
  CHECK(found.remembered > 20 * kSystems);
  CHECK(found.largest < 1.0);
}

TEST_CASE("certificates hold where A, C and both covariances change in every sample") {
  const Tally found = at_the_edge(true);
  CHECK(found.bounds > 50 * kSystems);
  CHECK(found.remembered > 20 * kSystems);
  CHECK(found.largest < 1.0);
}

TEST_CASE("where A or the process noise changes, no region of an earlier sample is relayed") {
  test::Rng rng(kSeed + 3);
  const Case d = draw(rng);
  const auto design = prepared(d, 1);  // direct: what is relayed is of earlier samples
  for (const bool process : {false, true}) {
    RunOptions o;
    const auto series = std::make_shared<Series>();
    if (process)
      series->process_covariance.assign(kSteps, d.root * d.root.transpose());
    else
      series->A.assign(kSteps, d.A);
    o.series = series;
    const PlantOptions plant{kSteps, Vector::Ones(d.A.rows()), 0.0, "normal"};
    const Record record = simulate(*design, plant, o);
    for (const std::uint8_t kind : record.bound_kind)
      CHECK(static_cast<CertificateKind>(kind) != CertificateKind::relayed);
  }
}

TEST_CASE(
    "rows over time that are the model's give the bits of a constant plant, and the model's come back") {
  test::Rng rng(kSeed + 1);
  for (int k = 0; k < 12; ++k) {
    CAPTURE(k);
    const Case d = draw(rng);
    const auto design = prepared(d, k);
    RunOptions o;
    o.seed = static_cast<std::uint64_t>(k);
    o.trials = 2;
    if (k % 4 > 1) o.link.drop = 0.2;
    const PlantOptions plant{kSteps, Vector::Ones(d.A.rows()), 0.0, "normal"};
    const Record constant = simulate(*design, plant, o);
    const auto series = std::make_shared<Series>();
    series->C.assign(kSteps, d.model.stacked());
    o.series = series;
    const Record varied = simulate(*design, plant, o);
    CHECK(std::memcmp(constant.bound.data(), varied.bound.data(), constant.bound.size() * sizeof(double)) ==
          0);
    CHECK(constant.bound_kind == varied.bound_kind);
  }
}

TEST_CASE("a certificate refuses variances of zero, correlated outputs, and rows that were not counted") {
  test::Rng rng(kSeed + 2);
  const Case d = draw(rng);
  const auto design = prepared(d, 0);
  const PlantOptions plant{kSteps, Vector::Ones(d.A.rows()), 0.0, "normal"};
  const auto refused = [&](const Series& series, const char* words) {
    RunOptions o;
    o.series = std::make_shared<Series>(series);
    CHECK_THROWS_WITH_AS(simulate(*design, plant, o), doctest::Contains(words), InvalidInput);
  };
  Series series;
  series.measurement_covariance.assign(kSteps, blocks(d.model, d.deviation));
  series.measurement_covariance.back()(0, 0) = 0.0;
  refused(series, "correlated outputs, or a variance of 0");
  series.measurement_covariance.back()(0, 0) = -1.0;
  refused(series, "measurement_covariance[24] of agent 0: got least eigenvalue");
  // A sensor that sees nothing in the model, but something in a sample.
  std::vector<Matrix> C;
  for (int i = 0; i < d.model.agents(); ++i) C.push_back(d.model.C(i));
  C.front().setZero();
  const Case blind{d.A, d.root, d.deviation, Model(d.A, C, d.model.noise()), d.network, d.outputs};
  const auto other = prepared(blind, 0);
  RunOptions o;
  const auto rows = std::make_shared<Series>();
  rows->C.assign(kSteps, d.model.stacked());
  o.series = rows;
  CHECK_THROWS_WITH_AS(simulate(*other, plant, o),
                       doctest::Contains("rows that are not zero where a sensor ever sees something"),
                       InvalidInput);
}
