// SPDX-License-Identifier: Apache-2.0
// The options of a family from its described parameters, two by two.
#pragma once

#include <doctest/doctest.h>

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "garrison/core/params.hpp"

namespace garrison::test {

/// Values to try, by the parameter's name; switches and choices are tried in all their values.
using OptionValues = std::map<std::string, std::vector<ParamValue>>;

inline std::vector<ParamValue> values_of(const ParamInfo& info, const OptionValues& known) {
  if (std::holds_alternative<bool>(info.initial)) return {false, true};
  if (!info.choices.empty()) return {info.choices.begin(), info.choices.end()};
  const auto entry = known.find(info.name);
  if (entry == known.end()) FAIL("say which values of \"" << info.name << "\" are tried");
  return entry->second;
}

/// Combinations that hold every pair of values of every two parameters, the others at `base`; and `base`.
inline std::vector<ParamMap> option_pairs(const std::vector<ParamInfo>& params, const ParamMap& base,
                                          const OptionValues& known) {
  std::vector<ParamMap> all{base};
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
