// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/lfre.hpp"

#include <cmath>

#include "core/solvers.hpp"
#include "garrison/analysis/lyapunov.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/engine/filter_of.hpp"

namespace garrison {
namespace {

/// Fastest default poles lie between this and 0.1 above it, slower ones up to 0.9: then an error of the start
/// falls to a tenth in 20 samples.
constexpr double kFastest = 0.3;
constexpr double kSlowest = 0.8;
constexpr double kWidth = 0.1;

void require_poles(const std::vector<double>& given, int n) {
  if (!given.empty() && static_cast<int>(given.size()) != n)
    refuse("lfre.poles", std::to_string(given.size()) + " numbers", std::to_string(n) + ", one per state");
}

std::vector<double> spaced_poles(double first, int n) {
  std::vector<double> poles;
  for (int k = 0; k < n; ++k) poles.push_back(n == 1 ? first : first + kWidth * k / (n - 1));
  return poles;
}

/// Ackermann: the unique H with eig(A - H c) = poles, for an observable pair (A, c).
Vector ackermann(const Matrix& A, const Matrix& c, const std::vector<double>& poles) {
  const auto n = A.rows();
  Matrix polynomial = Matrix::Identity(n, n);
  for (const double pole : poles) polynomial *= A - pole * Matrix::Identity(n, n);
  Matrix O(n, n);
  O.row(0) = c;
  for (Eigen::Index k = 1; k < n; ++k) O.row(k) = O.row(k - 1) * A;
  return polynomial * O.partialPivLu().solve(Vector::Unit(n, n - 1));
}

/// tr X, X = M X M' + F: inf where it grows, or is too sensitive to be computed.
double steady_trace(const Matrix& M, const Matrix& F) {
  try {
    return lyapunov(M, F).trace();
  } catch (const InvalidInput&) {
    return kInfinity;
  }
}

/// Variances of agent i's first output and of w, per state: the covariances, else what bounds allow, else 1
/// and 0.
struct NoiseOf {
  double measurement;
  Matrix process;
};
NoiseOf noise_of(const Model& model, int i) {
  const Noise& noise = model.noise();
  const auto k = static_cast<std::size_t>(i);
  NoiseOf of{1.0, Matrix::Zero(model.states(), model.states())};
  if (!noise.measurement_covariance.empty())
    of.measurement = noise.measurement_covariance[k](0, 0);
  else if (noise.measurement_bound.size() > 0)
    of.measurement = std::pow(noise.measurement_bound(i), 2) / 3.0;  // uniform within the bound
  if (noise.process_covariance.size() > 0)
    of.process = noise.process_covariance;
  else if (!std::isnan(noise.process_bound))
    of.process.diagonal().setConstant(std::pow(noise.process_bound, 2) / (3.0 * model.states()));
  return of;
}

/// The observer whose steady mean square error is least, over default poles from fast to slow.
Vector quietest(const Matrix& A, const Matrix& c, const NoiseOf& noise) {
  constexpr int kChoices = 11;
  Vector best;
  double least = kInfinity;
  for (int k = 0; k < kChoices; ++k) {
    const double first = kFastest + (kSlowest - kFastest) * k / (kChoices - 1);
    const Vector H = ackermann(A, c, spaced_poles(first, static_cast<int>(A.rows())));
    const Matrix F = noise.process + noise.measurement * H * H.transpose();
    const double error = steady_trace(A - H * c, F);
    if (best.size() > 0 && !(error < least)) continue;
    least = error;
    best = H;
  }
  return best;
}

}  // namespace

Lfre::Gains Lfre::design(const Params& params, const Model& model, const Network& network) {
  const int N = model.agents();
  require_poles(params.poles, model.states());
  Gains g;
  g.faulty = params.faulty;
  std::vector<int> distance(static_cast<std::size_t>(N), -1);
  std::vector<int> queue;
  for (int i = 0; i < N; ++i) {
    const bool source = model.outputs(i) > 0 && observable(model.A(), model.C(i).topRows(1));
    Vector& H = g.observer.emplace_back();
    if (!source) continue;
    const Matrix c = model.C(i).topRows(1);
    H = params.poles.empty() ? quietest(model.A(), c, noise_of(model, i))
                             : ackermann(model.A(), c, params.poles);
    distance[static_cast<std::size_t>(i)] = 0;
    queue.push_back(i);
  }
  if (queue.empty())
    refuse("model", "no agent that can observe the whole state alone", "at least one",
           "lfre spreads the estimates of such sources; use the saturation filter here");
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (int j = 0; j < N; ++j) {
      const auto heard = network.neighbours(j);
      if (distance[static_cast<std::size_t>(j)] >= 0 ||
          !std::binary_search(heard.begin(), heard.end(), queue[k]))
        continue;
      distance[static_cast<std::size_t>(j)] = distance[static_cast<std::size_t>(queue[k])] + 1;
      queue.push_back(j);
    }
  for (int i = 0; i < N; ++i) {
    auto& parents = g.parents.emplace_back();
    const int own = distance[static_cast<std::size_t>(i)];
    for (const int j : network.neighbours(i)) {
      const int theirs = distance[static_cast<std::size_t>(j)];
      if (theirs >= 0 && (own < 0 || theirs < own)) parents.push_back(j);
    }
    const auto heard = network.neighbours(i);
    if (static_cast<int>(parents.size()) < 2 * g.faulty + 1) parents.assign(heard.begin(), heard.end());
  }
  return g;
}

Check Lfre::check(const Params& params, const Model& model, const Network& network) {
  Check c;
  const Gains g = design(params, model, network);
  double sources = 0.0;
  double loudest = 0.0;
  double slowest = 0.0;
  std::size_t fewest = static_cast<std::size_t>(model.agents());
  for (std::size_t i = 0; i < g.observer.size(); ++i) {
    if (g.observer[i].size() == 0) {
      fewest = std::min(fewest, g.parents[i].size());
      continue;
    }
    sources += 1.0;
    const Matrix one = model.C(static_cast<int>(i)).topRows(1);
    const Matrix closed = model.A() - g.observer[i] * one;
    slowest =
        std::max(slowest, Eigen::EigenSolver<Matrix>(closed, false).eigenvalues().cwiseAbs().maxCoeff());
    // Steady error per unit of measurement noise: sqrt(tr X), X = (A - H c) X (A - H c)' + H H'.
    loudest = std::max(loudest, std::sqrt(steady_trace(closed, g.observer[i] * g.observer[i].transpose())));
  }
  const double needed = 2.0 * g.faulty + 1.0;
  c.conditions.push_back({"sources", sources, ">= " + text(needed), sources >= needed,
                          "agents that observe the whole state alone"});
  c.conditions.push_back({"fewest parents", static_cast<double>(fewest), ">= " + text(needed),
                          static_cast<double>(fewest) >= needed,
                          "trimming leaves at least one honest value"});
  const bool settles = std::isfinite(loudest);
  c.quantities.push_back(
      {"noise gain", settles ? loudest : kNaN,
       settles ? "steady error of the worst source per unit of its measurement noise; slower poles lower it"
               : "the error of some source's observer grows, or its gain is too large to tell: choose "
                 "poles inside of (-1, 1), slower ones"});
  c.quantities.push_back({"slowest pole", slowest, "modulus, of the sources' observers"});
  return c;
}

template FamilyInfo family_info<Lfre>();

}  // namespace garrison
