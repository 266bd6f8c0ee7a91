// SPDX-License-Identifier: Apache-2.0
#include "garrison/drivers/simulate.hpp"

#include <cmath>

#include "course.hpp"
#include "trials.hpp"

namespace garrison {
Record simulate(const Prepared& prepared, const PlantOptions& plant, const RunOptions& options) {
  const Model& model = prepared.model();
  if (plant.steps < 1) refuse("steps", std::to_string(plant.steps), "at least 1");
  detail::require_course(prepared, options, plant.steps);
  const bool own = prepared.filter().own_states();
  const int width = own ? model.agents() * model.states() : model.states();
  if (plant.x0.size() != 0 && plant.x0.size() != width)
    refuse("x0", amount(plant.x0.size(), "number"),
           std::to_string(width) + (own ? ", one per agent and state" : ", one per state"));
  if (!plant.x0.allFinite()) refuse("x0", "a number that is not finite", "a finite initial state");
  if (!(plant.start_error >= 0.0) || !std::isfinite(plant.start_error))
    refuse("start_error", text(plant.start_error), "a finite number >= 0");
  if (own) {
    const Matrix* recorded = plant.disturbances.size() == 0 ? nullptr : &plant.disturbances;
    if (recorded != nullptr && recorded->rows() != plant.steps + 1)
      refuse("noise", amount(recorded->rows(), "row") + " of recorded disturbances",
             std::to_string(plant.steps + 1) + ", one per time 0..steps");
    const Matrix start = detail::starts(model, options.start);
    return detail::run_trials(prepared, plant.steps, true, options, [&](std::uint32_t trial) {
      return detail::world_source(prepared.world({plant.x0, start, plant.start_error, plant.noise, recorded,
                                                  options.seed, detail::drawn_as(options, trial)}),
                                  model.agents());
    });
  }
  if (plant.disturbances.size() != 0)
    refuse("noise", "recorded disturbances", "the name of a noise law",
           "only families whose agents drive plants of their own take recorded ones");
  const detail::NoiseLaw law(plant.noise, model, options.series.get());
  return detail::run_trials(prepared, plant.steps, true, options, [&](std::uint32_t trial) {
    return detail::simulated_source(model, law, plant, options, detail::drawn_as(options, trial));
  });
}

Record simulate(const Model& model, const Network& network, const AnyFilter& filter,
                const PlantOptions& plant, const RunOptions& options) {
  return simulate(*filter.prepare(model, network), plant, options);
}

Record replay(const Prepared& prepared, const Log& log, const RunOptions& options) {
  const Model& model = prepared.model();
  if (log.steps < 1) refuse("measurements", amount(log.steps, "sample"), "at least 1");
  detail::require_course(prepared, options, log.steps);
  if (log.runs != 1 && log.runs != options.trials)
    refuse("trials", std::to_string(options.trials), std::to_string(log.runs) + ", one per run of the log",
           "a log of one run serves any number of trials");
  const auto rows = static_cast<std::size_t>(log.runs) *
                    static_cast<std::size_t>(log.steps + 1 - prepared.filter().first_sample());
  prepared.check_log({log.measurements, rows * static_cast<std::size_t>(model.total_outputs())});
  const int width = prepared.filter().own_states() ? model.agents() * model.states() : model.states();
  return detail::run_trials(prepared, log.steps, log.truth != nullptr, options, [&](std::uint32_t trial) {
    return detail::recorded_source(model, log, log.runs == 1 ? 0 : trial, width,
                                   prepared.filter().first_sample());
  });
}

Record replay(const Model& model, const Network& network, const AnyFilter& filter, const Log& log,
              const RunOptions& options) {
  return replay(*filter.prepare(model, network), log, options);
}

Record replay(const Model& model, const Network& network, const AnyFilter& filter,
              const MatrixRef& measurements, const MatrixRef& truth, const RunOptions& options) {
  const auto shape = [](const MatrixRef& m) {
    return std::to_string(m.rows()) + " x " + std::to_string(m.cols());
  };
  if (measurements.rows() < 1 || measurements.cols() != model.total_outputs())
    refuse("measurements", shape(measurements), "steps x " + std::to_string(model.total_outputs()),
           "one column per row of the C_i, agent by agent; NaN where a measurement is missing");
  const auto steps = measurements.rows() + filter.first_sample() - 1;
  const int width = filter.own_states() ? model.agents() * model.states() : model.states();
  if (truth.size() != 0 && (truth.rows() != steps + 1 || truth.cols() != width))
    refuse("truth", shape(truth), std::to_string(steps + 1) + " x " + std::to_string(width),
           "one row per time 0..steps");
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Rows y = measurements;
  const Rows x = truth;
  return replay(model, network, filter,
                Log{y.data(), x.size() == 0 ? nullptr : x.data(), 1, static_cast<int>(steps)}, options);
}

}  // namespace garrison
