// SPDX-License-Identifier: Apache-2.0
#include "garrison/engine/design_file.hpp"
#include "garrison/node/log.hpp"

namespace garrison::node {

LogReplay replay_log(Bytes file) {
  return replay_log(file, [](Bytes part) { return read_part(part); });
}

}  // namespace garrison::node
