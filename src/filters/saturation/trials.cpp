// SPDX-License-Identifier: Apache-2.0
// Eight trials of Algorithm 1 side by side: the same operations as `Saturation::sense`, lane by lane.
#include <algorithm>
#include <cmath>
#include <vector>

#include "garrison/engine/plan/consensus.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/kernel/aligned.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison {
namespace {

constexpr std::ptrdiff_t kL = kLanes;

/// Predict and saturate for all agents; arrays [agent][component][lane].
struct SenseJob {
  const double* A;          // n x n, column by column
  const double* C;          // all rows, in the order of agents
  const int* outputs;       // per agent
  const int* first_output;  // per agent: index into y
  const double* y;          // [measurement][lane]
  double* x;
  int agents;
  double beta;
};

template <int n>
struct Sense {
  template <int B>
  GARRISON_INLINE static void run(const SenseJob& job) {
    for (int lane = 0; lane < kLanes; lane += B) part<B>(job, lane);
  }

 private:
  /// The B lanes from `lane` on.
  template <int B>
  GARRISON_INLINE static void part(const SenseJob& job, int lane) {
    using Lanes = Block<B>;
    using V = Lanes::type;
    const V beta = V{} + job.beta;
    const V huge = V{} + kHuge;
    const double* c = job.C;
    double* x = job.x + lane;
    for (int i = 0; i < job.agents; ++i, x += n * kL) {
      V prediction[n];
      V now[n];
      for (int r = 0; r < n; ++r) {
        prediction[r] = job.A[r] * *Lanes::of(x);
        for (int k = 1; k < n; ++k) prediction[r] += job.A[k * n + r] * *Lanes::of(x + k * kL);
        now[r] = prediction[r];
      }
      for (int o = 0; o < job.outputs[i]; ++o, c += n) {
        V expected = {};
        for (int k = 0; k < n; ++k) expected += c[k] * prediction[k];
        const V innovation = *Lanes::of(job.y + (job.first_output[i] + o) * kL + lane) - expected;
        const V low = innovation < -beta ? -beta : innovation;
        const V clipped = low > beta ? beta : low;
        // Missing, or used in full and so large that it would destroy the estimate (or NaN): no update.
        const V least = clipped > -huge ? clipped : V{};
        const V injected = least < huge ? least : V{};
        for (int k = 0; k < n; ++k) now[k] += injected * c[k];
      }
      for (int r = 0; r < n; ++r) *Lanes::of(x + r * kL) = now[r];
    }
  }
};

/// Estimates of all agents into an array per lane.
struct ReadJob {
  const double* x;    // [agent][component][lane]
  const int* places;  // in x, by public id
  int agents;
  double* const* out;
  int used;
};

template <int n>
struct Read {
  template <int B>
  GARRISON_INLINE static void run(const ReadJob& job) {
    constexpr int W = block_of(n, B);
    using Lanes = Block<W>;
    for (int i = 0; i < job.agents; ++i) {
      const double* const x = job.x + job.places[i] * n * kL;
      for (int first = 0; first < n; first += W)
        for (int lane = 0; lane < kLanes; lane += W) {
          typename Lanes::type row[W];
          for (int r = 0; r < W; ++r) row[r] = *Lanes::of(x + (first + r) * kL + lane);
          transpose<W>(row);
          for (int l = 0; l < std::min(W, job.used - lane); ++l)
            *Lanes::of(job.out[lane + l] + i * n + first) = row[l];
        }
    }
  }
};

template <int n>
class SaturationTrials final : public TrialsRunner {
 public:
  SaturationTrials(std::shared_ptr<const Saturation::Gains> gains, const Model& model, const Network& network)
      : gains_(std::move(gains)), model_(model), plan_(network.offsets(), network.lists(), n * kLanes) {
    places_.resize(static_cast<std::size_t>(model_.agents()));
    for (const int i : plan_.order()) {
      places_[static_cast<std::size_t>(i)] = static_cast<int>(outputs_.size());
      outputs_.push_back(model_.outputs(i));
      first_output_.push_back(model_.offset(i));
      for (Eigen::Index r = 0; r < model_.C(i).rows(); ++r)
        for (int k = 0; k < n; ++k) rows_.push_back(model_.C(i)(r, k));
    }
    x_.resize(static_cast<std::size_t>(model_.agents() * n) * kLanes);
    scratch_.resize(x_.size());
  }

  void reset(const Matrix* x0) override {
    clock_.started = false;
    clock_.rho = gains_->bounded ? gains_->setting.eta0 : kNaN;
    clock_.p = 0.0;
    clock_.still = -1;
    for (int l = 0; l < kLanes; ++l)
      for (int k = 0; k < model_.agents(); ++k)
        for (int r = 0; r < n; ++r) at(k, r, l) = x0[l](r, plan_.order()[static_cast<std::size_t>(k)]);
  }

  void step(const double* y) override {
    saturation::advance_bounds(*gains_, clock_);
    const SenseJob job{model_.A().data(),
                       rows_.data(),
                       outputs_.data(),
                       first_output_.data(),
                       y,
                       x_.data(),
                       model_.agents(),
                       saturation::beta_now(*gains_, clock_)};
    run_widest<Sense<n>, const SenseJob&>(job);
    plan_.run(x_.data(), scratch_.data(), gains_->alpha, gains_->omega, gains_->rounds);
  }
  void read(double* const* out, int used) const override {
    run_widest_of<Read<n>, n, const ReadJob&>({x_.data(), places_.data(), model_.agents(), out, used});
  }

 private:
  double& at(int k, int r, int lane) { return x_[static_cast<std::size_t>((k * n + r) * kLanes + lane)]; }
  std::shared_ptr<const Saturation::Gains> gains_;
  Model model_;
  ConsensusPlan plan_;
  saturation::Memory clock_;  // carries the threshold over time, which is the same for all agents and trials
  std::vector<int> places_;
  std::vector<int> outputs_;
  std::vector<int> first_output_;
  std::vector<double> rows_;
  Aligned<double> x_;
  Aligned<double> scratch_;
};

}  // namespace

std::unique_ptr<TrialsRunner> Saturation::trials(std::shared_ptr<const Gains> gains, const Model& model,
                                                 const Network& network) {
  if (gains->detector || !gains->table.empty() || model.states() > 8) return nullptr;
  std::unique_ptr<TrialsRunner> runner;
  [&]<int... k>(std::integer_sequence<int, k...>) {
    const auto make = [&]<int n>(std::integral_constant<int, n>) {
      if (model.states() == n) runner = std::make_unique<SaturationTrials<n>>(gains, model, network);
    };
    (make(std::integral_constant<int, k + 1>{}), ...);
  }(std::make_integer_sequence<int, 8>{});
  return runner;
}

}  // namespace garrison
