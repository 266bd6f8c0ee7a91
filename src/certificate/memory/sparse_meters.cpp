// SPDX-License-Identifier: Apache-2.0
#include "garrison/certificate/memory/sparse_meters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "../require.hpp"
#include "../top.hpp"
#include "core/solvers.hpp"
#include "garrison/core/budget.hpp"
#include "sparse_part.hpp"
#include "undetectable_search.hpp"

namespace garrison::certificate {
namespace {

using detail::kNear;
using detail::SparsePart;
using detail::SparseRows;

constexpr int kMostTop = 12;  // sizes of sets that leverages are asked about

SparseRows unit_rows(const SparseRows& H) {
  SparseRows unit = H;
  unit.makeCompressed();
  for (Eigen::Index r = 0; r < unit.rows(); ++r) {
    const double length = Vector(unit.row(r).transpose()).norm();
    for (SparseRows::InnerIterator entry(unit, r); entry; ++entry)
      entry.valueRef() = length > 0.0 ? entry.value() / length : 0.0;
  }
  unit.prune(0.0);
  return unit;
}

std::deque<SparsePart> parts_of(const SparseRows& H) {
  auto found = detail::row_parts(H.rows(), H.cols(), [&](const auto& entry) {
    for (Eigen::Index r = 0; r < H.rows(); ++r)
      for (SparseRows::InnerIterator at(H, r); at; ++at) entry(r, at.col());
  });
  std::vector<Eigen::Index> place(static_cast<std::size_t>(H.cols()));
  std::deque<SparsePart> parts;
  for (detail::RowPart& p : found) {
    for (std::size_t k = 0; k < p.columns.size(); ++k)
      place[static_cast<std::size_t>(p.columns[k])] = static_cast<Eigen::Index>(k);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t r = 0; r < p.rows.size(); ++r)
      for (SparseRows::InnerIterator at(H, p.rows[r]); at; ++at)
        entries.emplace_back(static_cast<int>(r), static_cast<int>(place[static_cast<std::size_t>(at.col())]),
                             at.value());
    SparseRows own(static_cast<Eigen::Index>(p.rows.size()), static_cast<Eigen::Index>(p.columns.size()));
    own.setFromTriplets(entries.begin(), entries.end());
    parts.emplace_back(std::move(p), std::move(own));
  }
  return parts;
}

/// What the rows of Lam say of one part, row by row.
class Look {
 public:
  Look(const SparsePart& part, const std::vector<int>& source, bool keep)
      : part_(part), source_(source), m_(static_cast<Eigen::Index>(part.rows().size())) {
    if (keep) hat.resize(m_, m_);
    for (Eigen::Index r = 0; r < m_; ++r) together_[of(r)].push_back(static_cast<int>(r));
  }

  /// False: the time was up.
  bool all_rows(Vector& leverage) {
    Vector row;
    for (Eigen::Index i = 0; i < m_; ++i) {
      if (current_budget().over()) return false;
      const double error = part_.hat_row(i, row);
      leverage(part_.rows()[static_cast<std::size_t>(i)]) = std::clamp(row(i), 0.0, 1.0);
      leverages_.push_back(row(i) + error);
      add_sums(i, row, error);
      if (hat.size() > 0) hat.row(i) = row.transpose();
      // A source can be needed only where the rows of its block sum up to 1.
      double block = 0.0;
      for (const int j : together_.at(of(i))) block += std::abs(row(j)) + error;
      if (block > 1.0 - kNear) suspects_.insert(of(i));
    }
    return true;
  }

  /// Any so many rows may be missing.
  int removable() {
    int k = 0;
    while (k < kMostTop &&
           std::min(detail::top(leverages_, k + 1), sums_[static_cast<std::size_t>(k + 1)]) < 1.0 - kNear)
      ++k;
    return k;
  }

  /// Sources without which the part is not determined.
  std::vector<int> critical() const {
    std::vector<int> found;
    for (const int s : suspects_)
      if (part_.needed(together_.at(s))) found.push_back(s);
    return found;
  }

  Matrix hat;  ///< all of Lam, where it is kept

 private:
  /// Row i's part of the largest sum of a row of k entries: its own and the k - 1 largest others.
  void add_sums(Eigen::Index i, const Vector& row, double error) {
    others_.assign(row.begin(), row.end());
    others_[static_cast<std::size_t>(i)] = 0.0;
    for (double& v : others_) v = std::abs(v) + error;
    const auto few = others_.begin() + std::min<std::ptrdiff_t>(kMostTop - 1, m_);
    std::partial_sort(others_.begin(), few, others_.end(), std::greater<>());
    double sum = row(i) + error;
    for (std::size_t k = 1; k < sums_.size(); ++k) {
      sums_[k] = std::max(sums_[k], sum);
      if (k <= others_.size()) sum += others_[k - 1];
    }
  }

