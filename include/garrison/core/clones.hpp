// SPDX-License-Identifier: Apache-2.0
// One kernel source, compiled for several instruction sets, picked when the program is loaded.
#pragma once

#define GARRISON_INLINE __attribute__((always_inline)) inline

// Sanitizers instrument the resolver, which runs before they are ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GARRISON_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GARRISON_CLONES
#endif
