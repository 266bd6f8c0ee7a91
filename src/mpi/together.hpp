// SPDX-License-Identifier: Apache-2.0
// What goes wrong on one rank is known to all before any of them waits for it.
#pragma once

#include <mpi.h>

#include <exception>
#include <string>

#include "garrison/core/error.hpp"

namespace garrison::mpi {

/// Ends with InvalidInput on all ranks, with the message of the first that failed, where `failure` of any is
/// not empty. All ranks call it.
void agree(const std::string& failure);

/// Runs `work`, which may not communicate, on every rank; `agree`s on how it ended.
template <class Work>
void together(const Work& work) {
  std::string failure;
  try {
    work();
  } catch (const std::exception& error) {
    failure = error.what();
    if (failure.empty()) failure = "an error without a message";
  }
  agree(failure);
}

}  // namespace garrison::mpi