  int of(Eigen::Index r) const {
    return source_[static_cast<std::size_t>(part_.rows()[static_cast<std::size_t>(r)])];
  }

  const SparsePart& part_;
  const std::vector<int>& source_;
  Eigen::Index m_;
  std::map<int, std::vector<int>> together_;
  std::set<int> suspects_;
  std::vector<double> leverages_, others_;
  std::array<double, kMostTop + 1> sums_{};
};

/// All rows of the state that fewest of them show.
void smallest_column(const std::deque<SparsePart>& parts, const SparseRows& H, SparseMeters& out) {
  std::vector<std::vector<int>> shown(static_cast<std::size_t>(H.cols()));
  for (Eigen::Index r = 0; r < H.rows(); ++r)
    for (SparseRows::InnerIterator at(H, r); at; ++at)
      shown[static_cast<std::size_t>(at.col())].push_back(static_cast<int>(r));
  out.example = *std::min_element(shown.begin(), shown.end(),
                                  [](const auto& a, const auto& b) { return a.size() < b.size(); });
  out.most = static_cast<int>(out.example.size());
  out.least = kInfinity;
  for (const SparsePart& part : parts) out.least = std::min(out.least, part.least());
}

struct Searched {
  int removable = 0;  ///< of the part, for certain
  std::optional<detail::Search> search;
};

/// Exact search of all parts together, the smallest sets first; parts without a search stop it where their
/// bound ends.
void search_all(std::vector<Searched>& parts, SparseMeters& out) {
  for (int k = 1; k < out.most; ++k) {
    bool certain = true;
    for (Searched& part : parts) {
      if (k <= part.removable) continue;
      bool complete = part.search.has_value();
      std::vector<int> found = complete ? part.search->find(k, complete) : std::vector<int>();
      if (!found.empty()) {
        out.most = k;
        out.example = std::move(found);
        std::sort(out.example.begin(), out.example.end());
        break;
      }
      certain = certain && complete;
    }
    if (!certain || k == out.most) break;
    out.fewest = k + 1;
  }
}

std::vector<int> sources(std::span<const int> given, Eigen::Index rows) {
  if (!given.empty() && static_cast<Eigen::Index>(given.size()) != rows)
    refuse("source", std::to_string(given.size()), amount(rows, "number"), "one per row");
  std::vector<int> of(given.begin(), given.end());
  for (Eigen::Index r = 0; given.empty() && r < rows; ++r) of.push_back(static_cast<int>(r));
  for (const int s : of)
    if (s < 0) refuse("source", std::to_string(s), "numbers >= 0");
  return of;
}

}  // namespace

SparseMeters sparse_meters(const SparseRows& H, std::span<const int> source, int dense, double tries) {
  if (H.rows() < 1 || H.cols() < 1)
    refuse("H", std::to_string(H.rows()) + " x " + std::to_string(H.cols()), "at least 1 x 1");
  if (!(H.coeffs().abs() <= kHuge).all())
    refuse("H", "a number that is not finite or beyond 1e150", "finite numbers");
  detail::require_least("dense", dense, 0);
  detail::require_least("tries", tries, 1.0);
  const std::vector<int> of = sources(source, H.rows());
  const SparseRows unit = unit_rows(H);
  const std::deque<SparsePart> parts = parts_of(unit);
  SparseMeters out;
  for (const SparsePart& part : parts)
    if (!part.determined())
      for (const Eigen::Index k : part.columns()) out.unseen.push_back(static_cast<int>(k));
  std::sort(out.unseen.begin(), out.unseen.end());
  if (!out.unseen.empty()) return out;
  smallest_column(parts, unit, out);
  out.leverage = Vector::Constant(H.rows(), kNaN);
  std::set<int> critical;
  std::vector<Searched> searched;
  for (const SparsePart& part : parts) {
    const bool keep = part.rows().size() <= static_cast<std::size_t>(dense);
    Look look(part, of, keep);
    if (!look.all_rows(out.leverage)) return out;
    for (const int s : look.critical()) critical.insert(s);
    Searched& one = searched.emplace_back();
    one.removable = look.removable();
    if (keep && one.removable + 1 < out.most)
      one.search.emplace(
          part.rows(), std::move(look.hat), [&part](const std::vector<int>& set) { return part.needed(set); },
          tries);
  }
  out.critical.assign(critical.begin(), critical.end());
  out.complete = true;
  search_all(searched, out);
  return out;
}

}  // namespace garrison::certificate
