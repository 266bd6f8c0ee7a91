// SPDX-License-Identifier: Apache-2.0
// Two samples in a row fit together when along every direction d the range of d'x(t+1) reaches that of
// d'A x(t), widened by ||d|| process_bound. Where they do not, one of the measurements behind the two ranges
// is a lie: each in turn is left out, until as many sources are as can lie.
#include "garrison/drivers/contradiction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "garrison/core/budget.hpp"
#include "row_bases.hpp"

namespace garrison {
namespace {

using detail::Range;
using detail::Readings;
using detail::RowBases;
using detail::Sources;
using detail::Weighted;

constexpr int kMostRows = 60;
constexpr int kMostStates = 30;
constexpr int kMostGroups = 400;
constexpr int kFewestGroups = 50;
constexpr int kMostDirections = 12;
constexpr Eigen::Index kMostSamples = 2000;
/// Multiplications, of a pass over the record without a liar, and of the whole search.
constexpr double kPass = 5e6;
constexpr double kMostWork = 3e8;
/// The trials after the first one share the samples and the work of this many records, but each has some.
constexpr int kShared = 4;
constexpr Eigen::Index kFewestSamples = 20;

/// Rows of the model that are not zero, at most kMostRows, evenly.
struct Chosen {
  detail::MeasuredRows measured;
  std::vector<Eigen::Index> column;
};

std::vector<int> owners(const Model& model, const ContradictionOptions& options) {
  if (!options.owner.empty()) return options.owner;
  std::vector<int> found;
  for (int i = 0; i < model.agents(); ++i)
    found.insert(found.end(), static_cast<std::size_t>(model.outputs(i)), i);
  return found;
}

Chosen choose(const Model& model, const ContradictionOptions& options) {
  const Matrix C = model.stacked();
  const std::vector<int> owner = owners(model, options);
  std::vector<Eigen::Index> sensing;
  Vector bound(C.rows());
  std::vector<char> exposed;
  for (int i = 0; i < model.agents(); ++i)
    for (int r = 0; r < model.outputs(i); ++r) {
      const Eigen::Index row = model.offset(i) + r;
      bound(row) = model.noise().measurement_bound(i);
      exposed.push_back(static_cast<char>(r < model.exposed(i)));
      if (!C.row(row).isZero(0.0)) sensing.push_back(row);
    }
  Chosen out;
  const std::size_t step = (sensing.size() + kMostRows - 1) / kMostRows;
  for (std::size_t k = 0; k < sensing.size(); k += step) out.column.push_back(sensing[k]);
  out.measured.rows = C(out.column, Eigen::all).transpose();
  out.measured.bound = bound(out.column);
  std::map<int, Sources> bit;
  for (const Eigen::Index row : out.column) {
    const auto at = static_cast<std::size_t>(row);
    const auto found = bit.emplace(owner[at], Sources{1} << bit.size()).first;
    out.measured.source.push_back(exposed[at] != 0 ? found->second : 0);
  }
  return out;
}

/// Directions of the rows, each once.
std::vector<Vector> directions_of(const Matrix& rows) {
  std::vector<Vector> all;
  for (Eigen::Index k = 0; k < rows.cols() && all.size() < kMostDirections; ++k) {
    const Vector d = rows.col(k).normalized();
    if (std::none_of(all.begin(), all.end(),
                     [&](const Vector& v) { return std::abs(v.dot(d)) > 1.0 - 1e-12; }))
      all.push_back(d);
  }
  return all;
}

/// One direction, at the first of two samples and at the second.
struct Direction {
  Vector d;
  Weighted before;  ///< A'd
  Weighted now;     ///< d, at the first
  Weighted after;   ///< d, at the second
};

/// Who is left out, at the first sample and at the second.
struct LeftOut {
  Sources before = 0;
  Sources after = 0;
};

/// In how many contradictions each source is.
struct Votes {
  std::array<std::array<int, 64>, 2> at{};  ///< at the first sample and at the second
  void count(Sources before, Sources after) {
    for (; before != 0; before &= before - 1) ++at[0][static_cast<std::size_t>(std::countr_zero(before))];
    for (; after != 0; after &= after - 1) ++at[1][static_cast<std::size_t>(std::countr_zero(after))];
  }
  int of(Sources source, bool later) const {
    return at[later ? 1 : 0][static_cast<std::size_t>(std::countr_zero(source))];
  }
};

class Search {
 public:
  Search(const Model& model, const ContradictionOptions& options, const Chosen& chosen, int groups)
      : model_(model),
        options_(options),
        column_(chosen.column),
        rows_(chosen.measured),
        bases_(chosen.measured, groups),
        reach_(model.A().norm()) {
    for (const Vector& d : directions_of(rows_.rows)) turn(directions_.emplace_back(), d);
  }

