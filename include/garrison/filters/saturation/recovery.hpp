// SPDX-License-Identifier: Apache-2.0
// How agents go on bounding their errors after lost messages (theorem L, docs/certificates.md): what design
// leaves, what an agent keeps, and what its messages say of it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "garrison/certificate/recovery.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

/// What is rare, beside what runs at every step.
#define GARRISON_COLD __attribute__((noinline, cold))

namespace garrison::saturation {

/// Windows of kernels are no longer than this.
inline constexpr int kMostWindow = 512;

/// "Whole" below: behind an estimate that no lost message lies behind.
struct LossTables {
  certificate::Recovery excess;  ///< empty = not asked for
  Vector predicted;              ///< row t: largest error of a whole estimate between `sense` and the rounds
  Vector spread;                 ///< so many times larger after k rounds at most, k = 0..rounds
  Vector reach;                  ///< |C_j A| of each agent
  Vector width;                  ///< what noise adds at most to the innovation of each agent
  double growth = kNaN;          ///< ||A||
  double noise = kNaN;           ///< largest ||w||

  bool empty() const { return excess.empty(); }
  /// ||error|| of a whole estimate of sample t before round `round`; `row`: of t.
  double whole(Eigen::Index row, int round) const noexcept { return spread(round) * predicted(row); }
  /// What one agent needs of it.
  LossTables of(Eigen::Index agent) const {
    if (empty()) return {};
    return {excess.of(agent),        predicted, spread, reach.segment(agent, 1),
            width.segment(agent, 1), growth,    noise};
  }
  /// Of a design file: nothing leads out of its tables.
  bool fits(Eigen::Index rows, Eigen::Index columns, int rounds) const noexcept {
    return empty() || (excess.fits(columns) && excess.window() <= kMostWindow && predicted.size() == rows &&
                       spread.size() == rounds + 1 && reach.size() == columns && width.size() == columns);
  }

  template <class V>
  void visit(V& v) {
    v("excess", excess);
    v("predicted", predicted);
    v("spread", spread);
    v("reach", reach);
    v("width", width);
    v("growth", growth);
    v("noise", noise);
  }
};

/// What an agent keeps. None of it counts as long as its estimate is whole.
struct LossRecord {
  certificate::LossState state;  ///< of the last sample
  double bound = kInfinity;      ///< relayed: on the error of the estimate as it is now
  double before = kInfinity;     ///< the same one round ago
  double clip = kInfinity;       ///< level in force at this sample, where the threshold is not adaptive
  bool lost = false;             ///< a message of this sample is missing behind the estimate
  std::vector<double> old;       ///< room for the estimate before a round

  template <class V>
  void visit(V& v) {
    v.range("lam", state.lam, 0, INT64_MAX / 4);
    v("x", state.x);
    v("bound", bound);
    v("clip", clip);
    v("lost", lost);
  }
  /// Of a snapshot of sample t: nothing leads out of the tables.
  bool sound(std::int64_t t) const noexcept {
    const bool counts = state.x > 0.0 && state.x < kInfinity;
    return state.x >= 0.0 && bound >= 0.0 && clip >= 0.0 && state.lam <= t &&
           (!counts || t - state.lam <= kMostWindow);
  }
  /// Nothing is known of the estimate of sample t.
  void forget(std::int64_t t) noexcept {
    state = {t, kInfinity};
    bound = kInfinity;
    lost = false;
  }
};

/// What a message says of it: nothing, where the estimate is whole. A single pointer, null where nobody asks
/// for recovery: messages are copied all the time.
/// Threads: several may read; whoever changes it is alone, as with standard containers.
class LossNote {
 public:
  LossNote() = default;
  LossNote(const LossNote& other) { *this = other; }
  LossNote(LossNote&&) noexcept = default;
  LossNote& operator=(LossNote&&) noexcept = default;
  LossNote& operator=(const LossNote& other) {
    if (other.data_ == nullptr)
      data_ = nullptr;
    else if (data_ == nullptr)
      data_ = std::make_unique<Numbers>(*other.data_);
    else
      *data_ = *other.data_;
    return *this;
  }
  ~LossNote() = default;

  /// Room for a note, which the copies of a message have, too.
  void keep() { data_ = std::make_unique<Numbers>(kNothing); }
  bool kept() const { return data_ != nullptr; }
  bool whole() const { return std::isnan((*data_)[kAge]); }
  void say_whole() { *data_ = kNothing; }
  /// `r` in a message of sample t, which tells of the sample before it.
  void say(const LossRecord& r, std::int64_t t) noexcept {
    (*data_)[kAge] = static_cast<double>(t - 1 - r.state.lam);
    (*data_)[kExcess] = sayable(r.state.x);
    (*data_)[kBound] = sayable(r.bound);
    (*data_)[kLost] = r.lost ? 1.0 : kNaN;
  }

  /// What another agent said in sample t; what none could say counts as nothing known.
  certificate::LossState state(std::int64_t t) const noexcept {
    const double age = (*data_)[kAge];
    const bool usable = age >= 0.0 && age <= kMostWindow && age < static_cast<double>(t) &&
                        age == std::floor(age) && (*data_)[kExcess] >= 0.0;
    if (!usable) return {t - 1, kInfinity};
    return {t - 1 - static_cast<std::int64_t>(age), (*data_)[kExcess]};
  }
  double bound() const noexcept { return (*data_)[kBound] >= 0.0 ? (*data_)[kBound] : kInfinity; }
  bool lost() const noexcept { return !std::isnan((*data_)[kLost]); }

  template <class V>
  void visit(V& v) {
    v.sparse("recovery", *data_);
  }

 private:
  enum Place { kAge, kExcess, kBound, kLost, kPlaces };
  using Numbers = std::array<double, kPlaces>;
  static constexpr Numbers kNothing{kNaN, kNaN, kNaN, kNaN};
  static double sayable(double v) noexcept { return v < kHuge ? v : kNaN; }

  std::unique_ptr<Numbers> data_;
};

/// Levels of a sample, from what is known of the one before it: no honest innovation is above `honest`, and
/// what is clipped at `clip` is clipped no more than where nothing is lost.
struct Levels {
  double honest;
  double clip;
};
/// bound: on the error at t-1, with `state`; nominal: H(t) of the table; beta: fixed threshold, infinity =
/// adaptive.
inline Levels levels(const LossTables& tables, Eigen::Index column, certificate::LossState state,
                     double bound, std::int64_t t, double nominal, double beta) noexcept {
  const double excess = tables.excess.level_excess(column, state, t - 1);
  const double honest = std::min(nominal + excess, tables.reach(column) * bound + tables.width(column));
  if (!(honest < kInfinity)) return {kInfinity, beta};
  return {honest, std::min(beta + excess, std::max(beta, honest))};
}

}  // namespace garrison::saturation
