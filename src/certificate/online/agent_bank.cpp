// SPDX-License-Identifier: Apache-2.0
#include "agent_bank.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "garrison/certificate/online/evidence.hpp"
#include "rounding.hpp"

namespace garrison::certificate {
namespace {

/// Source of the whole network -> the entries that are its rows; a row of zeros says nothing.
std::map<int, std::vector<std::size_t>> entries_of(const Plan& plan, std::span<const std::size_t> rows) {
  std::map<int, std::vector<std::size_t>> entries;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!plan.rows.col(static_cast<Eigen::Index>(rows[k])).isZero(0.0))
      entries[plan.source[rows[k]]].push_back(k);
  return entries;
}

std::vector<BankSource> sources_of(const Plan& plan, std::span<const std::size_t> rows) {
  std::vector<BankSource> sources;
  for (const auto& [source, entries] : entries_of(plan, rows)) {
    const auto count = static_cast<Eigen::Index>(entries.size());
    BankSource& one = sources.emplace_back(BankSource{Matrix(count, plan.states()), Vector(count)});
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto row = static_cast<Eigen::Index>(rows[entries[static_cast<std::size_t>(k)]]);
      one.C.row(k) = plan.rows.col(row).transpose();
      one.R(k) = plan.variance(row);
    }
  }
  return sources;
}

}  // namespace

AgentBank::AgentBank(std::shared_ptr<const Plan> plan, std::span<const std::size_t> rows)
    : plan_(std::move(plan)),
      bank_(plan_->A, plan_->bank.Q, sources_of(*plan_, rows), plan_->wanted.attacked, kMostBankMembers),
      now_(sources_of(*plan_, rows)) {
  for (const auto& [source, entries] : entries_of(*plan_, rows)) {
    source_.push_back(source);
    order_.insert(order_.end(), entries.begin(), entries.end());
    for (const std::size_t entry : entries) row_.push_back(rows[entry]);
  }
  y_.resize(bank_.outputs());
  nothing_ = Vector::Constant(bank_.outputs(), kNaN);
  center_ = box_ = Vector::Zero(bank_.states());
  proved_.resize(source_.size());
  bank_.start_unknown();
}

void AgentBank::reset(std::int64_t t) noexcept {
  restart(t, true);
  doubts_ = {};
}

/// From now on alone; everything: nothing was doubted before, either.
void AgentBank::restart(std::int64_t t, bool everything) noexcept {
  bank_.forget(everything);
  t_ = t;
  tests_ = 0;
  proofs_ = 0;
  radius_ = kInfinity;
  center_.setZero();
  box_.setZero();
}

/// Each epoch of twice as many samples has its share of the failure probability, so that a bank may run for
/// ever. What derived measurements are off by goes through the gains that their noise goes through: in
/// deviations it moves nothing by more than its own length.
WindowLevels AgentBank::levels() const noexcept {
  const BankPlan& b = plan_->bank;
  const auto epoch = static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(tests_) + 1)) - 1;
  const double derived = plan_->derivation(static_cast<double>(tests_) + 1.0);
  return {b.z1[std::min(epoch, b.z1.size() - 1)] + derived, b.z2 + derived, b.zc + derived, kNaN};
}

void AgentBank::vary(const Change& change) noexcept {
  change_ = change;
  varied_ = change.rows != nullptr || change.variance != nullptr;
  if (!varied_) return;
  const Matrix& C = change.rows != nullptr ? *change.rows : plan_->rows;
  const Vector& R = change.variance != nullptr ? *change.variance : plan_->variance;
  std::size_t at = 0;
  for (BankSource& source : now_)
    for (Eigen::Index k = 0; k < source.C.rows(); ++k, ++at) {
      const auto row = static_cast<Eigen::Index>(row_[at]);
      source.C.row(k) = C.col(row).transpose();
      source.R(k) = R(row);
    }
}

