// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/setting.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "core/spectrum.hpp"

namespace garrison::partial_sharing {
namespace {

Matrix start_covariance(const PartialSharing::Params& p, int m) {
  if (p.start_covariance.empty()) return p.start_variance * Matrix::Identity(m, m);
  const auto expected = static_cast<std::size_t>(m) * static_cast<std::size_t>(m);
  if (p.start_covariance.size() != expected)
    refuse("start_covariance (P0)", amount(p.start_covariance.size(), "number"),
           std::to_string(expected) + ", row by row");
  const Matrix P = Eigen::Map<const Matrix>(p.start_covariance.data(), m, m);
  if (!P.allFinite()) refuse("start_covariance (P0)", "a number that is not finite", "finite numbers");
  if ((P - P.transpose()).cwiseAbs().maxCoeff() > 1e-12 * P.cwiseAbs().maxCoeff())
    refuse("start_covariance (P0)", "a matrix that is not symmetric", "a symmetric one");
  const double least = detail::least_eigenvalue(P);
  if (least < -1e-12 * P.cwiseAbs().maxCoeff())
    refuse("start_covariance (P0)", "least eigenvalue " + text(least), "a positive semidefinite matrix");
  return (P + P.transpose()) / 2.0;
}

std::vector<int> shared_per_agent(const PartialSharing::Params& p, int N, int m) {
  if (!p.shared_each.empty()) {
    if (static_cast<int>(p.shared_each.size()) != N)
      refuse("shared_each (l)", amount(p.shared_each.size(), "number"),
             std::to_string(N) + ", one per agent");
    std::vector<int> each;
    for (const double l : p.shared_each) {
      if (l != std::floor(l)) refuse("shared_each (l)", text(l), "whole numbers");
      each.push_back(static_cast<int>(std::min(l, 1e9)));
    }
    return each;
  }
  return std::vector<int>(static_cast<std::size_t>(N), p.shared == 0 ? m : p.shared);
}

Selection make_selection(const PartialSharing::Params& p, int N, int m) {
  if (!p.selection.empty()) {
    const auto expected = static_cast<std::size_t>(N) * static_cast<std::size_t>(m);
    if (p.selection.size() != expected)
      refuse("selection (s0)", amount(p.selection.size(), "number"),
             std::to_string(expected) + ": " + std::to_string(m) + " zeros and ones for each agent");
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return {Matrix(Eigen::Map<const Rows>(p.selection.data(), N, m)), p.shift};
  }
  const std::vector<int> shared = shared_per_agent(p, N, m);
  return p.starts == "random"
             ? Selection::random(m, shared, p.shift, static_cast<std::uint64_t>(p.selection_seed))
             : Selection::coordinated(m, shared, p.shift);
}

Matrix full(const Vector& triangle, int m) {
  Matrix all(m, m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j <= i; ++j) all(i, j) = all(j, i) = triangle(packed(i, j));
  return all;
}

/// Doubles that a step of a LocalRecursion works on.
int room(int m, int q) {
  using Kernel = Recursion<Dynamic, 1>;
  return 2 * m + q + Kernel::scratch(m) + q * Kernel::scratch_per_row(m);
}

}  // namespace

double Setting::shared_fraction() const {
  int most = 0;
  for (int i = 0; i < agents(); ++i) most = std::max(most, selection.shared(i));
  return static_cast<double>(most) / states();
}

Matrix whitener(const Matrix& R, int agent) {
  if (R.rows() == 0) return R;
  Matrix W = garrison::whitener(R);
  if (W.size() == 0)
    refuse("measurement_covariance[" + std::to_string(agent) + "] (R)",
           "a matrix that is not positive definite", "a symmetric positive definite one",
           "a measurement without noise is not covered: give it a small variance");
  return W;
}

Setting make_setting(const PartialSharing::Params& p, const Model& model, const Network& network) {
  const int N = model.agents();
  const int m = model.states();
  if (model.noise().process_covariance.size() == 0)
    refuse("process_covariance (Q)", "no value", "a covariance in the model",
           "the filter's gains follow from it");
  if (model.noise().measurement_covariance.empty())
    refuse("measurement_covariance (R)", "no value", "one covariance per agent in the model",
           "the filter's gains follow from it");
  Setting s;
  s.A = model.A();
  const Matrix& Q = model.noise().process_covariance;
  s.Q = (Q + Q.transpose()) / 2.0;
  s.P0 = start_covariance(p, m);
  for (int i = 0; i < N; ++i) {
    s.H.push_back(model.C(i));
    s.R.push_back(model.noise().measurement_covariance[static_cast<std::size_t>(i)]);
    whitener(s.R.back(), i);
    const auto heard = network.neighbours(i);
    s.hears.emplace_back(heard.begin(), heard.end());
  }
  s.selection = make_selection(p, N, m);
  s.gamma = p.gain;
  return s;
}

std::int64_t bytes_per_step(const Setting& s) {
  std::int64_t entries = 0;
  for (const auto& heard : s.hears)
    for (const int j : heard) entries += s.selection.shared(j);
  return entries * static_cast<std::int64_t>(sizeof(double));
}

LocalRecursion::LocalRecursion(const Setting& setting, int agent)
    : setting_(setting),
      H_(setting.H[static_cast<std::size_t>(agent)]),
      W_(whitener(setting.R[static_cast<std::size_t>(agent)], agent)),
      Hw_(H_.transpose() * W_.transpose()),
      P_(setting.P0),
      Kw_(P_.rows(), H_.rows()),
      packed_P_(packed(setting.states())),
      packed_G_(packed_P_.size()),
      scratch_(room(setting.states(), static_cast<int>(H_.rows()))) {}

LocalGains LocalRecursion::step(double* change) {
  using One = Block<1>;
  using Kernel = Recursion<Dynamic, 1>;
  const int m = setting_.states();
  const int q = static_cast<int>(H_.rows());
  for (int i = 0; i < m; ++i)
    for (int j = 0; j <= i; ++j) packed_P_(packed(i, j)) = P_(i, j);
  double* const own = scratch_.data() + 2 * m + q;
  One::type* const P = One::of(packed_P_.data());
  Kernel recursion(One::of(own), One::of(own + Kernel::scratch(m)), m, q);
  recursion.factor(P, 1);
  for (int r = 0; r < q; ++r) recursion.use_row(r, One::of(Hw_.col(r).data()));
  explicit_gains<Dynamic>(recursion, setting_.gamma, m, q, scratch_.data(), Kw_.data(), packed_G_.data(), 1);
  One::type moved{};
  recursion.predict(setting_.A.data(), setting_.Q.data(), P, 1, One::type{} + kLargestVariance, moved);
  if (change != nullptr) *change = moved[0];
  LocalGains g;
  g.P = P_;
  P_ = full(packed_P_, m);
  g.K = setting_.A * filter_gain();
  g.C = setting_.A * consensus_gain();
  g.F = setting_.A - g.K * H_;
  return g;
}

Matrix LocalRecursion::consensus_gain() const { return full(packed_G_, setting_.states()); }

}  // namespace garrison::partial_sharing
