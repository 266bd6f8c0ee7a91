// SPDX-License-Identifier: Apache-2.0
// All attacks by name, with their parameters: what scenarios, bindings and `garrison list attacks` use.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "garrison/attacks/measurement.hpp"
#include "garrison/attacks/message.hpp"
#include "garrison/core/params.hpp"

namespace garrison {

/// An attack on measurements or on messages (exactly one of the two is set), and what it was made from.
struct GARRISON_EXPORT AnyAttack {
  std::string name;
  ParamMap params;  ///< all of them, defaults included
  Attack measurement;
  std::shared_ptr<const MessageAttack> message;

  const Schedule& schedule() const { return message ? message->schedule() : measurement->schedule(); }
};

struct GARRISON_EXPORT AttackInfo {
  std::string name;
  std::string target;  ///< "measurement" or "message"
  std::string doc;
  std::vector<ParamInfo> params;
  std::function<AnyAttack(Schedule, const ParamMap&)> make;
};

GARRISON_EXPORT std::span<const AttackInfo> attack_infos();
/// Refuses unknown names and parameters with the nearest known one.
GARRISON_EXPORT AnyAttack make_attack(const std::string& name, Schedule schedule, const ParamMap& params);

}  // namespace garrison
