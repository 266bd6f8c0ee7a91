// SPDX-License-Identifier: Apache-2.0
// Values of a scenario that several of its sections have.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/params.hpp"
#include "garrison/core/types.hpp"
#include "node/daemon/toml_file.hpp"

namespace garrison::mpi {

using node::Section;

inline constexpr int kMost = std::numeric_limits<int>::max();

// All of them @throw InvalidInput with file, line and key.

int whole(const Section& s, const char* key, int least, std::optional<std::int64_t> otherwise = {});
/// The number of an agent.
int agent_of(const Section& s, const char* key, double value);
/// Empty, or a number per state.
Vector vector(const Section& s, const char* key, int states);
Matrix matrix(const Section& s, const char* key, std::size_t columns);
/// What the library refuses without knowing the file is told with its place there.
template <class Make>
auto placed(const Section& s, const char* key, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw InvalidInput(s.where(key) + ": " + error.what());
  }
}
/// Values of a filter or an attack; every key that is no parameter has to be in `others`.
ParamMap params_of(const Section& s, std::span<const ParamInfo> infos, std::vector<std::string> others);

}  // namespace garrison::mpi
