// SPDX-License-Identifier: Apache-2.0
// Structural analysis against SuiteSparse (CXSparse, BTF): processor time of one call, input in memory.
#include <suitesparse/btf.h>
#include <suitesparse/cs.h>

#include <algorithm>

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

struct Instance {
  Pattern pattern;

  std::pair<int, double> matching() const {
    const double begin = cpu_seconds();
    const auto m = maximum_matching(pattern);
    const double end = cpu_seconds();
    return {m.size, end - begin};
  }
  std::pair<int, double> matching_cs() const {
    cs_di A = view(pattern);
    const double begin = cpu_seconds();
    int* match = cs_di_maxtrans(&A, 0);
    const double end = cpu_seconds();
    const auto size = std::count_if(match + pattern.rows(), match + pattern.rows() + pattern.columns(),
                                    [](int i) { return i >= 0; });
    cs_di_free(match);
    return {static_cast<int>(size), end - begin};
  }
  std::pair<int, double> matching_btf() const {
    std::vector<int> match(static_cast<std::size_t>(pattern.rows()));
    std::vector<int> work(5 * static_cast<std::size_t>(pattern.columns()));
    double done = 0.0;
    const double begin = cpu_seconds();
    const int size = btf_maxtrans(pattern.rows(), pattern.columns(), const_cast<int*>(pattern.start()),
                                  const_cast<int*>(pattern.index()), -1.0, &done, match.data(), work.data());
    return {size, cpu_seconds() - begin};
  }
  std::pair<int, double> components() const {
    const double begin = cpu_seconds();
    const auto c = strong_components(pattern);
    return {c.count, cpu_seconds() - begin};
  }
  std::pair<int, double> components_btf() const {
    const auto n = static_cast<std::size_t>(pattern.columns());
    std::vector<int> order(n);
    std::vector<int> start(n + 1);
    std::vector<int> work(4 * n);
    const double begin = cpu_seconds();
    const int count =
        btf_strongcomp(pattern.columns(), const_cast<int*>(pattern.start()),
                       const_cast<int*>(pattern.index()), nullptr, order.data(), start.data(), work.data());
    return {count, cpu_seconds() - begin};
  }
  /// (rank, rows of the horizontal part, columns of it, rows of the vertical part, fine square blocks),
  /// seconds
  std::pair<std::vector<int>, double> decomposition() const {
    const double begin = cpu_seconds();
    const auto d = dulmage_mendelsohn(pattern);
    const double end = cpu_seconds();
    return {{d.structural_rank(), static_cast<int>(d.hor_rows.size()), static_cast<int>(d.hor_cols.size()),
             static_cast<int>(d.ver_rows.size()), d.blocks()},
            end - begin};
  }
  std::pair<std::vector<int>, double> decomposition_cs() const {
    cs_di A = view(pattern);
    const double begin = cpu_seconds();
    cs_did* d = cs_di_dmperm(&A, 0);
    const double end = cpu_seconds();
    // rr, cc: coarse boundaries. Its fine blocks count the horizontal and the vertical part as one each.
    const int vertical = d->rr[4] - d->rr[2];
    const bool has_hor = d->cc[2] > 0;
    const bool has_ver = vertical > 0;
    const int blocks = d->nb - (has_hor ? 1 : 0) - (has_ver ? 1 : 0);
    std::vector<int> found{d->rr[3], d->rr[1], d->cc[2], vertical, blocks};
    cs_di_dfree(d);
    return {found, end - begin};
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
      .def("matching", &Instance::matching)
      .def("matching_cs", &Instance::matching_cs)
      .def("matching_btf", &Instance::matching_btf)
      .def("components", &Instance::components)
      .def("components_btf", &Instance::components_btf)
      .def("decomposition", &Instance::decomposition)
      .def("decomposition_cs", &Instance::decomposition_cs);
  m.def("coupled_riccati", &riccati, py::arg("A"), py::arg("C"), py::arg("W"), py::arg("U"));
}
