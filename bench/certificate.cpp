// SPDX-License-Identifier: Apache-2.0
// A whole step of a saturated consensus filter, with and without a certificate.
#include <map>
#include <memory>
#include <random>

#include "bench.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/any_filter.hpp"

using namespace garrison;
using certificate::Spread;
using certificate::Wanted;

namespace {

/// N agents with one sensor each, n = 4.
class CertifiedStep {
 public:
  CertifiedStep(int agents, int rounds, const std::string& spread, int subsets, int attacked)
      : y_(static_cast<std::size_t>(agents)) {
    const Network network = Network::random_geometric(agents, 0.4, 1);
    const Matrix A = 0.95 * Matrix::Identity(4, 4);
    std::vector<Matrix> C;
    for (int i = 0; i < agents; ++i) C.push_back(Matrix::Identity(4, 4).row(i % 4));
    const std::vector<Matrix> R(static_cast<std::size_t>(agents), Matrix::Constant(1, 1, 0.01));
    const Model model(A, C, {kNaN, Vector(), 0.01 * Matrix::Identity(4, 4), R});
    prepared_ = make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{rounds}}})
                    ->prepare(model, network);
    const std::map<std::string, Spread> spreads{
        {"local", Spread::local}, {"flooded", Spread::flooded}, {"direct", Spread::direct}};
    if (spread != "none") prepared_ = certified(*prepared_, {spreads.at(spread), 1e-6, attacked, subsets});
    runner_ = prepared_->runner(1);
    runner_->reset(Matrix::Zero(4, agents), nullptr);
    for (int i = 0; i < agents; ++i) agents_.push_back(prepared_->agent(i));
    for (int i = 0; i < agents; ++i) bodies_.emplace_back(agents_.front()->most_bytes());
    sizes_.resize(bodies_.size());
    next_ = bodies_;
  }
  /// Seconds of a sample of the whole network.
  double engine(int samples) {
    double seconds = 0.0;
    for (int k = 0; k < samples; ++k) {
      measure();
      const double begin = cpu_seconds();
      runner_->step(++t_, y_.data());
      seconds += cpu_seconds() - begin;
    }
    return seconds / samples;
  }
  /// The same of agents that are driven by bytes.
  double agents(int samples) {
    double seconds = 0.0;
    for (int k = 0; k < samples; ++k) {
      measure();
      const double begin = cpu_seconds();
      step_agents(++sample_);
      seconds += cpu_seconds() - begin;
    }
    return seconds / samples;
  }

 private:
  void measure() {
    std::normal_distribution<double> normal(0.0, 0.1);
    for (double& y : y_) y = normal(rng_);
  }
  void step_agents(std::int64_t t) {
    for (std::size_t i = 0; i < agents_.size(); ++i)
      sizes_[i] = agents_[i]->sense(t, {&y_[i], 1}, bodies_[i]).bytes;
    for (int round = 0; round < agents_.front()->rounds(); ++round) {
      for (auto& agent : agents_)
        for (const int j : agent->neighbours())
          agent->deliver(
              {j, t, round},
              std::span(bodies_[static_cast<std::size_t>(j)]).first(sizes_[static_cast<std::size_t>(j)]));
      for (std::size_t i = 0; i < agents_.size(); ++i) sizes_[i] = agents_[i]->fuse(next_[i]).bytes;
      bodies_.swap(next_);
    }
  }

  std::shared_ptr<const Prepared> prepared_;
  std::unique_ptr<Runner> runner_;
  std::vector<std::unique_ptr<Agent>> agents_;
  std::vector<std::vector<std::byte>> bodies_, next_;
  std::vector<std::size_t> sizes_;
  std::vector<double> y_;
  std::mt19937_64 rng_{1};
  std::int64_t t_ = 0;
  std::int64_t sample_ = 0;
};

}  // namespace

void bind_certificate(py::module_& m) {
  py::class_<CertifiedStep>(m, "CertifiedStep")
      .def(py::init<int, int, const std::string&, int, int>(), py::arg("agents"), py::arg("rounds"),
           py::arg("spread"), py::arg("subsets"), py::arg("attacked"))
      .def("engine", &CertifiedStep::engine, py::arg("samples"))
      .def("agents", &CertifiedStep::agents, py::arg("samples"));
}
