// SPDX-License-Identifier: Apache-2.0
#include "agent_certifier.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "garrison/certificate/interval.hpp"
#include "garrison/wire/archive.hpp"
#include "rounding.hpp"

namespace garrison::certificate {
namespace {

/// Agents whose measurements may reach this one, ascending.
std::vector<int> within_reach(const Plan& plan, int id, std::span<const int> neighbours) {
  if (plan.wanted.spread == Spread::flooded) return plan.ids;
  std::vector<int> all(neighbours.begin(), neighbours.end());
  all.push_back(id);
  std::sort(all.begin(), all.end());
  return all;
}

struct Sizes {
  int rows = 0;
  int sources = 0;
};
Sizes sizes(const Plan& plan, const std::vector<int>& agents) {
  std::vector<int> sources;
  for (const int agent : agents) {
    const auto place = static_cast<std::size_t>(plan.place(agent));
    for (int r = plan.first[place]; r < plan.first[place + 1]; ++r)
      sources.push_back(plan.source[static_cast<std::size_t>(r)]);
  }
  Sizes found{static_cast<int>(sources.size()), 0};
  std::sort(sources.begin(), sources.end());
  found.sources = static_cast<int>(std::unique(sources.begin(), sources.end()) - sources.begin());
  return found;
}

/// C(of, take), or `most` where it is more.
int sets(int of, int take, int most) {
  double count = 1.0;
  for (int k = 1; k <= take; ++k) count *= static_cast<double>(of - take + k) / k;
  return count >= most ? most : static_cast<int>(std::max(1.0, std::round(count)));
}

}  // namespace

AgentCertifier::AgentCertifier(std::shared_ptr<const Plan> plan, int id, std::span<const int> neighbours,
                               int rounds)
    : plan_(std::move(plan)),
      id_(id),
      rounds_(rounds),
      flooded_(plan_->wanted.spread == Spread::flooded),
      direct_(plan_->wanted.spread == Spread::direct),
      agents_(within_reach(*plan_, id, neighbours)),
      rows_(plan_->states(), std::max(1, sizes(*plan_, agents_).sources),
            std::max(1, sizes(*plan_, agents_).rows)),
      leverage_(rows_.states(), rows_.sources(), rows_.capacity()),
      subsets_(rows_.states(), rows_.sources(), rows_.capacity(),
               sets(rows_.sources(), std::min(plan_->wanted.attacked, rows_.sources()),
                    std::max(1, plan_->wanted.subsets))),
      moved_(plan_->states()) {
  std::map<int, int> number;
  for (const int agent : agents_) {
    const auto place = static_cast<std::size_t>(plan_->place(agent));
    at_.push_back(row_.size());
    for (int r = plan_->first[place]; r < plan_->first[place + 1]; ++r) {
      row_.push_back(static_cast<std::size_t>(r));
      number.emplace(plan_->source[static_cast<std::size_t>(r)], 0);
    }
  }
  at_.push_back(row_.size());
  int next = 0;
  for (auto& [source, here] : number) here = next++;
  for (const std::size_t r : row_) source_.push_back(number.at(plan_->source[r]));
  one_row_each_ = number.size() == row_.size();
  y_.resize(row_.size());
  own_.resize(row_.size());
  since_.resize(row_.size());
  present_.resize(row_.size());
  used_.resize(row_.size());
  ends_.resize(2 * row_.size());
  y1_.resize(row_.size());
  width1_.resize(row_.size());
  const auto n = static_cast<std::size_t>(plan_->states());
  memory_.center.resize(n);
  memory_.box.resize(n);
  memory_.ball.resize(n);
  bank_ = make_agent_bank(plan_, row_);
  AgentCertifier::reset(0);
}

void AgentCertifier::reset(std::int64_t t) noexcept {
  std::fill(y_.begin(), y_.end(), kNaN);
  known_ = 0;
  judged_ = true;
  memory_.t = t;
  memory_.radius = kInfinity;
  memory_.age = -1;
  memory_.fresh = 0;
  for (auto* part : {&memory_.center, &memory_.box, &memory_.ball})
    std::fill(part->begin(), part->end(), 0.0);
  memory_.ball_radius = 0.0;
  if (bank_) bank_->reset(t);
}

/// The relayed region becomes one of sample t, of which nothing is known yet.
void AgentCertifier::move_to(std::int64_t t) noexcept {
  const std::int64_t passed = t - memory_.t;
  memory_.t = t;
  memory_.radius = kInfinity;
  if (now_.A != nullptr || (now_.Q != nullptr && !plan_->deterministic())) memory_.age = -1;
  if (memory_.age >= 0) {
    Eigen::Map<Vector> center(memory_.ball.data(), moved_.size());
    const int oldest = plan_->deterministic() ? memory_.age : memory_.fresh + kChoice;  // that it may be
    if (passed > plan_->ages() - oldest) {
      memory_.age = -1;
    } else {
      memory_.age += static_cast<int>(passed);
      memory_.fresh += static_cast<int>(passed);
      for (std::int64_t k = 0; k < passed; ++k) {
        moved_.noalias() = plan_->A * center;
        center = moved_;
      }
    }
    if (!(center.cwiseAbs().maxCoeff() < kHuge)) memory_.age = -1;
  }
  std::fill(y_.begin(), y_.end(), kNaN);
  known_ = 0;
  judged_ = false;
  region_since_ = next_round_ = 0;
  if (bank_) bank_->wait();
}

void AgentCertifier::vary(const Change& change) noexcept {
  now_ = change;
  gathered_ = false;
  if (bank_) bank_->vary(change);
}

std::size_t AgentCertifier::place(int agent) const {
  return static_cast<std::size_t>(std::lower_bound(agents_.begin(), agents_.end(), agent) - agents_.begin());
}

void AgentCertifier::begin(std::int64_t t, const double* y, const double* x) noexcept {
  if (x == nullptr) return begin(t, y, Told::never_derived);
  const Told told = plan_->tell(id_, y, x, own_.data());
  begin(t, own_.data(), told);
}

void AgentCertifier::begin(std::int64_t t, const double* y, Told told) noexcept {
  move_to(t);
  told_ = told;
  hear_numbers(id_, y);
  if (rounds_ == 0) end_sample();
}

void AgentCertifier::hear_numbers(int sender, const double* y) noexcept {
  const std::size_t at = place(sender);
  for (std::size_t k = at_[at]; k < at_[at + 1]; ++k) learn(k, *y++);
}

void AgentCertifier::hear_estimate(int sender, const double* x) noexcept {
  if (!plan_->derives(sender)) return;
  const std::size_t at = place(sender);
  for (std::size_t k = at_[at]; k < at_[at + 1]; ++k) learn(k, plan_->derived(row_[k], x));
}

void AgentCertifier::begin_knowing(std::int64_t t, const double* all, const AgentCertifier* same) noexcept {
  if (same == nullptr) {
    move_to(t);
  } else {
    copy_relayed(*same);
    memory_.t = t;
    memory_.radius = kInfinity;
    judged_ = false;
    if (bank_) bank_->wait();
  }
  known_ = 0;
  for (std::size_t k = 0; k < y_.size(); ++k) {
    const double y = all[row_[k]];
    const bool usable = std::abs(y) < kHuge;
    y_[k] = usable ? y : kNaN;
    known_ += usable ? 1 : 0;
  }
}

void AgentCertifier::learn(std::size_t at, double y) noexcept {
  if (!std::isnan(y_[at]) || !(std::abs(y) < kHuge)) return;
  y_[at] = y;
  since_[at] = next_round_;
  ++known_;
}

void AgentCertifier::say(int round, Evidence& out) const noexcept {
  const bool has = !direct_ && memory_.age >= 0 &&
                   (flooded_ ? round < region_since_ + kRepeats : plan_->relays_in(round, rounds_));
  if (flooded_) {
    for (std::size_t k = 0; k < y_.size(); ++k)
      out.measurements[k] = round < since_[k] + kRepeats ? y_[k] : kNaN;
  } else {
    const std::size_t me = at_[place(id_)];
    const bool says = round == 0 && (told_ != Told::derived || has);
    for (std::size_t k = 0; k < out.measurements.size(); ++k) out.measurements[k] = says ? y_[me + k] : kNaN;
  }
  if (direct_) return;
  out.age = has ? memory_.age : 0;
  out.fresh = has ? memory_.fresh : 0;
  std::copy(memory_.ball.begin(), memory_.ball.end(), out.ball.begin());
  out.ball.back() = memory_.ball_radius;
  if (!has) std::fill(out.ball.begin(), out.ball.end(), kNaN);
}

bool AgentCertifier::spares(int round, const Evidence& said) const noexcept {
  return said.silent() && !(round == 0 && told_ == Told::as_numbers);
}

void AgentCertifier::hear(int round, int sender, const Evidence& in) noexcept {
  next_round_ = round + 1;
  if (flooded_) {
    for (std::size_t k = 0; k < y_.size() && known_ < static_cast<int>(y_.size()); ++k)
      learn(k, in.measurements[k]);
  } else if (round == 0) {
    hear_numbers(sender, in.measurements.data());
  }
  if (direct_ || !(in.ball.back() >= 0.0)) return;
  bool whole = in.age <= std::max(plan_->ages(), 0) && in.fresh <= in.age && eligible(in.age, in.fresh);
  for (const double v : in.ball) whole = whole && !std::isnan(v);
  if (whole) offer(in.ball.data(), in.ball.back(), in.age, in.fresh);
}

void AgentCertifier::end_round(int round) noexcept {
  if (!judged_ && judges_in(round)) witness();
}
void AgentCertifier::end_sample() noexcept {
  if (!judged_) witness();
}

/// Writes what is known into rows_, anew only where other measurements are missing than the last time, or
/// rows are others.
void AgentCertifier::gather() noexcept {
  bool same = gathered_;
  gathered_ = true;
  for (std::size_t k = 0; k < y_.size(); ++k) {
    const char present = std::isnan(y_[k]) ? 0 : 1;
    same = same && present == present_[k];
    present_[k] = present;
  }
  int j = 0;
  if (same) {
    for (std::size_t k = 0; k < y_.size(); ++k)
      if (used_[k] != 0) rows_.measure(j++, y_[k]);
    return;
  }
  rows_.clear();
  const std::size_t n = memory_.center.size();
  const Matrix& rows = now_.rows != nullptr ? *now_.rows : plan_->rows;
  const Vector& variance = now_.variance != nullptr ? *now_.variance : plan_->variance;
  for (std::size_t k = 0; k < y_.size(); ++k) {
    const auto r = static_cast<Eigen::Index>(row_[k]);
    used_[k] = static_cast<char>(present_[k] != 0 &&
                                 rows_.add(source_[k], {rows.data() + row_[k] * n, n}, y_[k], variance(r),
                                           plan_->deterministic() ? plan_->width(r) : 0.0));
  }
}

void AgentCertifier::remember() noexcept {
  if (bank_) bank_->take(memory_.t, y_);
}

/// What this sample says alone, against what all say together.
void AgentCertifier::compare() noexcept {
  if (bank_ && std::isfinite(memory_.radius)) bank_->compare(memory_.center, memory_.box);
}

std::span<const int> AgentCertifier::proved() const noexcept {
  return bank_ ? bank_->proved() : std::span<const int>();
}

void AgentCertifier::witness() noexcept {
  judged_ = true;
  remember();
  gather();
  if (rows_.size() == 0) return;
  const std::size_t n = memory_.center.size();
  Assumption a;
  a.s = plan_->wanted.attacked;
  a.bounded = plan_->deterministic();
  const double derived = plan_->derivation(1.0);
  a.levels = {plan_->z1 + derived,
              (rows_.size() == plan_->all_rows ? plan_->z2_full : plan_->z2_partial) + derived};
  const bool few =
      !a.bounded && plan_->wanted.subsets > 0 && subsets_to_try(rows_, a) <= plan_->wanted.subsets;
  keep((few ? witness_subsets(rows_, a, kNaN, subsets_) : leverage_ball(rows_, a, leverage_)).region);
  if (a.bounded && n == 1 && one_row_each_ && !std::isnan(memory_.radius)) interval_rule();
  compare();
  relay_own();
}

/// W0, one state: where it is sharper than what is kept.
void AgentCertifier::interval_rule() noexcept {
  const auto m = static_cast<std::size_t>(rows_.size());
  for (std::size_t j = 0; j < m; ++j) {
    const double c = rows_.c(static_cast<int>(j))(0);
    y1_[j] = rows_.y(static_cast<int>(j)) / c;
    width1_[j] = rows_.width(static_cast<int>(j)) / std::abs(c);
    if (!(std::abs(y1_[j]) < kHuge) || !(width1_[j] < kHuge)) return;
  }
  const Interval found = interval(std::span(y1_).first(m), std::span(width1_).first(m),
                                  plan_->wanted.attacked, std::span(ends_).first(2 * m));
  if (std::isnan(found.lo)) {
    memory_.radius = kNaN;
    return;
  }
  const double middle = 0.5 * (found.hi + found.lo);
  // The middle is rounded: the radius covers it.
  const double half = std::max(found.hi - middle, middle - found.lo) * (1.0 + 1e-15);
  if (!(half < memory_.radius)) return;
  memory_.center[0] = middle;
  memory_.radius = memory_.box[0] = half;
}

void AgentCertifier::keep(const Region& region) noexcept {
  memory_.radius = region.radius;
  if (!region.answered()) return;
  std::copy_n(region.center.data(), memory_.center.size(), memory_.center.begin());
  std::copy_n(region.box.data(), memory_.box.size(), memory_.box.begin());
}

Bound AgentCertifier::bound(std::span<const double> estimate) const noexcept {
  const Memory& m = memory_;
  if (std::isnan(m.radius)) return {kNaN, CertificateKind::refuted};
  Bound least{kInfinity, CertificateKind::too_few};
  double ball = 0.0;
  double box = 0.0;
  double relayed = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const double d = estimate[k] - m.center[k];
    ball += d * d;
    box += (std::abs(d) + m.box[k]) * (std::abs(d) + m.box[k]);
    const double e = estimate[k] - m.ball[k];
    relayed += e * e;
    size += std::abs(m.ball[k]);
  }
  if (std::isfinite(m.radius))
    least = {kSums * std::fmin(std::sqrt(ball) + m.radius, std::sqrt(box)), CertificateKind::witness};
  if (bank_) {
    const Bound remembered = bank_->bound(estimate);
    if (remembered.value < least.value ||
        (remembered.kind == CertificateKind::refuted && m.age < 0 && !std::isfinite(least.value)))
      least = remembered;
  }
  if (m.age < 0) return least;
  // Steps of the plant are rounded, those of the centre and those that were measured.
  const double rounding = m.age == 0 ? 0.0 : kAgeingRounding * size;
  const double other = kSums * (std::sqrt(relayed) + aged(m.ball_radius, m.age) + rounding);
  return other < least.value ? Bound{other, CertificateKind::relayed} : least;
}

