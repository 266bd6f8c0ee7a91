// SPDX-License-Identifier: Apache-2.0
// One decision on observability and detectability, whatever the coordinates and units.
#include <doctest/doctest.h>

#include "../random_system.hpp"
#include "garrison/analysis/modes.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/filters/rdkf/setting.hpp"

using namespace garrison;

namespace {

Matrix rotation(test::Rng& rng, int n) {
  return Eigen::HouseholderQR<Matrix>(test::normal_matrix(rng, n, n)).householderQ() * Matrix::Identity(n, n);
}

/// Powers of 10 from 1e-6 to 1e6.
Vector units(test::Rng& rng, int n) {
  return Vector::NullaryExpr(n, [&] { return std::pow(10.0, test::whole(rng, -6, 6)); });
}

struct Case {
  Matrix A, C;
  Case in(const Matrix& T) const { return {T.transpose() * A * T, C * T}; }
  Case scaled(const Vector& d, const Vector& s) const {
    return {d.cwiseInverse().asDiagonal() * A * d.asDiagonal(), s.asDiagonal() * C * d.asDiagonal()};
  }
};

/// `hidden` modes that no output shows (2.0, 1.9, ... in one Jordan block when asked), the others observable.
Case with_hidden(test::Rng& rng, int n, int hidden, int outputs, bool jordan) {
  Case c{Matrix::Zero(n, n), Matrix::Zero(outputs, n)};
  const int shown = n - hidden;
  c.A.topLeftCorner(shown, shown) = 0.6 * test::normal_matrix(rng, shown, shown);
  c.A.bottomLeftCorner(hidden, shown) = test::normal_matrix(rng, hidden, shown);
  for (int k = 0; k < hidden; ++k) {
    c.A(shown + k, shown + k) = jordan ? 1.2 : 2.0 - 0.2 * k;
    if (jordan && k + 1 < hidden) c.A(shown + k, shown + k + 1) = 1.0;
  }
  c.C.leftCols(shown) = test::normal_matrix(rng, outputs, shown);
  return c;
}

/// A chain of n integrators, position in front.
Case chain(int n, double T) {
  Case c{Matrix::Identity(n, n), Matrix::Zero(1, n)};
  for (int k = 0; k + 1 < n; ++k) c.A(k, k + 1) = T;
  c.C(0, 0) = 1.0;
  return c;
}

}  // namespace

TEST_CASE("a double eigenvalue that is not seen is found in every coordinate system") {
  const Case c{Matrix{{1.4, -0.4}, {0.4, 0.6}}, Matrix{{1.0, -1.0}}};
  const Case triangular{Matrix{{1.0, 0.8}, {0.0, 1.0}}, Matrix{{0.0, 1.0}}};
  CHECK(visibility(c.A, c.C, 1.0).sight == Sight::unseen);
  CHECK(visibility(triangular.A, triangular.C, 1.0).sight == Sight::unseen);
  test::Rng rng(1);
  for (int k = 0; k < 100; ++k) {
    const Case r = c.in(rotation(rng, 2));
    const Visibility v = visibility(r.A, r.C, 1.0);
    CHECK(v.sight == Sight::unseen);
    REQUIRE(v.unseen.size() == 1);
    CHECK(std::abs(v.unseen[0] - 1.0) < 1e-12);
    CHECK_FALSE(rdkf::detectable(r.A, r.C));
    CHECK_FALSE(observable(r.A, r.C));
    // A second sensor makes it visible: only that agent can lie along the mode.
    const Model model(r.A, {r.C, test::normal_matrix(rng, 1, 2)});
    CHECK(undetectable_agents(model) == std::vector<int>{1});
  }
}

TEST_CASE("units of outputs and states decide nothing") {
  for (const double unit : {1e-9, 1e-3, 1.0, 1e6, 1e7, 1e12}) {
    CAPTURE(unit);
    const Matrix A{{1.0, 1e-3}, {0.0, 1.0}};
    const Matrix C{{unit, 0.0}};
    CHECK(visibility(A, C, 1.0).all_seen());
    CHECK(observable(A, C));
    CHECK(rdkf::detectable(A, C));
    CHECK(unseen_modes(A, C, 0.0).empty());
    CHECK(s_sparse_observable(A, C, 0));
  }
}

