// SPDX-License-Identifier: Apache-2.0
// Eight trials of Algorithm 1 side by side: the same operations as `Saturation::sense`, lane by lane.
#include <algorithm>
#include <cmath>
#include <vector>

#include "garrison/core/aligned.hpp"
#include "garrison/core/block.hpp"
#include "garrison/core/clones.hpp"
#include "garrison/filters/saturation/filter.hpp"
#include "garrison/runtime/consensus.hpp"

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

/// The B lanes from `lane` on.
template <int n, int B>
GARRISON_INLINE void sense_part(const SenseJob& job, int lane) {
  using Lanes = Block<B>;
  using V = Lanes::type;
  const V beta = V{} + job.beta;
  const V huge = V{} + kHuge;
  const double* c = job.C;
  for (int i = 0; i < job.agents; ++i) {
    double* const x = job.x + static_cast<std::ptrdiff_t>(i) * n * kL + lane;
    V prediction[n];
    for (int r = 0; r < n; ++r) {
      prediction[r] = job.A[r] * *Lanes::of(x);
      for (int k = 1; k < n; ++k) prediction[r] += job.A[k * n + r] * *Lanes::of(x + k * kL);
    }
    for (int r = 0; r < n; ++r) *Lanes::of(x + r * kL) = prediction[r];
    for (int o = 0; o < job.outputs[i]; ++o, c += n) {
      V expected = {};
      for (int k = 0; k < n; ++k) expected += c[k] * prediction[k];
      const V innovation = *Lanes::of(job.y + (job.first_output[i] + o) * kL + lane) - expected;
      const V low = innovation < -beta ? -beta : innovation;
      const V clipped = low > beta ? beta : low;
      // Missing, or used in full and so large that it would destroy the estimate (or NaN): no update.
      const V injected = clipped < huge && clipped > -huge ? clipped : V{};
      for (int k = 0; k < n; ++k) *Lanes::of(x + k * kL) += injected * c[k];
    }
  }
}

template <int n, int B>
GARRISON_INLINE void sense_all(const SenseJob& job) {
  for (int lane = 0; lane < kLanes; lane += B) sense_part<n, B>(job, lane);
}

struct SenseLanes {
  template <int B>
  GARRISON_INLINE static void run(const SenseJob& job, int n) {
    switch (n) {
      case 1:
        return sense_all<1, B>(job);
      case 2:
        return sense_all<2, B>(job);
      case 3:
        return sense_all<3, B>(job);
      case 4:
        return sense_all<4, B>(job);
      case 5:
        return sense_all<5, B>(job);
      case 6:
        return sense_all<6, B>(job);
      case 7:
        return sense_all<7, B>(job);
      default:
        return sense_all<8, B>(job);
    }
  }
};

class SaturationLanes final : public LaneRunner {
 public:
  SaturationLanes(std::shared_ptr<const Saturation::Gains> gains, const Model& model, const Network& network)
      : gains_(std::move(gains)), model_(model), plan_(network.offsets(), network.lists()) {
    for (const int i : plan_.order()) {
      outputs_.push_back(model_.outputs(i));
      first_output_.push_back(model_.offset(i));
      for (Eigen::Index r = 0; r < model_.C(i).rows(); ++r)
        for (int k = 0; k < model_.states(); ++k) rows_.push_back(model_.C(i)(r, k));
    }
    x_.resize(static_cast<std::size_t>(model_.agents() * model_.states()) * kLanes);
    scratch_.resize(x_.size());
    public_.resize(x_.size());
  }

  void reset(const Matrix* x0) override {
    clock_.t = 0;
    clock_.rho = gains_->bounded ? gains_->setting.eta0 : kNaN;
    clock_.p = 0.0;
    for (int l = 0; l < kLanes; ++l)
      for (int k = 0; k < model_.agents(); ++k)
        for (int r = 0; r < model_.states(); ++r)
          at(k, r, l) = x0[l](r, plan_.order()[static_cast<std::size_t>(k)]);
    publish();
  }

  void step(const double* y) override {
    Saturation::advance_bounds(*gains_, clock_, clock_.t + 1);
    const SenseJob job{model_.A().data(),
                       rows_.data(),
                       outputs_.data(),
                       first_output_.data(),
                       y,
                       x_.data(),
                       model_.agents(),
                       Saturation::beta_now(*gains_, clock_)};
    run_widest<SenseLanes, const SenseJob&>(job, model_.states());
    plan_.run(x_.data(), scratch_.data(), model_.states() * kLanes, gains_->alpha, gains_->omega,
              gains_->rounds);
    publish();
  }
  const double* estimates() const override { return public_.data(); }

 private:
  double& at(int k, int r, int lane) {
    return x_[static_cast<std::size_t>((k * model_.states() + r) * kLanes + lane)];
  }
  void publish() {
    const auto record = static_cast<std::size_t>(model_.states() * kLanes);
    for (std::size_t k = 0; k < outputs_.size(); ++k)
      std::copy_n(x_.data() + k * record, record,
                  public_.data() + static_cast<std::size_t>(plan_.order()[k]) * record);
  }

  std::shared_ptr<const Saturation::Gains> gains_;
  Model model_;
  ConsensusPlan plan_;
  Saturation::State<1>
      clock_;  // carries the threshold over time, which is the same for all agents and trials
  std::vector<int> outputs_;
  std::vector<int> first_output_;
  std::vector<double> rows_;
  Aligned<double> x_;
  Aligned<double> scratch_;
  Aligned<double> public_;
};

}  // namespace

std::unique_ptr<LaneRunner> Saturation::lanes(std::shared_ptr<const Gains> gains, const Model& model,
                                              const Network& network) {
  if (gains->detector || model.states() > 8) return nullptr;
  return std::make_unique<SaturationLanes>(std::move(gains), model, network);
}

}  // namespace garrison
