// SPDX-License-Identifier: Apache-2.0
#include "garrison/version.hpp"

#include "garrison/core/abi.hpp"

const char GARRISON_ABI = 0;

namespace garrison {

std::string_view version() noexcept { return GARRISON_VERSION; }

}  // namespace garrison