void AgentBank::take(std::int64_t t, std::span<const double> y) noexcept {
  if (t - t_ > kMostAge) restart(t - 1, false);
  BankStep step;
  step.ellipsoid = false;
  for (; t_ + 1 < t; ++t_) bank_.update(nothing_, levels(), step);
  if (bank_.overflows()) restart(t - 1, false);
  step.A = change_.A;
  step.Q = change_.Q;
  for (std::size_t k = 0; k < order_.size(); ++k) y_(static_cast<Eigen::Index>(k)) = y[order_[k]];
  if (varied_) {
    step.sources = &now_;
    Eigen::Index at = 0;
    for (const BankSource& source : now_)
      for (Eigen::Index k = 0; k < source.C.rows(); ++k, ++at)
        if (source.C.row(k).isZero(0.0)) y_(at) = kNaN;  // it says nothing
  }
  learn(bank_.update(y_, levels(), step));
  t_ = t;
  ++tests_;
  if (std::isnan(radius_)) {
    if (doubts_.refuted++ == 0) doubts_.refuted_at = t;
    refute();
  } else if (bank_.overflows()) {
    restart(t, false);
  }
}

/// Says no more of this sample than that; later ones count alone.
void AgentBank::refute() noexcept {
  restart(t_, false);
  radius_ = kNaN;
}

void AgentBank::compare(std::span<const double> center, std::span<const double> box) noexcept {
  if (!std::isfinite(radius_)) return;
  for (std::size_t k = 0; k < center.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double rounding = kAgeingRounding * (std::abs(center[k]) + std::abs(center_(i)));
    if (!(std::abs(center[k] - center_(i)) > kSums * (box[k] + box_(i)) + rounding)) continue;
    if (doubts_.apart++ == 0) {
      doubts_.apart_at = t_;
      doubts_.apart_in = static_cast<int>(k);
    }
    return refute();
  }
}

Doubts AgentBank::doubts() const noexcept {
  Doubts found = doubts_;
  found.dependence = bank_.dependence();
  int& source = found.dependence.source;
  if (source >= 0) source = source_[static_cast<std::size_t>(source)];
  return found;
}

void AgentBank::learn(const WindowWitness& found) noexcept {
  radius_ = found.region.radius;
  proofs_ = 0;
  for (const Proof& proof : found.proofs)
    proved_[static_cast<std::size_t>(proofs_++)] = source_[static_cast<std::size_t>(proof.source)];
  if (!found.region.answered()) return;
  center_ = found.region.center;
  box_ = found.region.box;
}

Bound AgentBank::bound(std::span<const double> estimate) const noexcept {
  if (std::isnan(radius_)) return {kNaN, CertificateKind::refuted};
  if (!std::isfinite(radius_)) return {kInfinity, CertificateKind::too_few};
  double ball = 0.0;
  double box = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double d = std::abs(estimate[k] - center_(i));
    ball += d * d;
    box += (d + box_(i)) * (d + box_(i));
    size += std::abs(center_(i));
  }
  return {kSums * std::fmin(std::sqrt(ball) + radius_, std::sqrt(box)) + kAgeingRounding * size,
          CertificateKind::memory};
}

void AgentBank::box(std::span<const double> estimate, std::span<double> out) const noexcept {
  if (!std::isfinite(radius_)) return;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double half =
        kSums * (std::abs(estimate[k] - center_(i)) + box_(i)) + kAgeingRounding * std::abs(center_(i));
    out[k] = half < out[k] ? half : out[k];
  }
}

void AgentBank::visit(wire::Archive& archive) {
  archive("bank", bank_);
  archive("t", t_);
  archive.range("tests", tests_, 0, INT64_MAX / 4);
  archive("radius", radius_);
  archive("center", center_);
  archive("box", box_);
  archive.range("proofs", proofs_, 0, static_cast<std::int64_t>(proved_.size()));
  archive("proved", proved_);
  archive("doubts", doubts_);
}

bool AgentBank::resume() noexcept {
  if (!bank_.resume() || radius_ < 0.0 || !center_.allFinite() || !box_.allFinite()) return false;
  const auto known = [&](int source) { return std::binary_search(source_.begin(), source_.end(), source); };
  return std::all_of(proved_.begin(), proved_.begin() + proofs_, known);
}

std::unique_ptr<AgentBank> make_agent_bank(const std::shared_ptr<const Plan>& plan,
                                           std::span<const std::size_t> rows) {
  if (!plan->wanted.memory) return nullptr;
  const auto sources = static_cast<int>(entries_of(*plan, rows).size());
  return sources > plan->wanted.attacked ? std::make_unique<AgentBank>(plan, rows) : nullptr;
}

}  // namespace garrison::certificate
