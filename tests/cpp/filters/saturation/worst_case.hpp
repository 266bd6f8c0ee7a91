// SPDX-License-Identifier: Apache-2.0
// The saturation filter in the hands of somebody who knows everything: the worst noise, start and attacks for
// one agent, one sample and one direction.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../certificate/random_network.hpp"
#include "../../random_system.hpp"
#include "garrison/certificate/error_system.hpp"
#include "garrison/filters/saturation/filter.hpp"

namespace garrison::test {

enum class Kind : std::uint8_t { detector, fixed, adaptive };

struct Counts {
  long bounds = 0;
  long recovered = 0;  // of these, by theorem L
  long violations = 0;
  long proofs = 0;  // of attackers, behind a loss
  long false_proofs = 0;
  long clipped = 0;  // honest sensors, adaptive
  int decaying = 0;  // systems whose excess decays
  int back = 0;      // of these: every agent has a bound of at most twice the table's again
  int wrong = 0;     // runs with something false in them
  double closest = 0.0;
};

/// The filter of a whole network in the hands of somebody who knows everything: noise, start, attacked
/// sensors and signs are those that push one agent the farthest in one direction at one sample, were nothing
/// lost.
template <int n>
class Worst {
 public:
  Worst(Rng& rng, const Model& model, const Network& network, Saturation::Gains gains, int s, int target)
      : rng_(rng),
        model_(model),
        network_(network),
        gains_(std::move(gains)),
        s_(s),
        target_(target),
        N_(model.agents()),
        states_(static_cast<std::size_t>(N_)),
        messages_(static_cast<std::size_t>(N_)),
        next_(static_cast<std::size_t>(N_)) {
    Matrix C(N_, n);
    for (int i = 0; i < N_; ++i) {
      C.row(i) = model.C(i);
      rows_.push_back(model.C(i).transpose());
    }
    const auto J = saturation::averaging(network, gains_.alpha, gains_.omega, gains_.rounds);
    system_ = certificate::error_system(model.A(), C, J);
    Matrix push = Matrix::Zero(1, N_ * n);
    push.middleCols(n * whole(rng, 0, N_ - 1), n) = unit_vector(rng, n).transpose();
    pushes_.assign(static_cast<std::size_t>(target) + 1, push);
    for (int t = target - 1; t >= 0; --t)
      pushes_[static_cast<std::size_t>(t)] = pushes_[static_cast<std::size_t>(t) + 1] * system_.M;
    fixed_ = choose(rng, s, N_);
  }