  bool possible() const { return !bases_.empty(); }
  /// The measurements of a trial, of which about `samples` are looked at.
  void record(const MatrixRef& measurements, Eigen::Index samples, double work) {
    y_ = measurements(Eigen::all, column_).transpose();
    stride_ = 1 + y_.cols() / samples;
    row_ = -1;
    work_ = 0.0;
    most_work_ = work;
  }
  Contradiction found() {
    // What contradicts itself within a sample does so over a step, too: mostly one pass is enough.
    Contradiction over{};
    const bool steps = options_.constant && model_.noise().process_bound < kInfinity && y_.cols() > 1;
    if (steps && (over = over_steps()).refuted == Refuted::nothing) return over;
    const Contradiction within = within_samples();
    return within.refuted != Refuted::nothing ? within : over;
  }

 private:
  Contradiction within_samples() {
    steps_ = false;
    return options_.for_good ? for_good(Refuted::measurement_bound) : each(Refuted::measurement_bound);
  }
  Contradiction over_steps() {
    steps_ = true;
    return options_.for_good ? for_good(Refuted::process_bound) : each(Refuted::process_bound);
  }

  void turn(Direction& one, const Vector& d) const {
    one.d = d;
    bases_.along(model_.A().transpose() * d, one.before);
    bases_.along(d, one.after);
    one.now = one.after;
    one.before.length = std::max(one.before.length, reach_ * one.after.length);
  }

  /// Reads the sample of a row, and the next one where there is one.
  void enter(Eigen::Index row) {
    if (row == row_) return;
    if (row == row_ + 1 && row_ >= 0)
      std::swap(now_, next_);
    else
      bases_.read(y_.col(row).data(), now_);
    row_ = row;
    if (row + 1 < y_.cols()) bases_.read(y_.col(row + 1).data(), next_);
    known_ = Vector::Zero(model_.states());
    if (options_.inputs.rows() > row) known_.noalias() = model_.B() * options_.inputs.row(row).transpose();
  }

  /// Sources behind a contradiction, one of which lies; fewest first. All contradictions are counted in
  /// `votes_`.
  std::optional<LeftOut> broken(const LeftOut& out) {
    work_ += static_cast<double>(3 * directions_.size() + 4) * static_cast<double>(bases_.groups()) *
             static_cast<double>(model_.states() + 3);
    std::optional<LeftOut> found;
    votes_ = {};
    const auto offer = [&](Sources before, Sources after) {
      votes_.count(before, after);
      if (!found || std::popcount(before) + std::popcount(after) <
                        std::popcount(found->before) + std::popcount(found->after))
        found = LeftOut{before, after};
    };
    for (Direction& one : directions_) compare(one, out, offer);
    if (found || !steps_) return found;
    if (const Vector w = suggested(out); w.norm() > model_.noise().process_bound && w.allFinite()) {
      turn(suggested_, w.normalized());
      compare(suggested_, out, offer);
    }
    return found;
  }

