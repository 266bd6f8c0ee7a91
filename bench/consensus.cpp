// SPDX-License-Identifier: Apache-2.0
// L rounds of x <- (I - alpha Lap) x: ours, Eigen's, and a whole filter step of ours.
#include "garrison/engine/plan/consensus.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <memory>
#include <numbers>

#include "bench.hpp"
#include "garrison/core/network.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/kernel/aligned.hpp"

using namespace garrison;

namespace {

constexpr int kWidth = 8;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, kWidth, Eigen::RowMajor>;
using AnyRowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The largest connected part of a network, its agents numbered in their old order.
Network largest_part(const Network& net) {
  std::vector<int> part(static_cast<std::size_t>(net.agents()), -1);
  std::vector<int> sizes;
  std::vector<int> stack;
  for (int i = 0; i < net.agents(); ++i) {
    if (part[static_cast<std::size_t>(i)] >= 0) continue;
    const auto label = static_cast<int>(sizes.size());
    sizes.push_back(0);
    part[static_cast<std::size_t>(i)] = label;
    stack.push_back(i);
    while (!stack.empty()) {
      const int k = stack.back();
      stack.pop_back();
      ++sizes.back();
      for (const int j : net.neighbours(k))
        if (part[static_cast<std::size_t>(j)] < 0) {
          part[static_cast<std::size_t>(j)] = label;
          stack.push_back(j);
        }
    }
  }
  const auto largest = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<int> name(part.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < part.size(); ++i)
    if (part[i] == largest) name[i] = next++;
  std::vector<Edge> edges;
  for (const auto& [a, b] : net.edges())
    if (part[static_cast<std::size_t>(a)] == largest)
      edges.emplace_back(name[static_cast<std::size_t>(a)], name[static_cast<std::size_t>(b)]);
  return {next, edges};
}

/// All contenders on one random geometric network of mean degree 8, states of width 8.
class Consensus {
 public:
  Consensus(int agents, int rounds, std::uint64_t seed)
      : rounds_(rounds),
        network_(largest_part(
            Network::random_geometric(agents, std::sqrt(8.0 / (std::numbers::pi * agents)), seed))),
        plan_(network_.offsets(), network_.lists(), kWidth),
        alpha_(1.0 / (1.0 + network_.max_degree())) {
    agents = network_.agents();
    std::vector<int> position(static_cast<std::size_t>(agents));
    for (int k = 0; k < agents; ++k)
      position[static_cast<std::size_t>(plan_.order()[static_cast<std::size_t>(k)])] = k;
    std::vector<Eigen::Triplet<double>> given;
    std::vector<Eigen::Triplet<double>> ordered;
    for (int i = 0; i < agents; ++i) {
      const int p = position[static_cast<std::size_t>(i)];
      given.emplace_back(i, i, 1.0 - alpha_ * network_.degree(i));
      ordered.emplace_back(p, p, 1.0 - alpha_ * network_.degree(i));
      for (const int j : network_.neighbours(i)) {
        given.emplace_back(i, j, alpha_);
        ordered.emplace_back(p, position[static_cast<std::size_t>(j)], alpha_);
      }
    }
    W_.resize(agents, agents);
    W_.setFromTriplets(ordered.begin(), ordered.end());
    given_.resize(agents, agents);
    given_.setFromTriplets(given.begin(), given.end());
    x_ = RowMajor::NullaryExpr(agents, kWidth, [](Eigen::Index i, Eigen::Index k) {
      return std::sin(1.0 + 0.7 * static_cast<double>(i) + 1.3 * static_cast<double>(k));
    });
    scratch_.resize(static_cast<std::size_t>(x_.size()));
    prepare_filter(agents);
  }

  Eigen::SparseMatrix<double, Eigen::RowMajor> ordered() const { return W_; }
  Eigen::SparseMatrix<double, Eigen::RowMajor> as_given() const { return given_; }
  RowMajor start() const { return x_; }

  std::pair<double, RowMajor> ours() {
    Aligned<double> x(x_.data(), x_.data() + x_.size());  // as the engine keeps them
    const double begin = cpu_seconds();
    plan_.run(x.data(), scratch_.data(), alpha_, {}, rounds_);
    const double seconds = cpu_seconds() - begin;
    return {seconds, Eigen::Map<const RowMajor>(x.data(), x_.rows(), kWidth)};
  }
  std::pair<double, RowMajor> eigen_fixed() const {
    RowMajor x = x_;
    RowMajor next = x_;
    const double begin = cpu_seconds();
    for (int r = 0; r < rounds_; ++r) {
      next.noalias() = W_ * x;
      x.swap(next);
    }
    return {cpu_seconds() - begin, x};
  }
  std::pair<double, RowMajor> eigen_dynamic() const {
    AnyRowMajor x = x_;
    AnyRowMajor next = x_;
    const double begin = cpu_seconds();
    for (int r = 0; r < rounds_; ++r) {
      next.noalias() = W_ * x;
      x.swap(next);
    }
    return {cpu_seconds() - begin, x};
  }
  /// A whole step: sense with one scalar output per agent, then the rounds.
  double filter_step() {
    const double begin = cpu_seconds();
    runner_->step(++t_, y_.data());
    return cpu_seconds() - begin;
  }

 private:
  void prepare_filter(int agents) {
    const Matrix A = 0.99 * Matrix::Identity(kWidth, kWidth) + 0.001 * Matrix::Ones(kWidth, kWidth);
    std::vector<Matrix> C;
    for (int i = 0; i < agents; ++i) {
      Matrix row = Matrix::Zero(1, kWidth);
      row(0, i % kWidth) = 1.0;
      C.push_back(row);
    }
    const auto filter =
        make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{rounds_}}, {"step", alpha_}});
    runner_ = filter->prepare(Model(A, std::move(C)), network_)->runner(1);
    runner_->reset(x_.transpose(), nullptr);
    y_.assign(static_cast<std::size_t>(agents), 0.3);
  }

  int rounds_;
  Network network_;
  ConsensusPlan plan_;
  double alpha_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> W_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> given_;
  RowMajor x_;
  Aligned<double> scratch_;
  std::unique_ptr<Runner> runner_;
  std::vector<double> y_;
  std::int64_t t_ = 0;
};

}  // namespace

void bind_consensus(py::module_& m) {
  py::class_<Consensus>(m, "Consensus")
      .def(py::init<int, int, std::uint64_t>(), py::arg("agents"), py::arg("rounds"), py::arg("seed"))
      .def("ordered", &Consensus::ordered)
      .def("as_given", &Consensus::as_given)
      .def("start", &Consensus::start)
      .def("ours", &Consensus::ours)
      .def("eigen_fixed", &Consensus::eigen_fixed)
      .def("eigen_dynamic", &Consensus::eigen_dynamic)
      .def("filter_step", &Consensus::filter_step);
}
