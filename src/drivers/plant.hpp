// SPDX-License-Identifier: Apache-2.0
// Where the measurements of one trial come from. Internal to the drivers.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "garrison/core/model.hpp"
#include "garrison/core/random.hpp"
#include "garrison/drivers/simulate.hpp"

namespace garrison::detail {

/// Source of truth and measurements, sample by sample.
class Source {
 public:
  virtual ~Source() = default;
  /// Initial estimates of this trial (n x N) from the given ones.
  virtual Matrix start(const Matrix& given) const = 0;
  /// Called once before the first sample with what the agents of this trial run on.
  virtual void meet(const Runner&) {}
  /// The state at the present time; null when it is not known.
  virtual const double* truth() const = 0;
  /// Moves to time t and writes its measurements.
  virtual void next(std::int64_t t, std::span<double> y) = 0;
};

/// Noise law of a plant, resolved and checked against what the model knows.
class NoiseLaw {
 public:
  /// `series`: covariances over time, or null. `ids`: public ids of the model's agents, under which their
  /// noise is drawn; empty = 0, 1, ..
  NoiseLaw(const std::string& law, const Model& model, const Series* series, std::vector<int> ids = {});
  void process(const Random& random, std::int64_t t, Vector& w) const;
  void measurement(const Random& random, std::int64_t t, std::span<double> y) const;

 private:
  enum class Kind { none, uniform, extreme, normal };
  const Model& model_;
  std::vector<int> ids_;
  Kind process_ = Kind::none;
  Kind measurement_ = Kind::none;
  Matrix process_root_;
  std::vector<Matrix> process_roots_;      // over time
  std::size_t samples_ = 1;                // with roots of their own
  std::vector<Matrix> measurement_roots_;  // sample by sample, agent by agent
};

/// A random vector of length at most `radius` (uniform in the ball), or of exactly that length.
void ball(const Random& random, std::int64_t t, std::uint32_t agent, double radius, bool on_sphere,
          Vector& out);

std::unique_ptr<Source> simulated_source(const Model& model, const NoiseLaw& law, const PlantOptions& plant,
                                         const RunOptions& options, std::uint32_t trial);
std::unique_ptr<Source> recorded_source(const Model& model, const Log& log, std::uint32_t run, int width,
                                        int first_sample);
/// Agents that drive plants of their own.
std::unique_ptr<Source> world_source(std::unique_ptr<World> world, int agents);

}  // namespace garrison::detail
