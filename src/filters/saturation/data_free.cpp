// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/data_free.hpp"

#include <functional>
#include <memory>

#include "core/hops.hpp"
#include "facts.hpp"
#include "garrison/certificate/gaussian_table.hpp"
#include "garrison/certificate/quantiles.hpp"
#include "garrison/kernel/average.hpp"

namespace garrison::saturation {
namespace {

constexpr int kMostNumbers = 400;
constexpr int kFewestSteps = 32;
constexpr int kMostSteps = 4096;
/// Of what lies before the window, so much may be left (largest row sum).
constexpr double kForgotten = 1e-3;
/// Of an excess, so much may be left after a window: it decays as fast as it can be said to.
constexpr double kExcessLeft = 0.25;
/// Twice the steps make what holds for ever no smaller than this part of it: enough.
constexpr double kSettled = 0.99;

/// Kernels of a window behind which little is left, as far as it pays.
certificate::Kernels kernels_of(const certificate::ErrorSystem& system) {
  for (int window = 4;; window *= 2) {
    auto kernels = certificate::kernels(system, window);
    const double left = kernels.Rb.back().rowwise().sum().maxCoeff();
    if (left < kForgotten || window >= kMostWindow || !(left < 1e9)) return kernels;
  }
}

/// The excess over a window after which little of it is left, as far as it pays.
certificate::Recovery excess_of(const certificate::ErrorSystem& system, certificate::Kernels kernels, int s) {
  for (;;) {
    certificate::Recovery found(kernels, s);
    const double left = found.left();
    const int window = kernels.window();
    if (left < kExcessLeft || !(left < 1e9) || 2 * window > kMostWindow) return found;
    kernels = certificate::kernels(system, 2 * window);
  }
}

/// What relays and levels rest on: errors between `sense` and the rounds where nothing is lost, and the
/// plant.
LossTables loss_tables(const certificate::ErrorSystem& system, const DataFree& table, const Vector& spread,
                       double beta, double b_w, const Vector& b_v) {
  LossTables found;
  found.growth = certificate::spectral_norm(system.A);
  found.noise = b_w;
  found.spread = spread;
  found.reach = system.CA.rowwise().norm();
  found.width = system.row_length * b_w + b_v;
  found.predicted = Vector::Constant(table.d.rows(), kInfinity);
  const Eigen::Index last = table.d.rows() - 1;
  for (Eigen::Index t = 1; t <= last; ++t) {
    const auto before =
        table.d.row(t == last ? last : t - 1);  // what holds for ever is no less than d(last - 1)
    double most = 0.0;
    for (Eigen::Index j = 0; j < b_v.size(); ++j) {
      // Clipped at the level; or used in full by one that has identified all attackers: then noise is left of
      // it.
      const double level = std::isnan(beta) ? table.H(t, j) : std::max(beta, b_v(j));
      most = std::max(most, found.growth * before(j) + (system.row_length(j) == 0.0 ? 0.0 : level));
    }
    found.predicted(t) = most + b_w;
  }
  return found;
}

/// A table of either kind of noise: bounds and levels of t = 0..T, and those for ever, where there are any.
struct Nominal {
  certificate::Gains d, H;
  Vector last_d{}, last_H{};
};

/// Makes a table of as many steps as `options` say then.
std::function<Nominal()> bounded(const certificate::Kernels& kernels,
                                 const certificate::TableOptions& options, double b_w, const Vector& b_v) {
  return [&, b_w] {
    const auto table = certificate::table(kernels, options, b_w, b_v);
    Nominal found{table.d, table.H};
    if (!table.steady) return found;
    found.last_d = table.steady->d;
    found.last_H = table.steady->eta + kernels.system.row_length * b_w + b_v;
    return found;
  };
}

/// The same for Gaussian noise. Half of the failure probability is that some innovation's noise is beyond z,
/// half that some error's is beyond its quantile, shared by all agents and samples.
std::function<Nominal()> gaussian(const certificate::Kernels& kernels,
                                  const certificate::TableOptions& options, const Model& model,
                                  const DataFreeOptions& o) {
  const double each = 0.5 * o.failure / (static_cast<double>(model.agents()) * o.horizon);
  const double z = certificate::two_sided(each);
  const double chi = certificate::chi(each, model.states());
  Vector R = Vector::Zero(model.agents());
  for (int i = 0; i < model.agents(); ++i)
    if (model.outputs(i) == 1) R(i) = model.noise().measurement_covariance[static_cast<std::size_t>(i)](0, 0);
  return [&, z, chi, R] {
    const auto found = certificate::gaussian_table(kernels, options, model.noise().process_covariance, R, z);
    const certificate::Table& rest = found.table;
    Nominal table{rest.d + chi * found.deviation, rest.H};
    if (!rest.steady) return table;
    table.last_d = rest.steady->d + chi * found.deviation_for_ever;
    table.last_H = rest.steady->eta + z * found.innovation_for_ever;
    return table;
  };
}

}  // namespace

DataFree DataFree::of(int agent) const {
  if (empty()) return {};
  DataFree part;
  part.d = d.col(column(agent));
  part.H = H.col(column(agent));
  part.until = until;
  part.worst = worst;
  part.proved = proved.of(column(agent));
  part.losses = losses.of(column(agent));
  part.only = agent;
  return part;
}

Matrix averaging(const Network& network, double alpha, std::span<const double> omega, int rounds,
                 Vector* spread) {
  const int N = network.agents();
  Matrix J = Matrix::Identity(N, N);
  Matrix before = J;
  if (spread != nullptr) *spread = Vector::Ones(rounds + 1);
  for (int round = 0; round < rounds; ++round) {
    const Matrix now = J;
    for (int i = 0; i < N; ++i) {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(N);
      for (const int j : network.neighbours(i)) sum += now.row(j);
      const double weight = omega.empty() ? 1.0 : omega[static_cast<std::size_t>(round)];
      for (int k = 0; k < N; ++k)
        J(i, k) = averaged_entry(now(i, k), sum(k), static_cast<double>(network.degree(i)), alpha, weight,
                                 before(i, k));
    }
    before = now;
    if (spread != nullptr) (*spread)(round + 1) = J.cwiseAbs().rowwise().sum().maxCoeff();
  }
  return J;
}

DataFree data_free(const Model& model, const Network& network, const DataFreeOptions& o) {
  const int numbers = model.agents() * model.states();
  if (numbers > kMostNumbers)
    refuse("saturation.table", "a network of " + amount(numbers, "number") + " (agents times states)",
           "at most " + std::to_string(kMostNumbers), "leave it out: the bound of the paper remains");
  const Matrix C = detail::sensor_rows(model);
  Vector spread;
  const Matrix J = averaging(network, o.alpha, o.omega, o.rounds, &spread);
  const auto system = certificate::error_system(model.A(), C, J);
  const auto kernels = kernels_of(system);
  const Noise& noise = model.noise();
  certificate::TableOptions options{.s = o.attacked, .start = o.initial_error, .T = 1};
  if (!std::isnan(o.beta)) options.beta = o.beta;
  const std::function<Nominal()> make =
      o.failure > 0.0 ? gaussian(kernels, options, model, o)
                      : bounded(kernels, options, noise.process_bound, noise.measurement_bound);
  // What holds for ever is no less than the last window: until it is not the start that is seen there.
  const auto for_ever = [](const Nominal& table) {
    return table.last_d.size() > 0 ? table.last_d.maxCoeff() : kInfinity;
  };
  options.T = std::max(kFewestSteps, kernels.window() + 2);
  auto table = std::make_unique<Nominal>(make());
  double before = kInfinity;
  while (options.T < kMostSteps && table->d.row(options.T).allFinite() &&
         !(for_ever(*table) > kSettled * before)) {
    before = for_ever(*table);
    options.T *= 2;
    *table = make();
  }
  DataFree found;
  const Eigen::Index last = options.T + 1;
  found.d = Matrix::Constant(last + 1, model.agents(), kInfinity);
  found.H = found.d;
  found.d.topRows(last) = table->d;
  found.H.topRows(last) = table->H;
  if (table->last_d.size() > 0) {
    found.d.row(last) = table->last_d.transpose();
    found.H.row(last) = table->last_H.transpose();
  }
  if (o.failure > 0.0) found.until = o.horizon;
  found.worst = found.d.rowwise().maxCoeff();
  if (o.failure > 0.0) return found;  // theorems I and L need bounded noise here
  if (o.detector && o.rounds > 0)
    found.proved = proved_sets(model.A(), C, J, o.attacked, garrison::detail::diameter(network).value(),
                               o.rounds, noise.process_bound, noise.measurement_bound);
  if (o.recovery) {
    found.losses = loss_tables(system, found, spread, o.beta, noise.process_bound, noise.measurement_bound);
    found.losses.excess = excess_of(system, kernels, o.attacked);
  }
  return found;
}

}  // namespace garrison::saturation
