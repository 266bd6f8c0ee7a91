// SPDX-License-Identifier: Apache-2.0
#include "course.hpp"

#include <algorithm>

namespace garrison::detail {
namespace {

/// A certificate takes rows, their variances and, in its bank, A and the process noise of every sample as
/// they are; its levels rest on how many rows may be wrong, and whitened rows on variances.
void require_certifiable(const certificate::Plan& plan, const Model& model, const Series& series) {
  for (std::size_t t = 0; t < series.measurement_covariance.size(); ++t)
    for (int i = 0; i < model.agents(); ++i) {
      const Matrix R = measurement_covariance_at(series, model, i, static_cast<int>(t) + 1);
      if (R.size() == 0 || (R.isDiagonal(0.0) && R.diagonal().minCoeff() > 0.0)) continue;
      refuse("measurement_covariance[" + std::to_string(t) + "] of agent " + std::to_string(i),
             "correlated outputs, or a variance of 0",
             "a diagonal matrix with variances > 0, for a certificate");
    }
  for (std::size_t t = 0; t < series.C.size(); ++t) {
    const auto rows = (series.C[t].array() != 0.0).rowwise().any().count();
    if (rows > plan.all_rows)
      refuse("certificate", "C of sample " + std::to_string(t + 1) + " with " + amount(rows, "nonzero row"),
             "at most " + std::to_string(plan.all_rows) + ", as in the C of the model",
             "give the model rows that are not zero where a sensor ever sees something");
  }
}

/// Whether anything changes that filters and certificates rest on: B is that of the known inputs alone.
bool concerns_filters(const Series& series) {
  return !(series.A.empty() && series.C.empty() && series.process_covariance.empty() &&
           series.measurement_covariance.empty());
}

void require_nonlinear(const Prepared& prepared, const RunOptions& options) {
  if (!options.nonlinear->f || !options.nonlinear->h)
    refuse("nonlinear", options.nonlinear->f ? "no h" : "no f", "both");
  if (options.series != nullptr)
    refuse("series", "matrices over time beside functions", "one of them", "the functions get the time");
  if (!options.inputs.allFinite())
    refuse("inputs", "a number that is not finite", "known inputs at all times");
  for (const int r : options.nonlinear->linear)
    if (r < 0 || r >= prepared.model().total_outputs())
      refuse("linear", "output " + std::to_string(r),
             "numbers of outputs, 0.." + std::to_string(prepared.model().total_outputs() - 1));
  prepared.require_functions();
  const auto plan = prepared.certificate();
  if (plan == nullptr) return;
  if (options.nonlinear->linear.empty())
    refuse("certificate", "a plant by functions without linear outputs", "outputs that are linear",
           "certificates rest on rows of C; see docs/how-to/changing-plants.md");
  if (plan->wanted.memory)
    refuse("memory", "true with a plant by functions", "false",
           "a bank moves by A; regions of single samples hold where rows are linear");
}

}  // namespace

void require_course(const Prepared& prepared, const RunOptions& options, int steps) {
  const Model& model = prepared.model();
  const bool own = prepared.filter().own_states();
  const Matrix& u = options.inputs;
  if (own &&
      (model.inputs() > 0 || u.size() > 0 || options.series != nullptr || options.nonlinear != nullptr))
    refuse("inputs", "inputs, functions or matrices over time with " + prepared.filter().name(),
           "a constant plant without B", "its agents drive plants of their own");
  if (model.inputs() == 0 && u.size() > 0)
    refuse("inputs", std::to_string(u.rows()) + " x " + std::to_string(u.cols()) + " numbers",
           "none, because the model has no B", "give the model B, one column per input");
  if (model.inputs() > 0 && (u.rows() != steps || u.cols() != model.inputs()))
    refuse("inputs", u.size() == 0 ? "none" : std::to_string(u.rows()) + " x " + std::to_string(u.cols()),
           std::to_string(steps) + " x " + std::to_string(model.inputs()) + ", because the model has B",
           "row t is u(t), which leads from time t to t + 1");
  if (options.nonlinear != nullptr) return require_nonlinear(prepared, options);
  if (options.series == nullptr) return;
  require_series(*options.series, model, steps);
  if (!concerns_filters(*options.series)) return;
  if (prepared.certificate() != nullptr) require_certifiable(*prepared.certificate(), model, *options.series);
  prepared.require_varying(*options.series);
}

Course::Course(const Model& model, const RunOptions& options) : model_(model), options_(options) {
  if (options.nonlinear != nullptr) {
    functions_.emplace(*options.nonlinear, model, "the estimate");
    identity_ = Matrix::Identity(model.states(), model.states());
    predictions_.resize(model.states(), model.agents());
  } else if (model.inputs() == 0) {
    return;
  } else {
    response_.emplace(model);
  }
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
  if (functions_) return linearise(runner);
  if (options_.series == nullptr || !concerns_filters(*options_.series)) return;
  const auto now = [t](const std::vector<Matrix>& all) {
    return all.empty() ? nullptr : &all[static_cast<std::size_t>(t - 1)];
  };
  const Series& series = *options_.series;
  Change change{.A = now(series.A), .C = now(series.C), .Q = now(series.process_covariance)};
  change.rows = change.C;
  if (!series.measurement_covariance.empty()) {
    weigh(t);
    change.variance = &variance_;
    change.W = &whitener_;
  }
  runner.vary(change);
}

void Course::weigh(int t) {
  const Matrix& all = options_.series->measurement_covariance[static_cast<std::size_t>(t - 1)];
  variance_.resize(all.rows());
  whitener_.setZero(all.rows(), all.cols());
  for (int i = 0; i < model_.agents(); ++i) {
    const Matrix R = measurement_covariance_at(*options_.series, model_, i, t);
    variance_.segment(model_.offset(i), R.rows()) = R.diagonal();
    // Families whose gains follow R have refused one without an inverse.
    if (const Matrix W = whitener(R); W.size() > 0)
      whitener_.block(model_.offset(i), 0, R.rows(), R.rows()) = W;
  }
}

void Course::linearise(Runner& runner) {
  runner.estimates(predictions_);
  predictions_ = functions_->moved(predictions_, options_.inputs, t_ - 1);
  linearised_ = functions_->rows(predictions_, t_);
  const Matrix& C = linearised_;
  added_ = functions_->measured(predictions_, t_);
  runner.place(predictions_);
  const Matrix* linear = functions_->linear().size() == 0 ? nullptr : &functions_->linear();
  runner.vary({.A = &identity_, .C = &C, .rows = linear});
  for (int i = 0; i < model_.agents(); ++i)
    for (int r = model_.offset(i); r < model_.offset(i) + model_.outputs(i); ++r) {
      double seen = 0.0;  // in the order in which filters sum it: a linear h leaves no rounding
      for (int k = 0; k < model_.states(); ++k) seen += C(r, k) * predictions_(k, i);
      added_(r) -= seen;
      longest_ = std::max(longest_, C.row(r).norm());
    }
  for (const int r : options_.nonlinear->linear) added_(r) = 0.0;  // but for rounding
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
  if (rest_.empty()) return y;
  for (std::size_t k = 0; k < y.size(); ++k) rest_[k] = y[k] - added_(static_cast<Eigen::Index>(k));
  return rest_;
}

void Course::add(int agent, double* y) const {
  if (rest_.empty()) return;
  for (int r = 0; r < model_.outputs(agent); ++r) y[r] += added_(model_.offset(agent) + r);
}

std::string Course::doubt() const {
  constexpr double kOvershoots = 1.5;  // x + c'(y - c x) moves away from where y = c x once |c|^2 > 2
  if (longest_ > kOvershoots)
    return "Rows of dh/dx are up to " + text(longest_) +
           " long; an update with a row longer than 1.41 overshoots, and estimates may diverge: divide that "
           "output "
           "of h, its measurements and their noise by its length.";
  constexpr double kMuch = 1e9;  // leaves 1e-7 of double precision
  if (!(largest_ > kMuch)) return {};
  return "The response to the known inputs alone reaches " + text(largest_) +
         ": measurements without it, and with them estimates and bounds, are exact to " +
         text(largest_ * 0x1p-52) +
         " only. An unstable plant that its inputs hold should be modelled with "
         "its feedback in A.";
}

}  // namespace garrison::detail