  Counts run(Kind kind, int samples, double eta0, double drop) {
    Vector start = Vector::Zero(n);
    for (int i = 0; i < N_; ++i) start += pushes_[0].middleCols(n * i, n).transpose();
    x_ = Vector::Zero(n);
    const Vec<n> x0 = start.norm() > 0.0 ? Vector(eta0 * start / start.norm()) : start;
    for (int i = 0; i < N_; ++i) Saturation::init<n>(local(i), gains_, x0, states_[at(i)], messages_[at(i)]);
    next_ = messages_;
    const int outage = whole(rng_, 2, std::max(2, target_ - 4));
    for (int t = 1; t <= samples; ++t)
      step(kind, t, t >= outage && t < outage + whole(rng_, 1, 5) ? drop : 0.0);
    finish();
    return counts_;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  bool gaussian() const { return gains_.table.until < saturation::DataFree::kForEver; }
  Local local(int i) const {
    return {i, N_, n, 1, network_.degree(i), model_.A().data(), rows_[at(i)].data()};
  }

  void step(Kind kind, int t, double drop) {
    const Matrix& push = pushes_[static_cast<std::size_t>(std::min(t, target_))];
    const Eigen::RowVectorXd on_v = push * system_.B;
    Vector w = (push * system_.B_w).transpose();
    const double b_w = model_.noise().process_bound;
    w = t <= target_ && w.norm() > 0.0 ? Vector(b_w * w / w.norm()) : Vector(b_w * unit_vector(rng_, n));
    if (gaussian()) w = model_.noise().process_covariance.llt().matrixL() * normal_matrix(rng_, n, 1);
    x_ = model_.A() * x_ + w;
    const std::vector<int> attacked = kind == Kind::detector ? fixed_ : strongest(on_v);
    for (int i = 0; i < N_; ++i) {
      const double side = t > target_ ? sign(rng_) : on_v(i) < 0.0 ? -1.0 : 1.0;
      const double v = gaussian() ? std::sqrt(model_.noise().measurement_covariance[at(i)](0, 0)) *
                                        normal_matrix(rng_, 1, 1)(0)
                                  : side * model_.noise().measurement_bound(i);
      double y = model_.C(i).row(0).dot(x_) + v;
      const bool lies = contains(attacked, i);
      if (lies) {
        double expected = 0.0;
        Saturation::expected<n>(local(i), gains_, states_[at(i)], &expected);
        const double level = Saturation::alarm_level<n>(local(i), gains_, states_[at(i)]);
        // A few are loud: these are proved.
        const bool loud = kind == Kind::detector && whole(rng_, 0, 19) == 0;
        y = expected + side * (loud ? 1.0 + 3.0 * level : level * (1.0 - 1e-9));
      }
      Saturation::sense<n>(local(i), gains_, states_[at(i)], &y, t, messages_[at(i)]);
      const auto report = Saturation::report<n>(local(i), gains_, states_[at(i)]);
      if (!lies && kind == Kind::adaptive && states_[at(i)].loss->bound < kInfinity)
        counts_.clipped += report.statistic > report.threshold * (1.0 + 1e-9) + 1e-12 ? 1 : 0;
    }
    for (int round = 0; round < gains_.rounds; ++round) exchange(round, drop);
    for (int i = 0; i < N_; ++i) look(i, attacked);
  }

  std::vector<int> strongest(const Eigen::RowVectorXd& on_v) const {
    std::vector<int> all(at(N_));
    for (int i = 0; i < N_; ++i) all[at(i)] = i;
    std::sort(all.begin(), all.end(), [&](int a, int b) { return std::abs(on_v(a)) > std::abs(on_v(b)); });
    all.resize(at(s_));
    return all;
  }

  void exchange(int round, double drop) {
    for (int i = 0; i < N_; ++i) {
      std::vector<std::uint32_t> slots;
      for (const int j : network_.neighbours(i))
        if (!(uniform(rng_, 0.0, 1.0) < drop)) slots.push_back(static_cast<std::uint32_t>(j));
      const Inbox<Saturation::Message<n>> inbox(messages_.data(), slots, nullptr, network_.degree(i));
      Saturation::fuse<n>(local(i), gains_, states_[at(i)], inbox, round, next_[at(i)]);
    }
    messages_.swap(next_);
  }

  void look(int i, const std::vector<int>& attacked) {
    const auto report = Saturation::report<n>(local(i), gains_, states_[at(i)]);
    for (int j = 0; gains_.detector && j < N_; ++j)
      if (states_[at(i)].proved.contains(j))
        ++(contains(attacked, j) ? counts_.proofs : counts_.false_proofs);
    if (!std::isfinite(report.bound)) return;
    const double error = (states_[at(i)].x - x_).norm();
    ++counts_.bounds;
    counts_.violations += error > report.bound * (1.0 + 1e-9) + 1e-12 ? 1 : 0;
    if (report.kind == CertificateKind::recovered) ++counts_.recovered;
    if (report.kind != CertificateKind::recovered && !gaussian()) return;
    counts_.closest = std::max(counts_.closest, error / report.bound);
  }

  void finish() {
    counts_.wrong = counts_.violations > 0 || counts_.false_proofs > 0 ? 1 : 0;
    if (gains_.table.losses.empty()) return;
    const auto& table = gains_.table;
    const auto last = table.d.rows() - 1;
    if (!(table.losses.excess.left() < 0.5) || !(table.worst(last) < kInfinity)) return;
    ++counts_.decaying;
    bool all = true;
    for (int i = 0; i < N_; ++i) {
      const auto report = Saturation::report<n>(local(i), gains_, states_[at(i)]);
      all = all && (states_[at(i)].refuted || report.bound <= 2.0 * table.bound(i, states_[at(i)].t));
    }
    counts_.back += all ? 1 : 0;
  }

  Rng& rng_;
  const Model& model_;
  const Network& network_;
  Saturation::Gains gains_;
  int s_;
  int target_;
  int N_;
  Vector x_;
  std::vector<Vector> rows_;
  certificate::ErrorSystem system_;
  std::vector<Matrix> pushes_;  // what an error at the end of sample t does at the target
  std::vector<int> fixed_;
  std::vector<Saturation::State<n>> states_;
  std::vector<Saturation::Message<n>> messages_, next_;
  Counts counts_;
};

}  // namespace garrison::test
