// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/lfre.hpp"

#include <algorithm>
#include <cmath>

#include "core/solvers.hpp"
#include "garrison/analysis/lyapunov.hpp"
#include "garrison/analysis/observability.hpp"
#include "garrison/analysis/poles.hpp"
#include "garrison/core/spectrum.hpp"
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
    refuse("lfre.poles", amount(given.size(), "number"), std::to_string(n) + ", one per state");
  for (const double pole : given)
    if (!(std::abs(pole) < 1.0))
      refuse("lfre.poles", text(pole), "numbers between -1 and 1, these excluded",
             "an observer with such a pole never forgets its start");
}

std::vector<double> spaced_poles(double first, int n) {
  std::vector<double> poles;
  for (int k = 0; k < n; ++k) poles.push_back(n == 1 ? first : first + kWidth * k / (n - 1));
  return poles;
}

/// tr X, X = M X M' + F: inf where it grows, or is too sensitive to be computed.
double steady_trace(const Matrix& M, const Matrix& F) {
  try {
    return lyapunov(M, F).trace();
  } catch (const InvalidInput&) {
    return kInfinity;
  }
}

/// Covariances of agent i's outputs and of w, per state: the given ones, else what bounds allow, else 1 and
/// 0.
struct NoiseOf {
  Matrix measurement;
  Matrix process;
};
NoiseOf noise_of(const Model& model, int i) {
  const Noise& noise = model.noise();
  const int m = model.outputs(i);
  NoiseOf of{Matrix::Identity(m, m), Matrix::Zero(model.states(), model.states())};
  if (!noise.measurement_covariance.empty())
    of.measurement = noise.measurement_covariance[static_cast<std::size_t>(i)];
  else if (noise.measurement_bound.size() > 0)
    of.measurement *= std::pow(noise.measurement_bound(i), 2) / 3.0;  // uniform within the bound
  if (noise.process_covariance.size() > 0)
    of.process = noise.process_covariance;
  else if (!std::isnan(noise.process_bound))
    of.process.diagonal().setConstant(std::pow(noise.process_bound, 2) / (3.0 * model.states()));
  return of;
}

/// L^-1 with R = L L', so that H of least norm for the rows L^-1 C weighs outputs by their noise; I where R
/// is singular.
Matrix whitening(const Matrix& R) {
  const Matrix found = whitener(R);
  return found.size() > 0 && found.allFinite() ? found : Matrix(Matrix::Identity(R.rows(), R.rows()));
}

bool distinct(std::vector<double> poles) {
  std::sort(poles.begin(), poles.end());
  return std::adjacent_find(poles.begin(), poles.end()) == poles.end();
}

/// Outputs that see the whole state alone; C sees it.
std::vector<Eigen::Index> seeing(const Matrix& A, const Matrix& C) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index r = 0; r < C.rows(); ++r)
    if (C.rows() == 1 || surely_observable(A, C.row(r))) found.push_back(r);
  return found;
}

/// Gains that place the poles: with each output of `alone`, and with all of them.
std::vector<Matrix> gains_for(const Matrix& A, const Matrix& C, const std::vector<Eigen::Index>& alone,
                              const Matrix& R, const std::vector<double>& poles) {
  std::vector<Matrix> found;
  for (const Eigen::Index r : alone) {
    found.push_back(Matrix::Zero(A.rows(), C.rows()));
    found.back().col(r) = place_poles(A, C.row(r), poles);
  }
  if (C.rows() > 1 && (found.empty() || distinct(poles))) {
    const Matrix whiten = whitening(R);
    found.push_back(place_poles(A, whiten * C, poles) * whiten);
  }
  return found;
}

/// The observer whose steady mean square error is least: given poles, or default ones from fast to slow.
Matrix quietest(const Lfre::Params& params, const Matrix& A, const Matrix& C, const NoiseOf& noise) {
  constexpr int kChoices = 11;
  std::vector<std::vector<double>> choices;
  if (!params.poles.empty()) choices.push_back(params.poles);
  for (int k = 0; k < kChoices && params.poles.empty(); ++k)
    choices.push_back(
        spaced_poles(kFastest + (kSlowest - kFastest) * k / (kChoices - 1), static_cast<int>(A.rows())));
  const std::vector<Eigen::Index> alone = seeing(A, C);
  Matrix best;
  double least = kInfinity;
  for (const auto& poles : choices)
    for (const Matrix& H : gains_for(A, C, alone, noise.measurement, poles)) {
      const double error = steady_trace(A - H * C, noise.process + H * noise.measurement * H.transpose());
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
    Matrix& H = g.observer.emplace_back();
    if (model.outputs(i) == 0 || !surely_observable(model.A(), model.C(i))) continue;
    H = quietest(params, model.A(), model.C(i), noise_of(model, i));
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
    const Matrix closed = model.A() - g.observer[i] * model.C(static_cast<int>(i));
    slowest = std::max(slowest, spectral_radius(closed));
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