  template <class Offer>
  void compare(Direction& one, const LeftOut& out, const Offer& offer) const {
    one.now.leave_out(out.before);
    const Range now = RowBases::range(one.now, now_);
    if (now.lo > now.hi)
      offer(RowBases::behind(one.now, now_, true) | RowBases::behind(one.now, now_, false), 0);
    if (!steps_) return;
    one.before.leave_out(out.before);
    one.after.leave_out(out.after);
    const Range next = RowBases::range(one.after, next_);
    if (next.lo > next.hi)
      offer(0, RowBases::behind(one.after, next_, true) | RowBases::behind(one.after, next_, false));
    const Range before = RowBases::range(one.before, now_);
    const double known = one.d.dot(known_);
    const double noise = model_.noise().process_bound * (1.0 + 1e-9) + 1e-13 * known_.norm();
    if (next.lo > before.hi + known + noise)
      offer(RowBases::behind(one.before, now_, false), RowBases::behind(one.after, next_, true));
    if (next.hi < before.lo + known - noise)
      offer(RowBases::behind(one.before, now_, true), RowBases::behind(one.after, next_, false));
  }

  /// The noise between the two samples that least squares find.
  Vector suggested(const LeftOut& out) const {
    const Vector now = fitted(row_, out.before);
    return fitted(row_ + 1, out.after) - model_.A() * now - known_;
  }
  Vector fitted(Eigen::Index row, Sources left_out) const {
    const Eigen::Index n = model_.states();
    Matrix information = Matrix::Zero(n, n);
    Vector sum = Vector::Zero(n);
    for (Eigen::Index k = 0; k < y_.rows(); ++k) {
      if ((rows_.source[static_cast<std::size_t>(k)] & left_out) != 0 || !std::isfinite(y_(k, row))) continue;
      information += rows_.rows.col(k) * rows_.rows.col(k).transpose();
      sum += y_(k, row) * rows_.rows.col(k);
    }
    return information.ldlt().solve(sum);
  }

  bool tired() { return work_ > most_work_ || current_budget().over(); }

  /// Sample by sample, or step by step: other sources may lie each time.
  Contradiction each(Refuted what) {
    LeftOut last;
    for (Eigen::Index row = 0; row + (steps_ ? 1 : 0) < y_.cols(); row += stride_) {
      enter(row);
      if (broken(last) && !explained({}, last))
        return tired() ? Contradiction{} : Contradiction{what, static_cast<int>(row)};
      if (tired()) return {};
    }
    return {};
  }

  int left(Sources out) const { return options_.attacked - std::popcount(out); }

  /// Whether some choice of liars explains the present samples; it is left in `found`.
  bool explained(const LeftOut& out, LeftOut& found) {
    if (tired()) return true;
    const auto one = broken(out);
    if (!one) {
      found = out;
      return true;
    }
    bool first = true;
    for (const auto& [liar, later] : suspects(*one, left(out.before) > 0, left(out.after) > 0)) {
      const LeftOut next{out.before | (later ? 0 : liar), out.after | (later ? liar : 0)};
      if (explained(next, found)) return true;
      if (first && too_many(out)) return false;
      first = false;
    }
    return false;
  }

  /// Whose measurement one of a contradiction may be, and whether at the second sample: who is behind most
  /// contradictions first.
  std::vector<std::pair<Sources, bool>> suspects(const LeftOut& one, bool before, bool after) const {
    std::vector<std::tuple<int, Sources, bool>> all;
    for (const bool later : {false, true})
      for (Sources some = (later ? after : before) ? (later ? one.after : one.before) : 0; some != 0;
           some &= some - 1)
        all.emplace_back(-votes_.of(some & -some, later), some & -some, later);
    std::sort(all.begin(), all.end());
    std::vector<std::pair<Sources, bool>> found;
    for (const auto& [votes, liar, later] : all) found.emplace_back(liar, later);
    return found;
  }

  /// More contradictions without a common source than liars are left.
  bool too_many(LeftOut out) {
    int most = left(out.before) + (steps_ ? left(out.after) : 0);
    for (; most >= 0; --most) {
      const auto one = broken(out);
      if (!one) return false;
      out.before |= one->before;
      out.after |= one->after;
    }
    return true;
  }

