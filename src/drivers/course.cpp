// SPDX-License-Identifier: Apache-2.0
#include "course.hpp"

#include <algorithm>

namespace garrison::detail {
namespace {

/// A certificate takes the rows of every sample as they are; what is carried from sample to sample rests on A
/// and the process noise, and the levels on how many rows may be wrong.
void require_certifiable(const certificate::Plan& plan, const Series& series) {
  if (!series.A.empty() || !series.process_covariance.empty())
    refuse("certificate", "a plant whose A or process_covariance changes in time",
           "one of which C alone changes", "see docs/how-to/changing-plants.md");
  for (std::size_t t = 0; t < series.C.size(); ++t) {
    const auto rows = (series.C[t].array() != 0.0).rowwise().any().count();
    if (rows > plan.all_rows)
      refuse("certificate",
             "C of sample " + std::to_string(t + 1) + " with " + std::to_string(rows) +
                 " rows that are not zero",
             "at most " + std::to_string(plan.all_rows) + ", as in the C of the model",
             "give the model rows that are not zero where a sensor ever sees something");
  }
}

}  // namespace

void require_course(const Prepared& prepared, const RunOptions& options, int steps) {
  const Model& model = prepared.model();
  const bool own = prepared.filter().own_states();
  const Matrix& u = options.inputs;
  if (own && (model.inputs() > 0 || u.size() > 0 || options.series != nullptr))
    refuse("inputs", "inputs or matrices over time with " + prepared.filter().name(),
           "a constant plant without B", "its agents drive plants of their own");
  if (model.inputs() == 0 && u.size() > 0)
    refuse("inputs", std::to_string(u.rows()) + " x " + std::to_string(u.cols()) + " numbers",
           "none, because the model has no B", "give the model B, one column per input");
  if (model.inputs() > 0 && (u.rows() != steps || u.cols() != model.inputs()))
    refuse("inputs", u.size() == 0 ? "none" : std::to_string(u.rows()) + " x " + std::to_string(u.cols()),
           std::to_string(steps) + " x " + std::to_string(model.inputs()) + ", because the model has B",
           "row t is u(t), which leads from time t to t + 1");
  if (options.series == nullptr) return;
  require_series(*options.series, model, steps);
  if (prepared.certificate() != nullptr) require_certifiable(*prepared.certificate(), *options.series);
  if (options.series->A.empty() && options.series->C.empty()) return;
  prepared.require_varying();
}

Course::Course(const Model& model, const RunOptions& options) : model_(model), options_(options) {
  if (model.inputs() == 0) return;
  response_.emplace(model);
  stacked_ = model.stacked();
  added_ = Vector::Zero(model.total_outputs());
  rest_.resize(static_cast<std::size_t>(model.total_outputs()));
}

const Matrix& Course::rows() const {
  const Series* series = options_.series.get();
  return series == nullptr || series->C.empty() ? stacked_ : series->C[static_cast<std::size_t>(t_ - 1)];
}

void Course::enter(int t, Runner& runner) {
  enter(t);
  const Series* series = options_.series.get();
  if (series == nullptr || (series->A.empty() && series->C.empty())) return;
  const auto at = static_cast<std::size_t>(t - 1);
  runner.vary(series->A.empty() ? nullptr : &series->A[at], series->C.empty() ? nullptr : &series->C[at]);
}

void Course::enter(int t) {
  t_ = t;
  if (!response_) return;
  static const Series constant;
  const Series& series = options_.series == nullptr ? constant : *options_.series;
  response_->advance(series.A_at(model_, t), series.B_at(model_, t), options_.inputs.row(t - 1).transpose());
  added_.noalias() = rows() * response_->state();
  largest_ = std::max(largest_, response_->state().cwiseAbs().maxCoeff());
}

std::span<const double> Course::without(std::span<const double> y) {
  if (!response_) return y;
  for (std::size_t k = 0; k < y.size(); ++k) rest_[k] = y[k] - added_(static_cast<Eigen::Index>(k));
  return rest_;
}

void Course::add(int agent, double* y) const {
  if (!response_) return;
  for (int r = 0; r < model_.outputs(agent); ++r) y[r] += added_(model_.offset(agent) + r);
}

std::string Course::doubt() const {
  constexpr double kMuch = 1e9;  // leaves 1e-7 of double precision
  if (!(largest_ > kMuch)) return {};
  return "The response to the known inputs alone reaches " + text(largest_) +
         ": measurements without it, and with them estimates and bounds, are exact to " +
         text(largest_ * 0x1p-52) +
         " only. An unstable plant that its inputs hold should be modelled with "
         "its feedback in A.";
}

}  // namespace garrison::detail
