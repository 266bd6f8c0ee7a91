// SPDX-License-Identifier: Apache-2.0
// What a check returns: conditions and bounds are data, also when they fail.
#pragma once

#include <string>
#include <vector>

#include "garrison/core/types.hpp"

namespace garrison {

/// One condition of a theorem: `value` must be `needed` (a relation such as "> 3").
struct Condition {
  std::string name;  ///< e.g. "lambda_0 > s (11)"
  double value;
  std::string needed;
  bool holds;
  std::string meaning;   ///< one line for people
  bool required = true;  ///< false: only sharpens the result, the main promise does not need it
};

/// One number that the analysis gives; NaN = does not exist here, `meaning` says why.
struct Quantity {
  std::string name;
  double value;
  std::string meaning;
};

/// Result of checking a filter against a model and a network.
struct Check {
  std::vector<Condition> conditions;
  std::vector<Quantity> quantities;  ///< constants and bounds
  /// All required conditions hold.
  bool holds() const {
    for (const auto& c : conditions)
      if (c.required && !c.holds) return false;
    return true;
  }
};

}  // namespace garrison
