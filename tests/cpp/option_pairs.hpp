// SPDX-License-Identifier: Apache-2.0
// The options of a family from its described parameters, two by two.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "garrison/core/params.hpp"

namespace garrison::test {

/// Values to try, by the parameter's name; switches and choices are tried in all their values, other
/// parameters that are not named with their default and a number beside it.
using OptionValues = std::map<std::string, std::vector<ParamValue>>;

/// A number in the range of a parameter that is not its default.
inline double beside_default(const ParamInfo& info, double initial) {
  const double more = (std::isnan(initial) ? std::max(info.least, 0.0) : initial) + 1.0;
  if (more <= info.most) return more;
  const double middle = (std::max(info.least, info.most - 1.0) + info.most) / 2.0;
  return middle != initial ? middle : (middle + info.most) / 2.0;
}

inline std::vector<ParamValue> values_of(const ParamInfo& info, const OptionValues& known) {
  if (std::holds_alternative<bool>(info.initial)) return {false, true};
  if (!info.choices.empty()) return {info.choices.begin(), info.choices.end()};
  if (const auto entry = known.find(info.name); entry != known.end()) return entry->second;
  if (const auto* number = std::get_if<double>(&info.initial))
    return {*number, beside_default(info, *number)};
  if (const auto* whole = std::get_if<std::int64_t>(&info.initial))
    return {*whole, static_cast<std::int64_t>(beside_default(info, static_cast<double>(*whole)))};
  return {info.initial};
}

/// Combinations that hold every pair of values of every two parameters, the others at `base`; and `base`. Of
/// one parameter alone: each of its values.
inline std::vector<ParamMap> option_pairs(const std::vector<ParamInfo>& params, const ParamMap& base,
                                          const OptionValues& known) {
  std::vector<ParamMap> all{base};
  if (params.size() == 1)
    for (const ParamValue& x : values_of(params.front(), known)) all.push_back({{params.front().name, x}});
  for (std::size_t a = 0; a < params.size(); ++a)
    for (std::size_t b = a + 1; b < params.size(); ++b)
      for (const ParamValue& x : values_of(params[a], known))
        for (const ParamValue& y : values_of(params[b], known)) {
          ParamMap one = base;
          one.insert_or_assign(params[a].name, x);
          one.insert_or_assign(params[b].name, y);
          all.push_back(std::move(one));
        }
  return all;
}

inline std::string shown(const ParamMap& params) {
  std::string out;
  for (const auto& [name, value] : params) {
    out += name + "=";
    if (const auto* b = std::get_if<bool>(&value)) out += *b ? "true " : "false ";
    if (const auto* i = std::get_if<std::int64_t>(&value)) out += std::to_string(*i) + " ";
    if (const auto* d = std::get_if<double>(&value)) out += text(*d) + " ";
    if (const auto* s = std::get_if<std::string>(&value)) out += *s + " ";
    if (const auto* v = std::get_if<std::vector<double>>(&value))
      out += "[" + std::to_string(v->size()) + "] ";
  }
  return out;
}

}  // namespace garrison::test
