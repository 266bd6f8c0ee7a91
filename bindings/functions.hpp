// SPDX-License-Identifier: Apache-2.0
// A nonlinear plant by Python functions.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "garrison/core/model.hpp"
#include "garrison/drivers/nonlinear.hpp"

/// From {"f": .., "h": .., "h_jacobian": .. or None, "linear": numbers of outputs}; empty = null. They are
/// called under the lock, by one thread at a time, with a row per agent. What they return is read in every
/// shape that says whose a number is; what they raise passes, with a note. `model`, which says the sizes,
/// outlives it.
std::shared_ptr<const garrison::Nonlinear> functions_of(const pybind11::dict& given,
                                                        const garrison::Model& model);