void AgentCertifier::box(std::span<const double> estimate, std::span<double> out) const noexcept {
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = std::isfinite(memory_.radius)
                 ? kSums * (std::abs(estimate[k] - memory_.center[k]) + memory_.box[k])
                 : kInfinity;
  if (bank_) bank_->box(estimate, out);
}

void AgentCertifier::shape_evidence(int sender, Evidence& out) const {
  out.ball.resize(direct_ ? 0 : memory_.ball.size() + 1, kNaN);
  out.measurements.resize(flooded_ ? y_.size() : static_cast<std::size_t>(plan_->outputs(sender)), kNaN);
}

void AgentCertifier::visit(wire::Archive& archive) {
  archive("memory", memory_);
  if (bank_) archive("bank", *bank_);
}

bool AgentCertifier::resume(std::int64_t t) noexcept {
  return usable() && memory_.t == t && (!bank_ || (bank_->resume() && bank_->sample() == t));
}

bool AgentCertifier::usable() const noexcept {
  const auto finite = [](const std::vector<double>& all) {
    return std::all_of(all.begin(), all.end(), [](double v) { return std::isfinite(v); });
  };
  return finite(memory_.center) && finite(memory_.box) && finite(memory_.ball) && !(memory_.radius < 0.0) &&
         memory_.ball_radius >= 0.0 && std::isfinite(memory_.ball_radius) &&
         memory_.age <= std::max(0, plan_->ages()) &&
         (memory_.age < 0 || (memory_.fresh <= memory_.age && eligible(memory_.age, memory_.fresh)));
}

bool AgentCertifier::knows_the_same(const AgentCertifier& other) const {
  return known_ == other.known_ && row_ == other.row_ &&
         std::memcmp(y_.data(), other.y_.data(), y_.size() * sizeof(double)) == 0;
}

void AgentCertifier::adopt(const AgentCertifier& other) noexcept {
  judged_ = true;
  remember();
  memory_.radius = other.memory_.radius;
  memory_.center = other.memory_.center;
  memory_.box = other.memory_.box;
  compare();
  relay_own();
}

std::unique_ptr<Certifier> make_certifier(std::shared_ptr<const Plan> plan, int id,
                                          std::span<const int> neighbours, int rounds) {
  return std::make_unique<AgentCertifier>(std::move(plan), id, neighbours, rounds);
}

}  // namespace garrison::certificate
