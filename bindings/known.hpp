// SPDX-License-Identifier: Apache-2.0
// What is known of a plant besides its model, as Python hands it over.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "garrison/core/series.hpp"

/// A dict of arrays (T, rows, columns) by the names of Series; empty = null.
std::shared_ptr<const garrison::Series> series_of(const pybind11::dict& given);
