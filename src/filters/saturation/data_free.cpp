// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/saturation/data_free.hpp"

#include <memory>

#include "facts.hpp"
#include "garrison/certificate/table.hpp"
#include "garrison/kernel/average.hpp"

namespace garrison::saturation {
namespace {

constexpr int kMostNumbers = 400;
constexpr int kMostWindow = 512;
constexpr int kFewestSteps = 32;
constexpr int kMostSteps = 4096;
/// Of what lies before the window, so much may be left (largest row sum).
constexpr double kForgotten = 1e-3;
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

/// Hops between the agents that are furthest apart; of a connected network.
int diameter(const Network& network) {
  int furthest = 0;
  const auto N = static_cast<std::size_t>(network.agents());
  for (int from = 0; from < network.agents(); ++from) {
    std::vector<int> hops(N, -1);
    std::vector<int> queue{from};
    hops[static_cast<std::size_t>(from)] = 0;
    for (std::size_t at = 0; at < queue.size(); ++at)
      for (const int j : network.neighbours(queue[at])) {
        int& found = hops[static_cast<std::size_t>(j)];
        if (found >= 0) continue;
        found = hops[static_cast<std::size_t>(queue[at])] + 1;
        queue.push_back(j);
      }
    furthest = std::max(furthest, hops[static_cast<std::size_t>(queue.back())]);
  }
  return furthest;
}

}  // namespace

DataFree DataFree::of(int agent) const {
  if (empty()) return {};
  return {d.col(column(agent)), H.col(column(agent)), worst, proved.of(column(agent)), agent};
}

Matrix averaging(const Network& network, double alpha, std::span<const double> omega, int rounds) {
  const int N = network.agents();
  Matrix J = Matrix::Identity(N, N);
  Matrix before = J;
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
  }
  return J;
}

DataFree data_free(const Model& model, const Network& network, const DataFreeOptions& o) {
  const int numbers = model.agents() * model.states();
  if (numbers > kMostNumbers)
    refuse("saturation.table", "a network of " + std::to_string(numbers) + " numbers (agents times states)",
           "at most " + std::to_string(kMostNumbers), "leave it out: the bound of the paper remains");
  const Matrix C = detail::sensor_rows(model);
  const Matrix J = averaging(network, o.alpha, o.omega, o.rounds);
  const auto system = certificate::error_system(model.A(), C, J);
  const auto kernels = kernels_of(system);
  const double b_w = model.noise().process_bound;
  const Vector& b_v = model.noise().measurement_bound;
  certificate::TableOptions options{.s = o.attacked, .start = o.initial_error, .T = 1};
  if (!std::isnan(o.beta)) options.beta = o.beta;
  // What holds for ever is no less than the last window: until it is not the start that is seen there.
  const auto for_ever = [](const certificate::Table& table) {
    return table.steady ? table.steady->d.maxCoeff() : kInfinity;
  };
  options.T = std::max(kFewestSteps, kernels.window() + 2);
  auto table = std::make_unique<certificate::Table>(certificate::table(kernels, options, b_w, b_v));
  double before = kInfinity;
  while (options.T < kMostSteps && table->d.row(options.T).allFinite() &&
         !(for_ever(*table) > kSettled * before)) {
    before = for_ever(*table);
    options.T *= 2;
    *table = certificate::table(kernels, options, b_w, b_v);
  }
  DataFree found;
  const Eigen::Index last = options.T + 1;
  found.d = Matrix::Constant(last + 1, model.agents(), kInfinity);
  found.H = found.d;
  found.d.topRows(last) = table->d;
  found.H.topRows(last) = table->H;
  if (table->steady) {
    found.d.row(last) = table->steady->d.transpose();
    found.H.row(last) = (table->steady->eta + system.row_length * b_w + b_v).transpose();
  }
  found.worst = found.d.rowwise().maxCoeff();
  if (o.detector && o.rounds > 0)
    found.proved = proved_sets(model.A(), C, J, o.attacked, diameter(network), o.rounds, b_w, b_v);
  return found;
}

}  // namespace garrison::saturation
