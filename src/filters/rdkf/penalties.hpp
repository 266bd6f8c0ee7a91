// SPDX-License-Identifier: Apache-2.0
// Names of the penalties.
#pragma once

#include <string>

#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {
Penalty penalty_named(const std::string& name);
}
