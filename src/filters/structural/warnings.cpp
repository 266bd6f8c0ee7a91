// SPDX-License-Identifier: Apache-2.0
// What a person must know of the verdicts of a run.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "garrison/analysis/modes.hpp"
#include "garrison/core/error.hpp"
#include "garrison/filters/structural/filter.hpp"

namespace garrison {
namespace {

constexpr int kMostNamed = 5;  // sensors named one by one
constexpr int kLong = 10;      // least samples in a row after which a majority of alarms is worth a warning
constexpr double kByChance = 1e-3;  // probability that it is none, of a whole run

struct Counts {
  std::vector<std::int64_t> measured, tested, accused;  // samples of each agent
  int longest = 0;                                      // most samples in a row with most sensors accused
};

Counts count(const VerdictLog& log, int sensors) {
  const auto N = static_cast<std::size_t>(log.agents);
  Counts c{std::vector<std::int64_t>(N), std::vector<std::int64_t>(N), std::vector<std::int64_t>(N)};
  std::size_t at = 0;
  for (int trial = 0; trial < log.trials; ++trial)
    for (int t = 0, row = 0; t < log.times; ++t) {
      int accused = 0;
      for (std::size_t i = 0; i < N; ++i) {
        const auto verdict = static_cast<Verdict>(log.verdict[at++]);
        if (t == 0 || verdict == Verdict::silent) continue;
        ++c.measured[i];
        c.tested[i] += verdict == Verdict::not_tested ? 0 : 1;
        c.accused[i] += verdict == Verdict::attacked ? 1 : 0;
        accused += verdict == Verdict::attacked ? 1 : 0;
      }
      row = sensors > 2 && 2 * accused > sensors ? row + 1 : 0;
      c.longest = std::max(c.longest, row);
    }
  return c;
}

/// Whether a sensor lacks a measurement.
bool misses_some(const Model& model, const Counts& c, const VerdictLog& log) {
  const std::int64_t samples = static_cast<std::int64_t>(log.trials) * (log.times - 1);
  for (std::size_t i = 0; i < c.measured.size(); ++i)
    if (model.outputs(static_cast<int>(i)) > 0 && c.measured[i] < samples) return true;
  return false;
}

std::string percent(std::int64_t part, std::int64_t whole) {
  char word[32];
  std::snprintf(word, sizeof word, "%.0f %%", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return word;
}

/// Samples in a row that honest sensors are hardly ever accused for: an alarm that is false lasts
/// `clear_after` samples, so many samples see one with probability q, and errors that sensors share may make
/// all of them alarm together.
double long_row(const Structural::Params& p, const VerdictLog& log) {
  const double q = 1.0 - std::pow(1.0 - p.false_alarm, p.clear_after);
  const double samples = static_cast<double>(log.trials) * static_cast<double>(log.times);
  return std::max<double>(kLong, p.clear_after * std::ceil(std::log(kByChance / samples) / std::log(q)));
}

/// A line where outputs are in units so different that some of them hardly count: an agent adds up what its
/// sensors say, C_j' y_j, as it is (K_i times the sum), whatever their noise.
void add_units(const Model& model, std::vector<std::string>& all) {
  constexpr double kFar = 1e3;
  double least = kInfinity;
  double most = 0.0;
  for (const Matrix& R : model.noise().measurement_covariance)
    if (R.size() == 1 && R(0, 0) > 0.0) {
      least = std::min(least, std::sqrt(R(0, 0)));
      most = std::max(most, std::sqrt(R(0, 0)));
    }
  if (most > kFar * least)
    all.push_back(
        "measurements have noise from " + text(least) + " to " + text(most) +
        " in their units, and gains weigh them as they are: divide every measurement, its row of C and its "
        "noise by the noise's standard deviation");
}

}  // namespace

std::vector<std::string> Structural::warnings(const Params& params, const Model& model,
                                              const VerdictLog& log) {
  if (log.verdict.empty()) return {};
  int sensors = 0;
  for (int i = 0; i < model.agents(); ++i) sensors += model.outputs(i) > 0 ? 1 : 0;
  const Counts c = count(log, sensors);
  std::vector<std::string> all;
  if (params.gain.empty()) add_units(model, all);
  int named = 0;
  int more = 0;
  for (std::size_t i = 0; i < c.measured.size(); ++i) {
    if (2 * c.tested[i] >= c.measured[i]) continue;
    if (named++ < kMostNamed)
      all.push_back("sensor " + std::to_string(i) + " was tested in " + percent(c.tested[i], c.measured[i]) +
                    " of the samples; in the others it was used untested");
    else
      ++more;
  }
  if (more > 0)
    all.push_back(std::to_string(more) + (more == 1 ? " more sensor was" : " more sensors were") +
                  " tested in less than half of the samples");
  if (c.longest >= long_row(params, log))
    all.push_back("more than half of the sensors were accused for " + amount(c.longest, "sample") +
                  " in a row: that may as well be a wrong model or a wrong estimate");
  if (params.window > 1 && (params.isolate || misses_some(model, c, log)))
    all.push_back(
        "window = " + std::to_string(params.window) +
        ": a test that looks back over a missing measurement, a lost message or an isolated sensor uses "
        "the last sample alone, which does not show what the window would: it accuses or says not tested");
  if (!params.isolate) return all;
  for (const int i : undetectable_agents(model))
    if (c.accused[static_cast<std::size_t>(i)] > 0)
      all.push_back("sensor " + std::to_string(i) +
                    " was accused, but it alone sees a mode that does not decay: with `isolate` it is used "
                    "again when the estimate is no longer surer than it, whether it is right by then or not");
  return all;
}

}  // namespace garrison