TEST_CASE("chains of integrators with short steps: everybody says the same") {
  test::Rng rng(2);
  for (const double T : {1.0, 1e-2, 1e-3})
    for (int n = 2; n <= 6; ++n) {
      CAPTURE(n);
      CAPTURE(T);
      for (int k = 0; k < 20; ++k) {
        const Case c = k == 0       ? chain(n, T)
                       : k % 2 == 1 ? chain(n, T).scaled(units(rng, n), units(rng, 1))
                                    : chain(n, T).in(rotation(rng, n));
        const Visibility v = visibility(c.A, c.C, 1.0);
        CAPTURE(v.text());
        CHECK(v.sight == Sight::seen);
        CHECK(observable(c.A, c.C));
        CHECK(rdkf::detectable(c.A, c.C));
        CHECK(undetectable_agents(Model(c.A, {c.C, c.C})).empty());
        CHECK(undetectable_agents(Model(c.A, {c.C})) == std::vector<int>{0});
      }
    }
}

TEST_CASE("hidden modes of random systems are found, in any coordinates and units") {
  test::Rng rng(3);
  for (int k = 0; k < 400; ++k) {
    const int n = test::whole(rng, 2, 8);
    const int hidden = test::whole(rng, 1, std::min(3, n - 1));
    const int outputs = test::whole(rng, 1, 3);
    const bool jordan = k % 3 == 0;
    Case c = with_hidden(rng, n, hidden, outputs, jordan);
    CAPTURE(k);
    CAPTURE(n);
    CAPTURE(hidden);
    if (k % 4 >= 1) c = c.in(rotation(rng, n));
    if (k % 4 >= 2) c = c.scaled(units(rng, n), units(rng, outputs));
    const Visibility v = visibility(c.A, c.C, 0.0);
    CAPTURE(v.text());
    CHECK(v.sight == Sight::unseen);
    // How often rounding leaves a multiple mode unseen is not determined; whether it does, is.
    if (!jordan) CHECK(static_cast<int>(v.unseen.size() + v.unclear.size()) == hidden);
    if (!jordan && k % 4 <= 1) CHECK(v.unclear.empty());  // rounding in strange units costs digits
    CHECK(visibility(c.A, c.C, 1.0).sight == Sight::unseen);
  }
}

TEST_CASE("random systems without hidden modes are observable, in any coordinates and units") {
  test::Rng rng(4);
  for (int k = 0; k < 400; ++k) {
    const int n = test::whole(rng, 1, 8);
    const int outputs = test::whole(rng, 1, 3);
    Case c{0.7 * test::normal_matrix(rng, n, n), test::normal_matrix(rng, outputs, n)};
    const double before = visibility(c.A, c.C, 0.0).distance;
    if (k % 2 == 0) c = c.in(rotation(rng, n));
    if (k % 4 >= 1) c = c.scaled(units(rng, n), units(rng, outputs));
    CAPTURE(k);
    const Visibility v = visibility(c.A, c.C, 0.0);
    CAPTURE(v.text());
    CHECK(v.sight == Sight::seen);
    CHECK(v.distance > std::min(1e-4, 1e-3 * before));  // above 1e-4, other units are not tried
  }
}

