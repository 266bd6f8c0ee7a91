// SPDX-License-Identifier: Apache-2.0
#define GARRISON_SOLVERS
#include "solvers.hpp"
