// SPDX-License-Identifier: Apache-2.0
// All that a program usually wants of garrison::garrison. A node takes engine/part.hpp and its family alone.
#pragma once

#include "garrison/attacks/registry.hpp"
#include "garrison/core/error.hpp"
#include "garrison/core/model.hpp"
#include "garrison/core/network.hpp"
#include "garrison/drivers/simulate.hpp"
#include "garrison/engine/agent.hpp"
#include "garrison/engine/any_filter.hpp"
#include "garrison/engine/design_file.hpp"
#include "garrison/version.hpp"