  /// The same sources lie in all samples.
  Contradiction for_good(Refuted what) {
    last_look_ = 0;
    if (explained_for_good(0, 0) || tired()) return {};
    return {what, static_cast<int>(last_look_)};
  }
  bool explained_for_good(Eigen::Index from, Sources out) {
    for (Eigen::Index row = from; row + (steps_ ? 1 : 0) < y_.cols(); row += stride_) {
      if (tired()) return true;
      enter(row);
      const auto one = broken({out, out});
      if (!one) continue;
      last_look_ = std::max(last_look_, row);
      for (const auto& [liar, later] : suspects({one->before | one->after, 0}, left(out) > 0, false))
        if (explained_for_good(row, out | liar)) return true;
      return false;
    }
    return true;
  }

  const Model& model_;
  const ContradictionOptions& options_;
  std::vector<Eigen::Index> column_;
  detail::MeasuredRows rows_;
  RowBases bases_;
  Matrix y_;  // m x samples
  double reach_;
  Eigen::Index stride_ = 1;
  std::vector<Direction> directions_;
  Direction suggested_;
  Votes votes_;
  bool steps_ = false;
  Eigen::Index row_ = -1;
  Eigen::Index last_look_ = 0;
  Readings now_;
  Readings next_;
  Vector known_;  // what the inputs add from now to next
  double work_ = 0.0;
  double most_work_ = kMostWork;
};

void require(const Model& model, const MatrixRef& measurements, int trials,
             const ContradictionOptions& options) {
  if (trials < 1 || measurements.rows() % trials != 0)
    refuse("trials", std::to_string(trials), "a divisor of the " + amount(measurements.rows(), "row"));
  if (measurements.cols() != model.total_outputs())
    refuse("measurements", amount(measurements.cols(), "column"),
           std::to_string(model.total_outputs()) + ", one per output of the model");
  if (options.attacked < 0) refuse("attacked", std::to_string(options.attacked), "a whole number >= 0");
  if (!options.owner.empty() && static_cast<int>(options.owner.size()) != model.total_outputs())
    refuse("owner", amount(options.owner.size(), "number"),
           std::to_string(model.total_outputs()) + ", one per output of the model");
  if (options.inputs.size() != 0 &&
      (options.inputs.cols() != model.inputs() || options.inputs.rows() + 1 < measurements.rows() / trials))
    refuse("inputs", amount(options.inputs.rows(), "row") + " of " + std::to_string(options.inputs.cols()),
           "one row from each sample to the next, a number per input");
}

}  // namespace

std::vector<Contradiction> contradictions(const Model& model, const MatrixRef& measurements, int trials,
                                          const ContradictionOptions& options) {
  require(model, measurements, trials, options);
  std::vector<Contradiction> found(static_cast<std::size_t>(trials));
  const Eigen::Index times = measurements.rows() / trials;
  if (model.noise().measurement_bound.size() == 0 || model.states() > kMostStates || times == 0) return found;
  const Chosen chosen = choose(model, options);
  if (chosen.column.empty()) return found;
  const double directions = std::min<double>(kMostDirections, static_cast<double>(chosen.column.size()));
  const auto samples = static_cast<double>(std::clamp<Eigen::Index>(times, 1, kMostSamples));
  const double one = (3.0 * directions + 4.0) * (model.states() + 3.0) * samples;  // of one group
  const int groups = std::clamp(static_cast<int>(std::min(kPass / one, 1e9)), kFewestGroups, kMostGroups);
  Search search(model, options, chosen, groups);
  if (!search.possible()) return found;
  const auto share = [&](double whole) { return std::min(whole, whole * kShared / trials); };
  for (int k = 0; k < trials; ++k) {
    const Eigen::Index fewer = static_cast<Eigen::Index>(share(static_cast<double>(kMostSamples)));
    search.record(measurements.middleRows(k * times, times),
                  k == 0 ? kMostSamples : std::max(fewer, kFewestSamples),
                  k == 0 ? kMostWork : share(kMostWork));
    found[static_cast<std::size_t>(k)] = search.found();
  }
  return found;
}

}  // namespace garrison
