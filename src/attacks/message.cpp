// SPDX-License-Identifier: Apache-2.0
#include "garrison/attacks/message.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/solvers.hpp"
#include "garrison/core/params.hpp"

namespace garrison {
namespace {

class Forge final : public MessageAttack {
 public:
  Forge(Schedule schedule, double offset, bool replace)
      : MessageAttack(std::move(schedule)), offset_(offset), replace_(replace) {}
  bool rewrite(const Hop&, const Random&, const FieldList& message) const override {
    message.each_number([&](std::size_t, double& v) { v = replace_ ? offset_ : v + offset_; });
    return true;
  }

 private:
  double offset_;
  bool replace_;
};

class Equivocate final : public MessageAttack {
 public:
  Equivocate(Schedule schedule, double size) : MessageAttack(std::move(schedule)), size_(size) {}
  bool rewrite(const Hop& hop, const Random& random, const FieldList& message) const override {
    const auto receiver = static_cast<std::uint32_t>(hop.receiver);
    double square = 0.0;
    message.each_number(
        [&](std::size_t k, double&) { square += std::pow(direction(hop, random, receiver, k), 2); });
    message.each_number([&](std::size_t k, double& v) {
      v += size_ * direction(hop, random, receiver, k) / std::sqrt(square);
    });
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
/// Calls action(state, value) for every number of a message that belongs to a state.
template <class Action>
void each_state(const Hop& hop, const FieldList& message, const Action& action) {
  const std::size_t count = hop.entries.empty() ? static_cast<std::size_t>(hop.states) : hop.entries.size();
  message.each_number([&](std::size_t k, double& v) {
    if (k < count) action(hop.entries.empty() ? static_cast<int>(k) : hop.entries[k], v);
  });
}

class Coordinated final : public MessageAttack {
 public:
  Coordinated(Schedule schedule, Matrix root)
      : MessageAttack(std::move(schedule)), liars_(this->schedule().everyone()), root_(std::move(root)) {}
  bool rewrite(const Hop& hop, const Random& random, const FieldList& message) const override {
    const auto first = static_cast<Eigen::Index>(place(liars_, hop.sender)) * root_.rows() /
                       static_cast<Eigen::Index>(liars_.size());
    for (Eigen::Index c = 0; c < root_.cols(); ++c) {
      const double z =
          random.normal(hop.t, hop.salt, static_cast<std::uint32_t>(c));  // the same for all liars
      each_state(hop, message, [&](int state, double& v) { v += root_(first + state, c) * z; });
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
  bool rewrite(const Hop& hop, const Random&, const FieldList& message) const override {
    const std::int64_t row = hop.t - schedule().first();
    if (row >= deltas_.rows()) return true;
    const auto first = static_cast<Eigen::Index>(place(liars_, hop.sender)) * deltas_.cols() /
                       static_cast<Eigen::Index>(liars_.size());
    each_state(hop, message, [&](int state, double& v) { v += deltas_(row, first + state); });
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
    refuse(which, amount(columns, "column"), "a multiple of " + amount(liars, "column"),
           "one block of as many as there are states for each of the attacked agents");
}

class Silence final : public MessageAttack {
 public:
  using MessageAttack::MessageAttack;
  bool rewrite(const Hop&, const Random&, const FieldList&) const override { return false; }
};

class Falsify final : public MessageAttack {
 public:
  Falsify(Schedule schedule, std::string field, double value, std::vector<int> members)
      : MessageAttack(std::move(schedule)),
        field_(std::move(field)),
        value_(value),
        members_(std::move(members)) {}
  bool rewrite(const Hop&, const Random&, const FieldList& message) const override {
    const FieldRef* field = message.find(field_);
    if (field == nullptr) return true;
    switch (field->kind) {
      case FieldKind::numbers:
      case FieldKind::optional:
      case FieldKind::sparse:
        std::fill_n(static_cast<double*>(field->data), field->size, value_);
        break;
      case FieldKind::flag:
        *static_cast<bool*>(field->data) = value_ != 0.0;
        break;
      case FieldKind::count:
        *static_cast<int*>(field->data) =
            value_ >= 0.0 && value_ <= field->size ? static_cast<int>(value_) : -1;  // refused by who gets it
        break;
      case FieldKind::set:
        accuse(*static_cast<AgentSet*>(field->data));
        break;
      case FieldKind::labels:
        accuse(*static_cast<LabelSet*>(field->data));
        break;
    }
    return true;
  }
  void require(const FieldList& message, int agents) const override {
    std::vector<std::string> known;
    for (const FieldRef& field : message.all()) known.emplace_back(field.name);
    const FieldRef* const field = message.find(field_);
    if (field == nullptr) refuse_unknown("falsify.field", field_, known);
    const bool set = field->kind == FieldKind::set || field->kind == FieldKind::labels;
    if (!set && !members_.empty())
      refuse("falsify.members", "members of " + field_ + ", which is no set", "a value", "value = ..");
    if (set && value_ != 0.0)
      refuse("falsify.value", text(value_) + " for " + field_ + ", which is a set", "members",
             "members = [..]");
    for (const int id : members_)
      if (id >= agents)
        refuse("falsify.members", std::to_string(id), "ids of agents in 0.." + std::to_string(agents - 1));
    if (set && !keeps(*field))
      refuse("falsify.field", field_ + ", of which this filter sends nothing with these parameters",
             "a field that its messages carry");
  }

 private:
  /// Whether a set has room for anything.
  static bool keeps(const FieldRef& field) {
    return field.kind == FieldKind::set ? !static_cast<AgentSet*>(field.data)->empty()
                                        : static_cast<LabelSet*>(field.data)->capacity() > 0;
  }
  void accuse(AgentSet& set) const {
    if (set.empty()) return;
    set.clear();
    for (const int id : members_) set.insert(id);
  }
  void accuse(LabelSet& set) const {
    if (set.capacity() == 0) return;
    set.clear();
    for (const int id : members_) set.insert(id);
  }
  std::string field_;
  double value_;
  std::vector<int> members_;
};

class Outdated final : public MessageAttack {
 public:
  Outdated(Schedule schedule, int age) : MessageAttack(std::move(schedule)), age_(age) {}
  bool rewrite(const Hop&, const Random&, const FieldList&) const override { return true; }
  int age() const override { return age_; }

 private:
  int age_;
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

std::shared_ptr<MessageAttack> falsify(Schedule schedule, std::string field, double value,
                                       std::vector<int> members) {
  for (const int id : members)
    if (id < 0) refuse("falsify.members", "agent " + std::to_string(id), "agents that exist");
  return std::make_shared<Falsify>(std::move(schedule), std::move(field), value, std::move(members));
}

std::shared_ptr<MessageAttack> outdated(Schedule schedule, int age) {
  constexpr int kMostAge = 10000;  // engines keep the messages of so many samples
  if (age < 1 || age > kMostAge)
    refuse("outdated.age", std::to_string(age), "1.." + std::to_string(kMostAge) + " samples");
  return std::make_shared<Outdated>(std::move(schedule), age);
}

std::shared_ptr<MessageAttack> silence(Schedule schedule) {
  return std::make_shared<Silence>(std::move(schedule));
}

}  // namespace garrison
