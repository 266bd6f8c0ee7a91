// SPDX-License-Identifier: Apache-2.0
// Small matrices laid out for products with one vector: columns padded to whole groups of eight rows.
#pragma once

#include <algorithm>

#include "garrison/core/types.hpp"
#include "garrison/kernel/aligned.hpp"
#include "garrison/kernel/block.hpp"
#include "garrison/kernel/isa.hpp"

namespace garrison::rdkf {

/// Sums run over this many lanes, however wide a register is, so that the bits do not depend on the machine.
inline constexpr int kGroup = 8;

constexpr int padded(Eigen::Index rows) { return static_cast<int>((rows + kGroup - 1) / kGroup) * kGroup; }

/// rows x columns, column by column, every column on a cache line and filled up with zeros.
struct Packed {
  int rows = 0;
  int columns = 0;
  int height = 0;  ///< padded rows
  Aligned<double> values;

  Packed() = default;
  explicit Packed(const MatrixRef& m)
      : rows(static_cast<int>(m.rows())),
        columns(static_cast<int>(m.cols())),
        height(padded(m.rows())),
        values(static_cast<std::size_t>(height) * static_cast<std::size_t>(columns), 0.0) {
    for (int c = 0; c < columns; ++c) std::copy_n(m.col(c).eval().data(), rows, values.data() + c * height);
  }
  template <class V>
  void visit(V& v) {
    v.range("rows", rows, 0, 65535);
    v.range("columns", columns, 0, 65535);
    v.range("height", height, 0, 65535 + kGroup);
    v("values", values);
  }
  Matrix dense() const { return Eigen::Map<const Matrix>(values.data(), height, columns).topRows(rows); }
};

/// Eight doubles as the vectors of this machine hold them.
template <int B>
struct Lanes {
  static constexpr int parts = kGroup / B;
  using type = typename Block<B>::type;
  type part[std::size_t{parts}];

  static GARRISON_INLINE Lanes all(double value) {
    Lanes out;
    for (int p = 0; p < parts; ++p) out.part[p] = type{} + value;
    return out;
  }
  static GARRISON_INLINE Lanes at(const double* x) {
    Lanes out;
    for (int p = 0; p < parts; ++p) out.part[p] = *Block<B>::of(x + p * B);
    return out;
  }
  GARRISON_INLINE void to(double* x) const {
    for (int p = 0; p < parts; ++p) *Block<B>::of(x + p * B) = part[p];
  }
  /// this += a * b
  GARRISON_INLINE void add(const Lanes& a, const Lanes& b) {
    for (int p = 0; p < parts; ++p) part[p] += a.part[p] * b.part[p];
  }
  GARRISON_INLINE double sum() const {
    double x[kGroup];
    to(x);
    return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
  }
};

/// out = M x; out has M.height entries. Columns in two chains, each in order.
template <int B>
GARRISON_INLINE void product(const Packed& M, const double* x, double* out) {
  using L = Lanes<B>;
  const double* column = M.values.data();
  const int height = M.height;
  const int columns = M.columns;
  for (int r = 0; r < height; r += kGroup) {
    L even = L::all(0.0);
    L odd = L::all(0.0);
    int c = 0;
    for (; c + 1 < columns; c += 2) {
      even.add(L::at(column + c * height + r), L::all(x[c]));
      odd.add(L::at(column + (c + 1) * height + r), L::all(x[c + 1]));
    }
    if (c < columns) even.add(L::at(column + c * height + r), L::all(x[c]));
    for (int p = 0; p < L::parts; ++p) even.part[p] += odd.part[p];
    even.to(out + r);
  }
}

}  // namespace garrison::rdkf
