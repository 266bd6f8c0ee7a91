// SPDX-License-Identifier: Apache-2.0
// Attacks whose lies come from a Python function.
#pragma once

#include "bindings.hpp"

namespace own {

/// "custom" calls function(t, agent, y, rng), "custom_message" function(t, round, sender, receiver, message,
/// rng); see garrison.attacks.
garrison::AnyAttack attack(const std::string& name, garrison::Schedule schedule, py::object function);
bool is_own(const garrison::AnyAttack& attack);
py::object function_of(const garrison::AnyAttack& attack);

}  // namespace own
