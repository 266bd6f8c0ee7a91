// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/message.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/solvers.hpp"

namespace garrison {
namespace {

class Forge final : public MessageAttack {
 public:
  Forge(Schedule schedule, double offset, bool replace)
      : MessageAttack(std::move(schedule)), offset_(offset), replace_(replace) {}
  bool rewrite(const Hop&, const Random&, std::span<double> values) const override {
    for (double& v : values) v = replace_ ? offset_ : v + offset_;
    return true;
  }

 private:
  double offset_;
  bool replace_;
};

class Equivocate final : public MessageAttack {
 public:
  Equivocate(Schedule schedule, double size) : MessageAttack(std::move(schedule)), size_(size) {}
  bool rewrite(const Hop& hop, const Random& random, std::span<double> values) const override {
    const auto receiver = static_cast<std::uint32_t>(hop.receiver);
    double square = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k)
      square += std::pow(direction(hop, random, receiver, k), 2);
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] += size_ * direction(hop, random, receiver, k) / std::sqrt(square);
    return true;
  }

 private:
  static double direction(const Hop& hop, const Random& random, std::uint32_t receiver, std::size_t k) {
    const auto index = static_cast<std::uint32_t>(k) + 64U * static_cast<std::uint32_t>(hop.round + 1);
    return random.normal(hop.t, static_cast<std::uint32_t>(hop.sender) * 65537U + receiver, index);
  }
  double size_;
};

/// Place of a sender in the sorted list of liars.
std::size_t place(const std::vector<int>& liars, int sender) {
  return static_cast<std::size_t>(std::lower_bound(liars.begin(), liars.end(), sender) - liars.begin());
}
/// State that number k of a message belongs to.
int state_of(const Hop& hop, std::size_t k) {
  return hop.entries.empty() ? static_cast<int>(k) : hop.entries[k];
}

class Coordinated final : public MessageAttack {
 public:
  Coordinated(Schedule schedule, Matrix root)
      : MessageAttack(std::move(schedule)), liars_(this->schedule().everyone()), root_(std::move(root)) {}
  bool rewrite(const Hop& hop, const Random& random, std::span<double> values) const override {
    const auto first = static_cast<Eigen::Index>(place(liars_, hop.sender)) * root_.rows() /
                       static_cast<Eigen::Index>(liars_.size());
    for (Eigen::Index c = 0; c < root_.cols(); ++c) {
      const double z =
          random.normal(hop.t, hop.salt, static_cast<std::uint32_t>(c));  // the same for all liars
      for (std::size_t k = 0; k < values.size(); ++k) values[k] += root_(first + state_of(hop, k), c) * z;
    }
    return true;
  }
  bool fits(int states) const override {
    return root_.rows() == static_cast<Eigen::Index>(liars_.size()) * states;
  }

 private:
  std::vector<int> liars_;
  Matrix root_;
};

class Perturb final : public MessageAttack {
 public:
  Perturb(Schedule schedule, Matrix deltas)
      : MessageAttack(std::move(schedule)), liars_(this->schedule().everyone()), deltas_(std::move(deltas)) {}
  bool rewrite(const Hop& hop, const Random&, std::span<double> values) const override {
    const std::int64_t row = hop.t - schedule().first();
    if (row >= deltas_.rows()) return true;
    const auto first = static_cast<Eigen::Index>(place(liars_, hop.sender)) * deltas_.cols() /
                       static_cast<Eigen::Index>(liars_.size());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] += deltas_(row, first + state_of(hop, k));
    return true;
  }
  bool fits(int states) const override {
    return deltas_.cols() == static_cast<Eigen::Index>(liars_.size()) * states;
  }

 private:
  std::vector<int> liars_;
  Matrix deltas_;
};

/// Columns whose squares sum to the covariance. Eigenvalues that are rounding of zero are left out: their
/// roots would be 1e-8 of noise where there must be none.
Matrix root_of(const Matrix& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(covariance);
  const Vector& w = eigen.eigenvalues();
  const double largest = w(w.size() - 1);
  if (w(0) < -1e-10 * std::max(largest, -w(0)))
    refuse("covariance", "least eigenvalue " + text(w(0)), "a positive semidefinite matrix");
  const double rounding = static_cast<double>(w.size()) * 2.2e-16 * largest;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index c = w.size(); c-- > 0;)
    if (w(c) > rounding) kept.push_back(c);
  Matrix root(w.size(), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t c = 0; c < kept.size(); ++c)
    root.col(static_cast<Eigen::Index>(c)) = std::sqrt(w(kept[c])) * eigen.eigenvectors().col(kept[c]);
  return root;
}

void require_blocks(const char* which, const Schedule& schedule, Eigen::Index columns) {
  const auto liars = static_cast<Eigen::Index>(schedule.everyone().size());
  if (liars == 0 || columns == 0 || columns % liars != 0)
    refuse(which, std::to_string(columns) + " columns", "a multiple of " + std::to_string(liars) + " columns",
           "one block of as many as there are states for each of the attacked agents");
}

class Silence final : public MessageAttack {
 public:
  using MessageAttack::MessageAttack;
  bool rewrite(const Hop&, const Random&, std::span<double>) const override { return false; }
};

}  // namespace

std::shared_ptr<MessageAttack> forge(Schedule schedule, double offset, bool replace) {
  return std::make_shared<Forge>(std::move(schedule), offset, replace);
}

std::shared_ptr<MessageAttack> equivocate(Schedule schedule, double size) {
  if (!(size >= 0.0)) refuse("size", text(size), "a number >= 0");
  return std::make_shared<Equivocate>(std::move(schedule), size);
}

std::shared_ptr<MessageAttack> coordinated(Schedule schedule, const Matrix& covariance) {
  if (covariance.rows() != covariance.cols())
    refuse("covariance", std::to_string(covariance.rows()) + " x " + std::to_string(covariance.cols()),
           "a square matrix");
  require_blocks("covariance", schedule, covariance.cols());
  if (!covariance.allFinite()) refuse("covariance", "a number that is not finite", "finite numbers");
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-12 * covariance.cwiseAbs().maxCoeff())
    refuse("covariance", "a matrix that is not symmetric", "a symmetric one");
  return std::make_shared<Coordinated>(std::move(schedule), root_of(covariance));
}

std::shared_ptr<MessageAttack> perturb(Schedule schedule, const Matrix& deltas) {
  require_blocks("deltas", schedule, deltas.cols());
  if (!deltas.allFinite()) refuse("deltas", "a number that is not finite", "finite numbers");
  return std::make_shared<Perturb>(std::move(schedule), deltas);
}

std::shared_ptr<MessageAttack> silence(Schedule schedule) {
  return std::make_shared<Silence>(std::move(schedule));
}

}  // namespace garrison
