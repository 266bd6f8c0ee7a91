// SPDX-License-Identifier: Apache-2.0
// Structural analysis against SuiteSparse (CXSparse, BTF): processor time of one call, input in memory.
#include <suitesparse/btf.h>
#include <suitesparse/cs.h>

#include <algorithm>
#include <memory>

#include "bench.hpp"
#include "garrison/analysis/structure/components.hpp"
#include "garrison/analysis/structure/dulmage_mendelsohn.hpp"
#include "garrison/filters/structural/gains.hpp"

using namespace garrison;
using namespace garrison::structure;

namespace {

using Ints = py::array_t<int, py::array::c_style | py::array::forcecast>;

Pattern pattern_from(int rows, const Ints& start, const Ints& index) {
  return {rows, std::vector<int>(start.data(), start.data() + start.size()),
          std::vector<int>(index.data(), index.data() + index.size())};
}

/// CXSparse's view of a pattern; it does not write to it.
cs_di view(const Pattern& p) {
  cs_di A{};
  A.nzmax = p.entries();
  A.m = p.rows();
  A.n = p.columns();
  A.p = const_cast<int*>(p.start());
  A.i = const_cast<int*>(p.index());
  A.nz = -1;
  return A;
}

/// Mean seconds of `times` runs, so that short ones stand out from the clock. One run goes before: else
/// whoever comes second finds the pattern in the cache.
template <class Run>
double mean_seconds(int times, Run run) {
  run();
  const double begin = cpu_seconds();
  for (int k = 0; k < times; ++k) run();
  return (cpu_seconds() - begin) / times;
}

/// Memory for a library that wants it from its caller; taking it counts, as it does for the others.
std::unique_ptr<int[]> memory(int count) {
  return std::make_unique_for_overwrite<int[]>(static_cast<std::size_t>(count));
}

/// Everybody's result and mean seconds.
struct Instance {
  Pattern pattern;

  int* start() const { return const_cast<int*>(pattern.start()); }
  int* index() const { return const_cast<int*>(pattern.index()); }

  std::pair<int, double> matching(int times) const {
    Matching found;
    const double seconds = mean_seconds(times, [&] { found = maximum_matching(pattern); });
    return {found.size, seconds};
  }
  std::pair<int, double> matching_cs(int times) const {
    cs_di A = view(pattern);
    int* match = nullptr;
    const double seconds = mean_seconds(times, [&] {
      cs_di_free(match);
      match = cs_di_maxtrans(&A, 0);
    });
    const auto size = std::count_if(match + pattern.rows(), match + pattern.rows() + pattern.columns(),
                                    [](int i) { return i >= 0; });
    cs_di_free(match);
    return {static_cast<int>(size), seconds};
  }
  std::pair<int, double> matching_btf(int times) const {
    int size = 0;
    const double seconds = mean_seconds(times, [&] {
      const auto match = memory(pattern.rows());
      const auto work = memory(5 * pattern.columns());
      double done = 0.0;
      size = btf_maxtrans(pattern.rows(), pattern.columns(), start(), index(), -1.0, &done, match.get(),
                          work.get());
    });
    return {size, seconds};
  }
  std::pair<int, double> components(int times) const {
    Components found;
    const double seconds = mean_seconds(times, [&] { found = strong_components(pattern); });
    return {found.count, seconds};
  }
  std::pair<int, double> components_btf(int times) const {
    const int n = pattern.columns();
    int count = 0;
    const double seconds = mean_seconds(times, [&] {
      const auto order = memory(n);
      const auto first = memory(n + 1);
      const auto work = memory(4 * n);
      count = btf_strongcomp(n, start(), index(), nullptr, order.get(), first.get(), work.get());
    });
    return {count, seconds};
  }
  /// (rank, rows of the horizontal part, columns of it, rows of the vertical part, fine square blocks),
  /// seconds
  std::pair<std::vector<int>, double> decomposition(int times) const {
    Decomposition d;
    const double seconds = mean_seconds(times, [&] { d = dulmage_mendelsohn(pattern); });
    return {{d.structural_rank(), static_cast<int>(d.hor_rows.size()), static_cast<int>(d.hor_cols.size()),
             static_cast<int>(d.ver_rows.size()), d.blocks()},
            seconds};
  }
  std::pair<std::vector<int>, double> decomposition_cs(int times) const {
    cs_di A = view(pattern);
    cs_did* d = nullptr;
    const double seconds = mean_seconds(times, [&] {
      cs_di_dfree(d);
      d = cs_di_dmperm(&A, 0);
    });
    // rr, cc: coarse boundaries. Its fine blocks count the horizontal and the vertical part as one each.
    const int vertical = d->rr[4] - d->rr[2];
    const bool has_hor = d->cc[2] > 0;
    const bool has_ver = vertical > 0;
    const int blocks = d->nb - (has_hor ? 1 : 0) - (has_ver ? 1 : 0);
    const std::vector<int> found{d->rr[3], d->rr[1], d->cc[2], vertical, blocks};
    cs_di_dfree(d);
    return {found, seconds};
  }
};

/// Sweeps, certified, seconds of the coupled Riccati design of a random network.
std::tuple<int, bool, double> riccati(const Matrix& A, const Matrix& C, const Matrix& W, const Matrix& U) {
  const structural::Setting s{
      A, C, W, U, 0.01 * Matrix::Identity(A.rows(), A.rows()), 0.01 * Matrix::Identity(C.rows(), C.rows())};
  const double begin = cpu_seconds();
  const auto g = structural::coupled_riccati(s);
  return {g.sweeps, g.converged, cpu_seconds() - begin};
}

}  // namespace

void bind_structure(py::module_& m) {
  py::class_<Instance>(m, "Structure", "One pattern in compressed columns, and everybody's algorithms on it.")
      .def(py::init([](int rows, const Ints& start, const Ints& index) {
             return Instance{pattern_from(rows, start, index)};
           }),
           py::arg("rows"), py::arg("indptr"), py::arg("indices"))
      .def("matching", &Instance::matching, py::arg("times") = 1)
      .def("matching_cs", &Instance::matching_cs, py::arg("times") = 1)
      .def("matching_btf", &Instance::matching_btf, py::arg("times") = 1)
      .def("components", &Instance::components, py::arg("times") = 1)
      .def("components_btf", &Instance::components_btf, py::arg("times") = 1)
      .def("decomposition", &Instance::decomposition, py::arg("times") = 1)
      .def("decomposition_cs", &Instance::decomposition_cs, py::arg("times") = 1);
  m.def("coupled_riccati", &riccati, py::arg("A"), py::arg("C"), py::arg("W"), py::arg("U"));
}
