// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/model.hpp"

#include <algorithm>
#include <utility>

#include "core/spectrum.hpp"
#include "garrison/core/covariance.hpp"
#include "garrison/core/params.hpp"

namespace garrison {
namespace {

std::string shape(const Matrix& m) { return std::to_string(m.rows()) + " x " + std::to_string(m.cols()); }

void require_finite(const std::string& which, const Matrix& m) {
  for (Eigen::Index j = 0; j < m.cols(); ++j)
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      if (!std::isfinite(m(i, j)))
        refuse(which + "[" + std::to_string(i) + ", " + std::to_string(j) + "]", text(m(i, j)),
               "a finite number", "replace or remove it");
      else if (std::abs(m(i, j)) > kHuge)
        refuse(which + "[" + std::to_string(i) + ", " + std::to_string(j) + "]", text(m(i, j)),
               "a number of size at most " + text(kHuge));
}

void require_covariance(const std::string& which, const Matrix& m, Eigen::Index size) {
  if (m.rows() != size || m.cols() != size)
    refuse(which, shape(m), std::to_string(size) + " x " + std::to_string(size));
  require_finite(which, m);
  garrison::require_covariance(which, m);
}

void require_bound(const std::string& which, double value) {
  if (!(value >= 0.0) || !std::isfinite(value))
    refuse(which, text(value), "a finite number >= 0", "leave it out when it is not known");
  if (value > kHuge) refuse(which, text(value), "a number of size at most " + text(kHuge));
}

void require_labels(const Labels& labels, const Model& model) {
  const auto outputs = static_cast<std::size_t>(model.total_outputs());
  require_names("states", labels.states, static_cast<std::size_t>(model.states()), "state");
  require_names("outputs", labels.outputs, outputs, "measurement of the whole network");
  if (!labels.sources.empty() && labels.sources.size() != outputs)
    refuse("sources", amount(labels.sources.size(), "name"),
           std::to_string(outputs) + ", one per measurement of the whole network");
  require_names("inputs", labels.inputs, static_cast<std::size_t>(model.inputs()), "column of B");
  std::vector<std::string> known = model.state_names();
  known.insert(known.end(), labels.outputs.begin(), labels.outputs.end());
  known.insert(known.end(), labels.inputs.begin(), labels.inputs.end());
  for (const auto& [name, unit] : labels.units)
    if (std::find(known.begin(), known.end(), name) == known.end()) refuse_unknown("units", name, known);
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
template <class M>
bool same(const M& a, const M& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}
bool same(const std::vector<Matrix>& a, const std::vector<Matrix>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Matrix& x, const Matrix& y) { return same(x, y); });
}

}  // namespace

Model::Model(Matrix A, std::vector<Matrix> C, Noise noise, std::vector<int> exposed, Labels labels, Matrix B)
    : A_(std::move(A)),
      C_(std::move(C)),
      noise_(std::move(noise)),
      exposed_(std::move(exposed)),
      labels_(std::move(labels)),
      B_(std::move(B)) {
  const auto n = A_.rows();
  if (n < 1 || A_.cols() != n) refuse("A", shape(A_), "a square matrix with at least one row");
  require_finite("A", A_);
  if (B_.size() == 0) B_.resize(n, 0);
  if (B_.rows() != n)
    refuse("B", shape(B_), amount(n, "row") + ", because A is " + shape(A_), "one column per input");
  require_finite("B", B_);
  if (C_.empty()) refuse("C", "no agent", "one matrix of observation rows per agent");
  offsets_.assign(1, 0);
  for (std::size_t i = 0; i < C_.size(); ++i) {
    if (C_[i].rows() == 0) C_[i].resize(0, n);
    const std::string which = "C[" + std::to_string(i) + "]";
    if (C_[i].cols() != n) refuse(which, shape(C_[i]), amount(n, "column") + ", because A is " + shape(A_));
    require_finite(which, C_[i]);
    offsets_.push_back(offsets_.back() + static_cast<int>(C_[i].rows()));
  }
  if (!exposed_.empty() && exposed_.size() != C_.size())
    refuse("exposed", amount(exposed_.size(), "number"), "one per agent (" + std::to_string(agents()) + ")");
  for (std::size_t i = 0; i < exposed_.size(); ++i)
    if (exposed_[i] < 0 || exposed_[i] > C_[i].rows())
      refuse("exposed[" + std::to_string(i) + "]", std::to_string(exposed_[i]),
             "0.." + std::to_string(C_[i].rows()) + ", the rows of C[" + std::to_string(i) + "]");
  if (!std::isnan(noise_.process_bound)) require_bound("process_bound", noise_.process_bound);
  if (noise_.measurement_bound.size() != 0 && noise_.measurement_bound.size() != agents())
    refuse("measurement_bound", amount(noise_.measurement_bound.size(), "number"),
           "one per agent (" + std::to_string(agents()) + ")");
  for (Eigen::Index i = 0; i < noise_.measurement_bound.size(); ++i)
    require_bound("measurement_bound[" + std::to_string(i) + "]", noise_.measurement_bound(i));
  if (noise_.process_covariance.size() != 0)
    require_covariance("process_covariance", noise_.process_covariance, n);
  const auto& Sw = noise_.agent_process_covariance;
  if (!Sw.empty() && Sw.size() != C_.size())
    refuse("process_covariance", amount(Sw.size(), "matrix", "matrices"),
           "one for all, or one per agent (" + std::to_string(agents()) + ")");
  for (std::size_t i = 0; i < Sw.size(); ++i)
    require_covariance("process_covariance[" + std::to_string(i) + "]", Sw[i], n);
  const auto& Sv = noise_.measurement_covariance;
  if (!Sv.empty() && Sv.size() != C_.size())
    refuse("measurement_covariance", amount(Sv.size(), "matrix", "matrices"),
           "one per agent (" + std::to_string(agents()) + ")");
  for (std::size_t i = 0; i < Sv.size(); ++i)
    require_covariance("measurement_covariance[" + std::to_string(i) + "]", Sv[i], C_[i].rows());
  require_labels(labels_, *this);
}

std::vector<std::string> Model::state_names() const {
  if (!labels_.states.empty()) return labels_.states;
  std::vector<std::string> names;
  for (int i = 1; i <= states(); ++i) names.push_back("x" + std::to_string(i));
  return names;
}

namespace {

/// What an attacker can reach, of models that are known to have as many agents.
bool same_reach(const Model& a, const Model& b) {
  for (int i = 0; i < a.agents(); ++i)
    if (a.exposed(i) != b.exposed(i)) return false;
  return true;
}

}  // namespace

bool operator==(const Model& a, const Model& b) {
  const Noise& p = a.noise_;
  const Noise& q = b.noise_;
  return same(a.A_, b.A_) && same(a.B_, b.B_) && same(a.C_, b.C_) && same(p.process_bound, q.process_bound) &&
         same(p.measurement_bound, q.measurement_bound) && same(p.process_covariance, q.process_covariance) &&
         same(p.measurement_covariance, q.measurement_covariance) &&
         same(p.agent_process_covariance, q.agent_process_covariance) && same_reach(a, b) &&
         a.labels_ == b.labels_;
}

double Model::measurement_bound() const {
  return noise_.measurement_bound.size() == 0 ? kNaN : noise_.measurement_bound.maxCoeff();
}

Matrix Model::stacked() const {
  Matrix all(total_outputs(), states());
  for (int i = 0; i < agents(); ++i) all.middleRows(offset(i), outputs(i)) = C(i);
  return all;
}

}  // namespace garrison
