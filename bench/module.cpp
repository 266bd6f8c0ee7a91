// SPDX-License-Identifier: Apache-2.0
#include "bench.hpp"

PYBIND11_MODULE(garrison_bench, m) {
  m.doc() = "Our kernels and their C++ peers, timed inside one process.";
  bind_limits(m);
  bind_consensus(m);
  bind_certificate(m);
  bind_memory(m);
  bind_lambda0(m);
  bind_rdkf_peers(m);
  bind_structure(m);
  bind_partial_sharing(m);
}
