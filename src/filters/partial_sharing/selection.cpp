// SPDX-License-Identifier: Apache-2.0
#include "garrison/filters/partial_sharing/selection.hpp"

#include <algorithm>
#include <numeric>

#include "garrison/core/random.hpp"

namespace garrison::partial_sharing {
namespace {

int wrapped(std::int64_t shift, int states) {
  const std::int64_t rest = shift % states;
  return static_cast<int>(rest < 0 ? rest + states : rest);
}

int columns_of(const MatrixRef& start) {
  if (start.rows() < 1 || start.cols() < 1)
    refuse("start", std::to_string(start.rows()) + " x " + std::to_string(start.cols()),
           "agents x states, at least one of each");
  return static_cast<int>(start.cols());
}

void require_shared(std::span<const int> shared, int states) {
  for (std::size_t i = 0; i < shared.size(); ++i)
    if (shared[i] < 1 || shared[i] > states)
      refuse("shared (l) of agent " + std::to_string(i), std::to_string(shared[i]),
             "a number of entries in 1.." + std::to_string(states), "an estimate has that many entries");
}

}  // namespace

Selection::Selection(const MatrixRef& start, std::int64_t shift)
    : states_(columns_of(start)),
      shift_(wrapped(shift, states_)),
      period_(shift_ == 0 ? 1 : states_ / std::gcd(states_, shift_)) {
  for (Eigen::Index i = 0; i < start.rows(); ++i) {
    for (Eigen::Index a = 0; a < start.cols(); ++a) {
      if (start(i, a) != 0.0 && start(i, a) != 1.0)
        refuse("selection s0[" + std::to_string(i) + ", " + std::to_string(a) + "]", text(start(i, a)),
               "0 or 1");
      if (start(i, a) == 1.0) entries_.push_back(static_cast<int>(a));
    }
    first_.push_back(entries_.size());
  }
}

Selection Selection::random(int states, std::span<const int> shared, std::int64_t shift, std::uint64_t seed,
                            std::span<const int> ids) {
  require_shared(shared, states);
  const Random chance(seed, 0, Purpose::graph, 5);
  Matrix start = Matrix::Zero(static_cast<Eigen::Index>(shared.size()), states);
  std::vector<int> all(static_cast<std::size_t>(states));
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(ids.empty() ? static_cast<int>(i) : ids[i]);
    std::iota(all.begin(), all.end(), 0);
    for (int k = 0; k < shared[i]; ++k) {  // the first l of a shuffle
      const double u = chance.uniform(0, id, static_cast<std::uint32_t>(k));
      const int other = k + static_cast<int>(u * (states - k));
      std::swap(all[static_cast<std::size_t>(k)], all[static_cast<std::size_t>(other)]);
      start(static_cast<Eigen::Index>(i), all[static_cast<std::size_t>(k)]) = 1.0;
    }
  }
  return {start, shift};
}

Selection Selection::coordinated(int states, std::span<const int> shared, std::int64_t shift) {
  require_shared(shared, states);
  Matrix start = Matrix::Zero(static_cast<Eigen::Index>(shared.size()), states);
  for (std::size_t i = 0; i < shared.size(); ++i)
    start.row(static_cast<Eigen::Index>(i)).head(shared[i]).setOnes();
  return {start, shift};
}

Matrix Selection::at(std::int64_t k) const {
  const int moved = offset(k);
  Matrix s = Matrix::Zero(agents(), states_);
  for (int i = 0; i < agents(); ++i)
    for (const int a : entries(i)) s(i, (a + moved) % states_) = 1.0;
  return s;
}

Vector Selection::stacked(std::int64_t k) const { return at(k).transpose().reshaped(); }

Matrix Selection::frequency() const {
  Matrix sum = Matrix::Zero(agents(), states_);
  for (int k = 0; k < period(); ++k) sum += at(k);
  return sum / period();
}

Matrix Selection::moments_cycle() const {
  const auto size = static_cast<Eigen::Index>(agents()) * states_;
  Matrix sum = Matrix::Zero(size, size);
  for (int k = 0; k < period(); ++k) {
    const Vector s = stacked(k);
    sum += s * s.transpose();
  }
  return sum / period();
}

Matrix Selection::moments_uniform() const {
  const int m = states_;
  Matrix W(static_cast<Eigen::Index>(agents()) * m, static_cast<Eigen::Index>(agents()) * m);
  for (int i = 0; i < agents(); ++i)
    for (int j = 0; j < agents(); ++j) {
      const double p = static_cast<double>(shared(i)) / m;
      const double q = static_cast<double>(shared(j)) / m;
      auto block = W.block(static_cast<Eigen::Index>(i) * m, static_cast<Eigen::Index>(j) * m, m, m);
      block.setConstant(i == j && m > 1 ? p * (shared(i) - 1) / (m - 1) : i == j ? p : p * q);
      if (i == j) block.diagonal().setConstant(p);
    }
  return W;
}

}  // namespace garrison::partial_sharing
