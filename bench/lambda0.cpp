// SPDX-License-Identifier: Apache-2.0
// lambda_0: branch and bound against enumeration, both in C++.
#include <Eigen/Eigenvalues>
#include <numeric>

#include "bench.hpp"
#include "garrison/analysis/subsets.hpp"

using namespace garrison;

namespace {

/// Least eigenvalue over all sets, or over the first `most` of them. Returns value, sets looked at, seconds.
std::tuple<double, std::int64_t, double> enumerate(const Matrix& C, int s, std::int64_t most) {
  using M4 = Eigen::Matrix4d;
  const auto N = static_cast<int>(C.rows());
  if (C.cols() != 4) throw py::value_error("enumeration is written for 4 columns");
  std::vector<M4> outer;
  M4 all = M4::Zero();
  for (int i = 0; i < N; ++i) {
    outer.push_back(C.row(i).transpose() * C.row(i));
    all += outer.back();
  }
  std::vector<int> removed(static_cast<std::size_t>(s));
  std::iota(removed.begin(), removed.end(), 0);
  double best = kInfinity;
  std::int64_t sets = 0;
  const double begin = cpu_seconds();
  while (sets < most) {
    M4 S = all;
    for (const int i : removed) S -= outer[static_cast<std::size_t>(i)];
    best = std::min(best, Eigen::SelfAdjointEigenSolver<M4>(S, Eigen::EigenvaluesOnly).eigenvalues()(0));
    ++sets;
    int k = s - 1;
    while (k >= 0 && removed[static_cast<std::size_t>(k)] == N - s + k) --k;
    if (k < 0) break;
    ++removed[static_cast<std::size_t>(k)];
    for (int j = k + 1; j < s; ++j)
      removed[static_cast<std::size_t>(j)] = removed[static_cast<std::size_t>(j - 1)] + 1;
  }
  return {best, sets, cpu_seconds() - begin};
}

std::tuple<double, bool, std::int64_t, double> ours(const Matrix& C, int s) {
  const double begin = cpu_seconds();
  const auto found = lambda0(C, s);
  return {found.lower, found.exact, found.nodes, cpu_seconds() - begin};
}

}  // namespace

void bind_lambda0(py::module_& m) {
  m.def("lambda0_enumerate", &enumerate, py::arg("C"), py::arg("s"), py::arg("most"));
  m.def("lambda0_ours", &ours, py::arg("C"), py::arg("s"));
}
