// SPDX-License-Identifier: Apache-2.0
// Design: from parameters, model and network to the gains and thresholds of the agents.
#include "garrison/filters/structural/filter.hpp"

#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "blocks.hpp"
#include "garrison/analysis/modes.hpp"
#include "garrison/core/spectrum.hpp"
#include "garrison/filters/structural/detection.hpp"
#include "garrison/filters/structural/gains.hpp"

namespace garrison {
namespace {

using Index = Eigen::Index;
using structural::GainMatrices;
using structural::Setting;

constexpr Index kExact = 1200;  // N n up to which the joint covariance is formed
constexpr double kSettled = 0.01;
constexpr double kDoubt = 1.1;
constexpr double kHaste = 3.0;  // 25 samples from there are a factor of 1e6 in deviations

std::string at(int i, int j) {
  return std::string("[").append(std::to_string(i)).append(", ").append(std::to_string(j)).append("]");
}

Matrix square_from(const std::string& which, const std::vector<double>& numbers, Index N) {
  if (static_cast<Index>(numbers.size()) != N * N)
    refuse(which, amount(numbers.size(), "number"),
           std::to_string(N * N) + ", N*N for N = " + amount(N, "agent") + ", row by row");
  return Eigen::Map<const Eigen::Matrix<double, Dynamic, Dynamic, Eigen::RowMajor>>(numbers.data(), N, N);
}

void require_links(const std::string& which, const Matrix& M, const Network& network) {
  for (int i = 0; i < network.agents(); ++i) {
    const auto heard = network.neighbours(i);
    for (int j = 0; j < network.agents(); ++j)
      if (i != j && M(i, j) != 0.0 && !std::binary_search(heard.begin(), heard.end(), j))
        refuse(which + at(i, j), text(M(i, j)),
               "0, because agent " + std::to_string(i) + " does not hear agent " + std::to_string(j),
               "add the link to the network");
  }
}

bool covariances_known(const Setting& s) { return s.E.size() != 0 && s.R.size() != 0; }

void require_covariances(const Setting& s) {
  if (!covariances_known(s))
    refuse("model", "no process_covariance or no measurement_covariance", "both",
           "gains and thresholds are designed from them; or give the gains with the parameter gain");
}

void require_detectable(const Model& model) {
  const Visibility modes = visibility(model.A(), model.stacked(), 1.0);
  if (!modes.all_seen())
    refuse("model", "a pair (A, C) that is not detectable (" + modes.text() + ")",
           "that every mode of modulus >= 1 is seen by some agent",
           "add a sensor on the state that it moves");
}

/// How fast P grows while sensor i is left out, at first and once the estimate is lost: faster than an error
/// that nothing corrects; where the others see all that does not decay, slower than what their measurements
/// take away, whatever P is.
std::pair<double, double> growth_without(const Setting& s, Index i, double rho) {
  Matrix others = s.C;
  others.row(i).setZero();
  double lost = 0.0;
  for (const auto& mode : unseen_modes(s.A, others, 1.0)) lost = std::max(lost, std::abs(mode));
  if (lost > 0.0) return {kDoubt * std::max(1.0, lost * lost), kHaste * std::max(1.0, lost * lost)};
  const double growth = std::max(1.0, spectral_radius(s.A));
  const double always = std::min(kDoubt * growth * growth, rho > 0.0 ? 1.0 / std::sqrt(rho) : kInfinity);
  return {always, always};
}

/// What agents need to carry a bound of their error's covariance from `covariance(i)` on.
template <class Covariance>
void add_spread(Structural::Gains& g, const Setting& s, const Covariance& covariance) {
  if (s.n() > structural::kCarried && !g.isolate) return;
  for (Index i = 0; i < s.N(); ++i) {
    const Matrix Q = covariance(i);
    g.covariance.insert(g.covariance.end(), Q.data(), Q.data() + Q.size());
    g.noise.push_back(s.R(i, i));
  }
  g.process.assign(s.E.data(), s.E.data() + s.E.size());
  // A Gaussian that is over its level has this much more than its variance.
  const double m = g.sample_level;
  const double density = std::exp(-0.5 * m * m) / std::sqrt(2.0 * std::numbers::pi);
  g.surprise = 2.0 * m * density / structural::false_alarm_of_level(m);
  g.doubt.assign(static_cast<std::size_t>(s.N()), 1.0);
  g.haste = g.doubt;
  for (Index i = 0; i < s.N() && g.isolate; ++i) {
    const auto id = static_cast<std::size_t>(i);
    std::tie(g.doubt[id], g.haste[id]) = growth_without(s, i, g.rho);
  }
}

/// Standard deviations of what is tested, and the window's matrices: exact, or bounds of them.
void add_test(Structural::Gains& g, const Setting& s, const GainMatrices& K, const std::vector<Matrix>& P,
              double false_alarm) {
  const Index N = s.N();
  const Index n = s.n();
  g.sample_level = structural::level_of_false_alarm(false_alarm);
  g.level = g.window > 1 ? structural::chi_square_level(g.window, false_alarm) : g.sample_level;
  Vector residual = Vector::Constant(N, kNaN);
  Vector innovation = Vector::Constant(N, kNaN);
  if (N * n <= kExact) {
    const auto x = structural::stationary(s, K, g.window - 1);
    residual = x.residual_std;
    innovation = x.innovation_std;
    const auto covariances = g.innovation && g.window > 1
                                 ? structural::innovation_covariances(s, K, x, g.window - 1)
                                 : x.covariances;
    add_spread(g, s, [&](Index i) -> Matrix { return x.Q.block(i * n, i * n, n, n); });
    for (Index i = 0; i < N && g.window > 1; ++i) {
      const Matrix S = structural::window_precision(covariances, static_cast<int>(i));
      g.precision.insert(g.precision.end(), S.data(), S.data() + S.size());
    }
  } else if (!P.empty()) {
    if (g.window > 1)
      refuse("structural.window", std::to_string(g.window), "1 for N n > " + std::to_string(kExact),
             "the covariance in time of so large a network is not computed");
    add_spread(g, s, [&](Index i) { return P[static_cast<std::size_t>(i)]; });
    for (Index i = 0; i < N; ++i) {
      // Jensen: P_i >= cov(e_i), so these are bounds and alarms are rarer than asked for
      // (docs/filters/structural.md#d-riccati).
      Matrix mixed = Matrix::Zero(n, n);
      for (Index j = 0; j < N; ++j)
        if (s.W(i, j) != 0.0) mixed += s.W(i, j) * P[static_cast<std::size_t>(j)];
      const Vector c = s.C.row(i);
      const Matrix prior = s.A * mixed * s.A.transpose() + s.E;
      innovation(i) = std::sqrt(c.dot(prior * c) + s.R(i, i));
      Vector shared = Vector::Zero(n);  // cov of K's noise with the agent's own
      for (Index j = 0; j < N; ++j)
        if (s.U(i, j) != 0.0) shared += s.C.row(j).transpose() * s.R(j, i);
      const auto k = static_cast<std::size_t>(i);
      residual(i) = std::sqrt(std::max(0.0, c.dot(P[k] * c) + s.R(i, i) - 2.0 * c.dot(K[k] * shared)));
    }
  }
  for (Index i = 0; i < N; ++i) {
    const auto known = [&](double std) {
      return structural::varies(std, s.R(i, i), innovation(i)) ? std : kNaN;
    };
    g.std.push_back(known(g.innovation ? innovation(i) : residual(i)));
    g.innovation_std.push_back(known(innovation(i)));
  }
}

void add_columns(Structural::Gains& g, const Setting& s, const GainMatrices& K, const Network& network) {
  const Index n = s.n();
  g.offsets.push_back(0);
  for (int i = 0; i < network.agents(); ++i) {
    const auto add = [&](int j) {
      const bool uses = s.U(i, j) != 0.0;
      g.heard.push_back({j, s.W(i, j), uses ? static_cast<int>(g.columns.size()) : -1});
      if (!uses) return;
      const Vector column = K[static_cast<std::size_t>(i)] * s.C.row(j).transpose();
      g.columns.insert(g.columns.end(), column.begin(), column.end());
    };
    add(i);
    for (const int j : network.neighbours(i)) add(j);
    g.offsets.push_back(static_cast<int>(g.heard.size()));
  }
  for (Index i = 0; i < s.N(); ++i)
    for (Index k = 0; k < n; ++k) g.rows.push_back(s.C(i, k));
}

}  // namespace

Setting Structural::setting(const Params& p, const Model& model, const Network& network) {
  const int N = model.agents();
  Setting s;
  s.A = model.A();
  s.C = Matrix::Zero(N, model.states());
  for (int i = 0; i < N; ++i) {
    if (model.outputs(i) > 1)
      refuse(
          "C[" + std::to_string(i) + "]", amount(model.outputs(i), "row"), "at most one row per agent",
          "the structural filter tests scalar residuals: split_outputs gives each row an agent of its own");
    if (model.outputs(i) == 1) s.C.row(i) = model.C(i).row(0);
  }
  s.W = Matrix::Zero(N, N);
  s.U = Matrix::Identity(N, N);
  for (int i = 0; i < N; ++i) {
    const auto heard = network.neighbours(i);
    const double own = heard.empty()               ? 1.0
                       : std::isnan(p.self_weight) ? 1.0 / static_cast<double>(heard.size() + 1)
                                                   : p.self_weight;
    s.W(i, i) = own;
    for (const int j : heard) {
      s.W(i, j) = (1.0 - own) / static_cast<double>(heard.size());
      if (p.share == "neighbours") s.U(i, j) = 1.0;
    }
  }
  if (!p.weights.empty()) {
    if (!std::isnan(p.self_weight))
      refuse("structural.self_weight", text(p.self_weight), "nothing together with weights");
    s.W = square_from("structural.weights", p.weights, N);
    require_links("structural.weights", s.W, network);
  }
  if (!p.sharing.empty()) {
    s.U = square_from("structural.sharing", p.sharing, N);
    require_links("structural.sharing", s.U, network);
  }
  const Noise& noise = model.noise();
  s.E = noise.process_covariance;
  if (!noise.measurement_covariance.empty()) {
    s.R = Matrix::Zero(N, N);
    for (int i = 0; i < N; ++i)
      if (model.outputs(i) == 1) s.R(i, i) = noise.measurement_covariance[static_cast<std::size_t>(i)](0, 0);
  }
  structural::require_graphs(s);
  return s;
}

GainMatrices Structural::gains_of(const Params& p, const Setting& s) {
  const Index N = s.N();
  const Index n = s.n();
  if (static_cast<Index>(p.gain.size()) != N * n * n)
    refuse("structural.gain", amount(p.gain.size(), "number"),
           std::to_string(N * n * n) + ", N*n*n, K_i row by row, agent by agent");
  GainMatrices K;
  for (Index i = 0; i < N; ++i)
    K.emplace_back(Eigen::Map<const Eigen::Matrix<double, Dynamic, Dynamic, Eigen::RowMajor>>(
        p.gain.data() + i * n * n, n, n));
  return K;
}

Structural::Gains Structural::part(const Gains& all, int id, std::span<const int>) {
  const auto i = static_cast<std::size_t>(id);
  const std::size_t N = all.has_sensor.size();
  const std::size_t n = all.rows.size() / N;
  Gains g = all;
  g.offsets.assign(N + 1, 0);
  g.heard.assign(all.heard.begin() + all.offsets[i], all.heard.begin() + all.offsets[i + 1]);
  std::fill(g.offsets.begin() + id + 1, g.offsets.end(), static_cast<int>(g.heard.size()));
  g.columns.clear();
  g.rows.assign(N * n, 0.0);
  const auto copy_row = [&](int j) {
    const auto first = static_cast<std::ptrdiff_t>(n) * j;
    std::copy_n(all.rows.begin() + first, n, g.rows.begin() + first);
  };
  copy_row(id);
  for (Heard& j : g.heard) {
    if (j.first < 0) continue;
    const auto column = all.columns.begin() + j.first;
    j.first = static_cast<int>(g.columns.size());
    g.columns.insert(g.columns.end(), column, column + static_cast<std::ptrdiff_t>(n));
    copy_row(j.id);
  }
  g.std.assign(N, kNaN);
  g.std[i] = all.std[i];
  g.innovation_std.assign(N, kNaN);
  for (const Heard& j : g.heard) {  // itself, and whose measurements it may take back
    const auto k = static_cast<std::size_t>(j.id);
    g.innovation_std[k] = all.innovation_std[k];
  }
  if (!all.covariance.empty()) {
    const auto first = static_cast<std::ptrdiff_t>(n * n * i);
    g.covariance.assign(all.covariance.begin() + first,
                        all.covariance.begin() + first + static_cast<std::ptrdiff_t>(n * n));
  }
  const std::size_t square = all.precision.size() / N;
  std::fill(g.precision.begin(), g.precision.end(), 0.0);
  std::copy_n(all.precision.begin() + static_cast<std::ptrdiff_t>(square * i), square,
              g.precision.begin() + static_cast<std::ptrdiff_t>(square * i));
  return g;
}

Structural::Gains Structural::design(const Params& p, const Model& model, const Network& network) {
  if (!(p.false_alarm < 1.0)) refuse("structural.false_alarm", text(p.false_alarm), "a probability below 1");
  const Setting s = setting(p, model, network);
  Gains g;
  g.window = p.window;
  g.alarm_after = p.alarm_after;
  g.clear_after = p.clear_after;
  if (p.isolate && p.test == "residual")
    refuse("structural.test", "residual together with isolate", "innovation, or auto",
           "a residual is tested after the measurement has moved the estimate, so that others seem to lie");
  g.innovation = p.test == "innovation" || p.isolate;
  g.isolate = p.isolate;
  g.accuse_missing = p.accuse_missing;
  for (int i = 0; i < model.agents(); ++i) g.has_sensor.push_back(model.outputs(i) > 0 ? 1 : 0);
  GainMatrices K;
  std::vector<Matrix> P;
  if (p.gain.empty()) {
    require_covariances(s);
    require_detectable(model);
    auto designed = structural::design_gains(s, p.design);
    K = std::move(designed.K);
    P = std::move(designed.P);
    g.rho = designed.rho;
  } else {
    K = gains_of(p, s);
    g.rho = structural::error_radius(s, K);
  }
  add_columns(g, s, K, network);
  // Given gains may make the error unstable: the filter runs, but nothing is known of its residuals.
  if (covariances_known(s) && g.rho < 1.0) {
    structural::require_valid(s);
    add_test(g, s, K, P, p.false_alarm);
  } else {
    g.std.assign(static_cast<std::size_t>(s.N()), kNaN);
    g.innovation_std = g.std;
  }
  const double rest = g.rho > 0.0 && g.rho < 1.0 ? std::ceil(std::log(kSettled) / std::log(g.rho)) : 1.0;
  g.recover = static_cast<int>(std::min<double>(rest, structural::kMostRest));
  g.settle = p.settle >= 0 ? std::min(p.settle, structural::kMostRest) : g.recover;
  return g;
}

}  // namespace garrison
