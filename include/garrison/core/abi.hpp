// SPDX-License-Identifier: Apache-2.0
// Programs that would free memory which Eigen took in another way do not link.
//
// Where Eigen takes its memory follows from the flags of the compiler: with -mavx or -march=native it aligns
// by 32 or 64 bytes and frees by hand, without them it does not; so does -fsanitize=address. A vector that
// the library made and the program frees is then a crash. So the name of a symbol of the library says how it
// was compiled and what to do, and every program that includes this asks for it by its own flags. What to do:
// compile the program with the flags of the library (without -mavx, -march=native), or the library with
// those of the program.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "garrison/version.hpp"

#define GARRISON_ABI_JOIN(major, minor, align, malloc, few) \
  garrison_##major##_##minor##_with_EIGEN_DEFAULT_ALIGN_BYTES_##align##_EIGEN_MALLOC_ALREADY_ALIGNED_##malloc##few##_compile_program_and_library_with_the_same_flags
#define GARRISON_ABI_EXPAND(major, minor, align, malloc, few) \
  GARRISON_ABI_JOIN(major, minor, align, malloc, few)
#ifdef GARRISON_FEW_DIMENSIONS
#define GARRISON_ABI_DIMENSIONS _and_GARRISON_FEW_DIMENSIONS
#else
#define GARRISON_ABI_DIMENSIONS
#endif
#define GARRISON_ABI                                                                             \
  GARRISON_ABI_EXPAND(GARRISON_VERSION_MAJOR, GARRISON_VERSION_MINOR, EIGEN_DEFAULT_ALIGN_BYTES, \
                      EIGEN_MALLOC_ALREADY_ALIGNED, GARRISON_ABI_DIMENSIONS)

static_assert(
    sizeof(Eigen::Index) == sizeof(std::ptrdiff_t),
    "garrison: leave EIGEN_DEFAULT_DENSE_INDEX_TYPE as it is, the library counts in std::ptrdiff_t");

extern "C" {
GARRISON_EXPORT extern const char GARRISON_ABI;
}

#ifndef GARRISON_HEADERS_ONLY  // for a program that links nothing of garrison
namespace {
[[gnu::used, gnu::retain]] const char* const garrison_abi = &GARRISON_ABI;
}
#endif
