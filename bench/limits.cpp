// SPDX-License-Identifier: Apache-2.0
// What the machine gives in the same run: multiply-add rate and memory bandwidth of one thread.
#include <vector>

#include "bench.hpp"

namespace {

volatile double sink = 0.0;

double multiply_add_gflops() {
  double a[32];
  for (int k = 0; k < 32; ++k) a[k] = 1.0 + k * 1e-3;
  constexpr int kRepeats = 4'000'000;
  const double start = cpu_seconds();
  for (int r = 0; r < kRepeats; ++r)
    for (double& v : a) v = v * 0.999999 + 1e-6;
  const double seconds = cpu_seconds() - start;
  for (const double v : a) sink = sink + v;
  return 2.0 * 32 * kRepeats / seconds * 1e-9;
}

double triad_gigabytes(std::size_t bytes) {
  const std::size_t n = bytes / 24;
  std::vector<double> a(n, 1.0);
  std::vector<double> b(n, 2.0);
  std::vector<double> c(n, 3.0);
  const auto repeats = static_cast<int>(std::max<std::size_t>(1, 400'000'000 / bytes));
  const double start = cpu_seconds();
  for (int r = 0; r < repeats; ++r) {
    for (std::size_t k = 0; k < n; ++k) a[k] = b[k] + 1.0001 * c[k];
    sink = a[n / 2];
  }
  return static_cast<double>(bytes) * repeats / (cpu_seconds() - start) * 1e-9;
}

}  // namespace

void bind_limits(py::module_& m) {
  m.def("multiply_add_gflops", &multiply_add_gflops);
  m.def("triad_gigabytes", &triad_gigabytes, py::arg("bytes"));
}
