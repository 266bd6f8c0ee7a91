// SPDX-License-Identifier: Apache-2.0
// Banks whose members do not see an unstable state: what they do not know grows until arithmetic drowns in
// it.
#include <doctest/doctest.h>

#include <iostream>

#include "../random_network.hpp"
#include "garrison/certificate/memory/bank.hpp"

using namespace garrison;
using namespace garrison::certificate;

namespace {

constexpr std::uint64_t kSeed = 20261203;
constexpr WindowLevels kLevels{6.5, 6.5, 6.5, kNaN};

double normal(test::Rng& rng) { return std::normal_distribution<>()(rng); }

/// x = T z with an unstable z_0; rows that see everything, and rows that do not see z_0.
struct Hidden {
  Matrix A, T;
  BankSource all, rest;
};

Hidden draw(test::Rng& rng) {
  const int n = test::whole(rng, 2, 4);
  Hidden h;
  do h.T = test::normal_matrix(rng, n, n);
  while (Eigen::JacobiSVD<Matrix>(h.T).singularValues()(n - 1) < 0.1);
  Vector modes(n);
  for (double& mode : modes) mode = test::uniform(rng, 0.3, 0.97);
  modes(0) = test::uniform(rng, 1.06, 1.6);
  const Matrix back = h.T.inverse();
  h.A = h.T * modes.asDiagonal() * back;
  h.all = {Matrix::Identity(n, n), Vector::Ones(n)};
  h.rest = {back.bottomRows(n - 1), Vector::Ones(n - 1)};
  h.rest.C.rowwise().normalize();
  return h;
}

}  // namespace

TEST_CASE("a member that cannot see an unstable state says nothing, and never that somebody honest lies") {
  test::Rng rng(kSeed);
  int silent = 0;
  int heard = 0;
  for (int k = 0; k < test::tried(300); ++k) {
    CAPTURE(k);
    const Hidden h = draw(rng);
    const auto n = h.A.rows();
    const int honest = test::whole(rng, 1, 2);  // sources that do not see the unstable state
    std::vector<BankSource> sources{h.all};
    for (int j = 0; j < honest; ++j) sources.push_back(h.rest);
    Bank bank(h.A, 1e-4 * Matrix::Identity(n, n), sources, 1);
    if (k % 3 == 0)
      bank.start_unknown();
    else if (k % 3 == 1)
      bank.start_gaussian(Vector::Zero(n), Matrix::Identity(n, n));
    else
      bank.restart({Vector::Zero(n), 3.0, {}});
    Vector z = Vector::Zero(n);  // the states, the unstable one of which the liar hides
    for (int t = 0; t < 600; ++t) {
      z = h.T.inverse() * (h.A * (h.T * z)) +
          0.01 * h.T.inverse() * test::normal_matrix(rng, static_cast<int>(n), 1);
      z(0) = 0.0;
      const Vector x = h.T * z;
      Vector y(n + honest * (n - 1));
      for (double& v : y) v = normal(rng);
      if (k % 2 == 0) y.head(n) += x;  // the liar plays along with all that others see
      for (int j = 0; j < honest; ++j) y.segment(n + j * (n - 1), n - 1) += h.rest.C * x;
      const WindowWitness& found = bank.update(y, kLevels);
      REQUIRE_FALSE(found.region.refuted());
      for (const Proof& proof : found.proofs) CHECK(proof.source == 0);
      if (t < 300) continue;
      // Who hears the honest ones alone does not know the unstable state.
      CHECK_FALSE(found.region.answered());
      silent += found.region.answered() ? 0 : 1;
      for (const BankMember& member : bank.members())
        if (member.left_out.front() == 0) ++heard;
    }
  }
  std::cout << "unstable states that a member does not see: " << silent << " samples without a region\n";
  CHECK(silent > test::tried(300) * 250);
  CHECK(heard == silent);  // the member that is right lives
}

TEST_CASE("a start that is a million times as vague as the rows is no start") {
  test::Rng rng(kSeed + 1);
  for (int k = 0; k < test::tried(200); ++k) {
    CAPTURE(k);
    const int n = test::whole(rng, 1, 3);
    const Matrix A = Matrix::Identity(n, n) + 0.2 * test::normal_matrix(rng, n, n);
    std::vector<BankSource> sources;
    for (int j = 0; j < 4; ++j) sources.push_back({test::normal_matrix(rng, 1, n), Vector::Ones(1)});
    const auto bank = [&] { return Bank(A, 0.01 * Matrix::Identity(n, n), sources, 1); };
    Bank vague = bank();
    Bank unknown = bank();
    vague.start_gaussian(Vector::Zero(n), 1e22 * Matrix::Identity(n, n));
    unknown.start_unknown();
    Vector x = 1e6 * test::normal_matrix(rng, n, 1);
    for (int t = 0; t < 12; ++t) {
      x = A * x + 0.1 * test::normal_matrix(rng, n, 1);
      Vector y(4);
      for (int j = 0; j < 4; ++j) y(j) = sources[static_cast<std::size_t>(j)].C.row(0).dot(x) + normal(rng);
      const Region& one = vague.update(y, kLevels).region;
      const Region& other = unknown.update(y, kLevels).region;
      REQUIRE(one.answered() == other.answered());
      if (!one.answered()) continue;
      CHECK(((x - one.center).cwiseAbs().array() <= one.box.array()).all());
      CHECK((one.box - other.box).cwiseAbs().maxCoeff() <= 1e-6 * other.box.maxCoeff());
    }
  }
}
