// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <ctime>

namespace py = pybind11;

/// Seconds of processor time of this thread: other jobs on the machine do not count.
inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void bind_limits(py::module_& m);
void bind_consensus(py::module_& m);
void bind_certificate(py::module_& m);
void bind_memory(py::module_& m);
void bind_lambda0(py::module_& m);
void bind_rdkf_peers(py::module_& m);
void bind_structure(py::module_& m);
void bind_partial_sharing(py::module_& m);
