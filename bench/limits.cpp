// SPDX-License-Identifier: Apache-2.0
// What the machine gives in the same run: multiply-add rate and memory bandwidth of one thread.
#include <algorithm>

#include "bench.hpp"
#include "garrison/kernel/aligned.hpp"

namespace {

// The widest registers that this machine has, whatever the rest was compiled for.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WIDEST
#endif

volatile double sink = 0.0;

WIDEST double multiply_add_gflops() {
  constexpr int kLength = 128;
  double a[kLength];
  for (int k = 0; k < kLength; ++k) a[k] = 1.0 + k * 1e-3;
  constexpr int kRepeats = 2'000'000;
  const double start = cpu_seconds();
  for (int r = 0; r < kRepeats; ++r)
    for (double& v : a) v = __builtin_fma(v, 0.999999, 1e-6);
  const double seconds = cpu_seconds() - start;
  for (const double v : a) sink = sink + v;
  return 2.0 * kLength * kRepeats / seconds * 1e-9;
}

WIDEST void triad(double* a, const double* b, const double* c, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) a[k] = b[k] + 1.0001 * c[k];
}

double triad_gigabytes(std::size_t bytes) {
  const std::size_t n = bytes / 24;
  garrison::Aligned<double> a(n, 1.0);
  garrison::Aligned<double> b(n, 2.0);
  garrison::Aligned<double> c(n, 3.0);
  const auto repeats = static_cast<int>(std::max<std::size_t>(1, 400'000'000 / bytes));
  const double start = cpu_seconds();
  for (int r = 0; r < repeats; ++r) {
    triad(a.data(), b.data(), c.data(), n);
    sink = a[n / 2];
  }
  return static_cast<double>(bytes) * repeats / (cpu_seconds() - start) * 1e-9;
}

}  // namespace

void bind_limits(py::module_& m) {
  m.def("multiply_add_gflops", &multiply_add_gflops);
  m.def("triad_gigabytes", &triad_gigabytes, py::arg("bytes"));
}