TEST_CASE("within rounding of a hidden mode the answer is that one cannot tell") {
  test::Rng rng(5);
  for (int k = 0; k < 50; ++k) {
    const Matrix T = rotation(rng, 2);
    const Case c = Case{Matrix{{1.0, 0.0}, {0.0, 0.5}}, Matrix{{3e-13, 1.0}}}.in(T);
    const Visibility v = visibility(c.A, c.C, 1.0);
    CHECK(v.sight == Sight::unclear);
    CHECK(v.distance > 3e-14);
    CHECK(v.distance < 3e-12);
    CHECK(v.text().find("cannot tell: distance") == 0);
    CHECK(unseen_modes(c.A, c.C, 1.0).size() == 1);  // never passed off as seen
    CHECK_FALSE(rdkf::detectable(c.A, c.C));
  }
  // A mode inside of the circle by less than rounding is not surely stable.
  CHECK(visibility(Matrix{{1.0 - 1e-12}}, Matrix(0, 1), 1.0).sight == Sight::unclear);
  CHECK(visibility(Matrix{{1.0 - 1e-16}}, Matrix(0, 1), 1.0).sight == Sight::unseen);
  CHECK(visibility(Matrix{{0.9}}, Matrix(0, 1), 1.0).sight == Sight::seen);
  // What makes the mode visible is a rounding error of a rotation by 45 degrees.
  const Visibility noise = visibility(Matrix{{1.0, 1e-17}, {0.0, 1.0}}, Matrix{{1.0, 0.0}}, 1.0);
  CHECK(noise.sight == Sight::unclear);
}

TEST_CASE("pairs some roundings away from a hidden mode are no sure no") {
  // Two different eigenvalues, as exact numbers: every mode is seen, by a distance of 11 to 34 roundings.
  for (const double d : {1e-14, 3e-14})
    CHECK(visibility(Matrix{{1.0, 0.0}, {0.0, 1.0 + d}}, Matrix{{1.0, 1.0}}, 0.0).sight == Sight::unclear);
  test::Rng rng(9);
  for (int k = 0; k < 100; ++k) {
    const Case c = Case{Matrix{{1.0, 0.0}, {0.0, 0.5}}, Matrix{{1e-14, 1.0}}}.in(rotation(rng, 2));
    CHECK(visibility(c.A, c.C, 1.0).sight != Sight::unseen);
  }
}

TEST_CASE("the largest and smallest units of doubles decide nothing") {
  const Case seen{Matrix{{0.9, 0.3}, {0.1, 0.5}}, Matrix{{1.0, 0.0}}};
  const Case hidden{Matrix{{1.4, -0.4}, {0.4, 0.6}}, Matrix{{1.0, -1.0}}};
  const Case chained = chain(4, 1e-3);
  for (const double state : {1e-150, 1e-30, 1.0, 1e30, 1e150})
    for (const double output : {1e-300, 1e-150, 1.0, 1e30, 1e120}) {
      if (state * output < 1e-290) continue;  // entries of C are no doubles any more
      CAPTURE(state);
      CAPTURE(output);
      const auto in_units = [&](const Case& c) {
        Vector d = Vector::Ones(c.A.rows());
        d(1) = state;
        return c.scaled(d, Vector::Constant(1, output));
      };
      const Case s = in_units(seen);
      CHECK(visibility(s.A, s.C, 0.0).all_seen());
      CHECK(observable(s.A, s.C));
      CHECK(s_sparse_observable(s.A, s.C, 0));
      const Case h = in_units(hidden);
      const Visibility v = visibility(h.A, h.C, 1.0);
      CAPTURE(v.text());
      CHECK(v.sight == Sight::unseen);
      CHECK(v.unseen.size() == 1);
      if (state >= 1e-30 && state <= 1e30) {  // beyond, steps of 1e-3 may be rounding in the units given
        const Case c = in_units(chained);
        CHECK(visibility(c.A, c.C, 1.0).sight != Sight::unseen);
      }
    }
}

TEST_CASE("what is small by its units alone is no rounding") {
  // The first state is shown through 1e-31, because the second one is told in units 1e30 times as large.
  const Case c{Matrix{{0.9, 0.3}, {0.1, 0.5}}, Matrix{{0.0, 1.0}}};
  const Case far = c.scaled(Vector{{1.0, 1e30}}, Vector::Ones(1));
  CHECK(visibility(far.A, far.C, 0.0).all_seen());
  const Case row = Case{c.A, Matrix{{1.0, 1.0}}}.scaled(Vector{{1.0, 1e-30}}, Vector::Ones(1));
  CHECK(visibility(row.A, row.C, 0.0).all_seen());
}

