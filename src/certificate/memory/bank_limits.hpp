// SPDX-License-Identifier: Apache-2.0
// What a member of a bank knows so little of that arithmetic would no longer tell it from what it knows well.
// Internal.
#pragma once

#include "garrison/certificate/memory/bank.hpp"

namespace garrison::certificate::detail {

/// Directions in which a member's error may be a million of the deviations in which rows see them become
/// free: nothing is known there. Does not read data. room, other: n numbers each.
void forget_unknown(BankMember& member, const Vector& weight, Vector& room, Vector& other) noexcept;

}  // namespace garrison::certificate::detail