TEST_CASE("one cannot tell: in all units of states and outputs, and of every question") {
  test::Rng rng(8);
  // Eigenvalues that differ by d: the distance is about d/5, far from both limits (1e-14 and 1e-11).
  for (const double d : {5e-13, 1e-12, 5e-12}) {
    const Case close{Matrix{{1.0, 0.0}, {0.0, 1.0 + d}}, Matrix{{1.0, 1.0}}};
    for (int k = 0; k < 200; ++k) {
      const Case c = k == 0 ? close : close.scaled(units(rng, 2), units(rng, 1));
      CAPTURE(k);
      const Visibility v = visibility(c.A, c.C, 0.0);
      CHECK(v.sight == Sight::unclear);
      CHECK(v.distance > 0.05 * d);
      CHECK(v.distance < d);
      CHECK_THROWS_AS(observable(c.A, c.C), InvalidInput);
      CHECK_THROWS_AS(s_sparse_observable(c.A, c.C, 0), InvalidInput);
      CHECK_FALSE(surely_observable(c.A, c.C));
    }
  }
  // Random pairs, moved by 1e-12 from one with a hidden mode, all entries full.
  for (int k = 0; k < 100; ++k) {
    const int n = test::whole(rng, 2, 5);
    Case c = with_hidden(rng, n, 1, 2, false);
    c.C += 1e-12 * test::normal_matrix(rng, 2, n);
    c = c.in(rotation(rng, n));
    const Visibility v = visibility(c.A, c.C, 0.0);
    const bool far_from_limits = v.distance > 1e-13 && v.distance < 2e-12;
    if (!far_from_limits) continue;
    for (int trial = 0; trial < 20; ++trial) {
      const Case other = c.scaled(units(rng, n), units(rng, 2));
      const Visibility w = visibility(other.A, other.C, 0.0);
      CAPTURE(w.text());
      CHECK(w.sight == Sight::unclear);
    }
  }
}

TEST_CASE(
    "a removal of which one cannot tell is not called harmless, nor is it hidden behind one that harms") {
  const Matrix A{{1.0, 0.0}, {0.0, 1.0 + 1e-12}};
  const Matrix C{{1.0, 1.0}, {1.0, -1.0}, {1.0, 2.0}, {2.0, 1.0}};  // any two see all
  CHECK(s_sparse_observable(A, C, 2));
  CHECK_THROWS_AS(s_sparse_observable(A, C, 3), InvalidInput);
  CHECK_FALSE(s_sparse_observable(A, C, 4));
  const Matrix hiding{
      {1.0, 1.0}, {1.0, -1.0}, {1.0, 0.0}};  // the last one alone does not see the second state
  CHECK_FALSE(s_sparse_observable(A, hiding, 2));
}

TEST_CASE("necessary agents of random systems: one decomposition says what one per agent says") {
  test::Rng rng(6);
  for (int k = 0; k < 150; ++k) {
    const int n = test::whole(rng, 1, 6);
    const int N = test::whole(rng, 1, 6);
    Matrix A =
        test::whole(rng, 0, 1)
            ? Matrix(0.8 * test::normal_matrix(rng, n, n))
            : Matrix(Vector::NullaryExpr(n, [&] { return 0.8 + 0.2 * test::whole(rng, 0, 2); }).asDiagonal());
    const Matrix T = rotation(rng, n);
    std::vector<Matrix> C;
    for (int i = 0; i < N; ++i) {
      Matrix rows = test::normal_matrix(rng, test::whole(rng, 0, 2), n);
      for (int j = 0; j < n; ++j)
        if (test::whole(rng, 0, 2) == 0) rows.col(j).setZero();
      C.push_back(rows * T);
    }
    A = T.transpose() * A * T;
    const Model model(A, C);
    const auto all = unseen_modes(A, model.stacked(), 1.0).size();
    std::vector<int> expected;
    for (int i = 0; i < N; ++i) {
      auto others = C;
      others[static_cast<std::size_t>(i)].resize(0, n);
      if (unseen_modes(A, Model(A, others).stacked(), 1.0).size() > all) expected.push_back(i);
    }
    CAPTURE(k);
    CHECK(undetectable_agents(model) == expected);
  }
}

TEST_CASE("what does not fit is refused") {
  CHECK_THROWS_AS(visibility(Matrix(0, 0), Matrix(0, 0), 0.0), InvalidInput);
  CHECK_THROWS_AS(visibility(Matrix(2, 3), Matrix(1, 3), 0.0), InvalidInput);
  CHECK_THROWS_AS(visibility(Matrix::Identity(2, 2), Matrix::Ones(1, 3), 0.0), InvalidInput);
  CHECK_THROWS_AS(visibility(Matrix{{kNaN}}, Matrix{{1.0}}, 0.0), InvalidInput);
  CHECK_THROWS_AS(visibility(Matrix{{1.0}}, Matrix{{1.0}}, -1.0), InvalidInput);
}

TEST_CASE("sensors far from most states of a network: what is seen well is not called hardly seen") {
  test::Rng rng(7);
  const int n = 90;
  Matrix A = Matrix::Identity(n, n);
  for (int i = 1; i < n; ++i) {  // diffusion on a random tree
    const int j = test::whole(rng, std::max(0, i - 5), i - 1);
    A(i, i) -= 0.05;
    A(j, j) -= 0.05;
    A(i, j) += 0.05;
    A(j, i) += 0.05;
  }
  std::vector<Matrix> C;
  for (int i = 0; i < n; i += 30) C.push_back(Matrix::Identity(n, n).row(i));
  const Model model(A, C);
  const Visibility v = visibility(A, model.stacked(), 1.0);
  CHECK(v.all_seen());
  CHECK(v.distance > 1e-6);
  CHECK(undetectable_agents(model).empty());
  CHECK(undetectable_agents(Model(A, {C[0]})) == std::vector<int>{0});
}

TEST_CASE("the quick yes of observable() is the answer of visibility() at every distance") {
  test::Rng rng(21);
  int yes = 0;
  int no = 0;
  for (int trial = 0; trial < test::tried(3000); ++trial) {
    const int n = test::whole(rng, 2, 8);
    const int hidden = test::whole(rng, 1, n - 1);
    Case c = with_hidden(rng, n, hidden, test::whole(rng, 1, 3), test::whole(rng, 0, 1) == 1);
    // Moves the pair away from the one with hidden modes, by 1e-16 to 1.
    const double away = std::pow(10.0, test::uniform(rng, -16.0, 0.0));
    c.C += away * test::normal_matrix(rng, static_cast<int>(c.C.rows()), n);
    if (test::whole(rng, 0, 1) == 1) c = c.in(rotation(rng, n));
    if (test::whole(rng, 0, 3) == 0) c = c.scaled(units(rng, n), units(rng, static_cast<int>(c.C.rows())));
    const bool seen = visibility(c.A, c.C, 0.0).all_seen();
    CHECK_MESSAGE(surely_observable(c.A, c.C) == seen, "trial ", trial, ", moved by ", away);
    (seen ? yes : no) += 1;
  }
  CHECK(yes > test::tried(500));
  CHECK(no > test::tried(400));
}

TEST_CASE("what only very small entries show is not surely unseen") {
  const Matrix A{{1.0, 0.1}, {0.0, 1.0}};
  for (const double small : {1e-13, 1e-15, 1e-17}) {
    CAPTURE(small);
    for (const double sign : {1.0, -1.0}) {
      const Visibility v = visibility(A, Matrix{{sign * small, 1.0}}, 1.0);
      CHECK(v.sight == Sight::unclear);
      CHECK(v.unseen.empty());
      CHECK(v.text().find("cannot tell") == 0);
    }
    CHECK(visibility(A, Matrix{{1.0, small}}, 1.0).sight == Sight::seen);
    // One output sees one copy of a double mode, however large its entries are.
    CHECK(visibility(Matrix::Identity(2, 2), Matrix{{small, 1.0}}, 1.0).sight == Sight::unseen);
  }
  CHECK(visibility(A, Matrix{{0.0, 1.0}}, 1.0).sight == Sight::unseen);
}
