// SPDX-License-Identifier: Apache-2.0
// Parameters described once. The Python constructors, the scenario reader, the range checks and
// `garrison list` all derive from the `fields` tuple of a Params struct.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison {

using ParamValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;
using ParamMap = std::map<std::string, ParamValue, std::less<>>;

/// What a person needs to know of one parameter.
struct GARRISON_EXPORT ParamInfo {
  std::string name = {};
  std::string symbol = {};  ///< letter of the paper
  std::string unit = {};
  std::string doc = {};
  ParamValue initial = {};    ///< default; NaN = "not given"
  bool required = false;      ///< has no sensible default
  double least = -kInfinity;  ///< range of numbers
  double most = kInfinity;
  bool open = false;                      ///< `least` itself is excluded
  std::vector<std::string> choices = {};  ///< admissible texts
};

/// One member of a Params struct with its description (the default is the member's initialiser).
template <class P, class T>
struct Field {
  T P::* member;
  ParamInfo info;
};

template <class P, class T>
Field<P, T> field(T P::* member, ParamInfo info) {
  info.initial = P{}.*member;
  return {member, std::move(info)};
}

/// @throws InvalidInput always: a required parameter that was not given
[[noreturn]] GARRISON_EXPORT void refuse_absent(const std::string& owner, const ParamInfo& info);
/// Checks one value against its description; `owner` names the filter or attack in the message.
GARRISON_EXPORT void check_param(const std::string& owner, const ParamInfo& info, const ParamValue& value);
/// Refuses numbers of a filter that are finite and beyond kHuge: nothing that is made of them is a number.
GARRISON_EXPORT void require_no_huge(const std::string& owner, const ParamMap& params);
/// The known name closest to `unknown` (edit distance); empty when nothing is near.
GARRISON_EXPORT std::string nearest_name(const std::string& unknown, std::span<const std::string> known);
/// Refuses a parameter that `owner` does not have, with the nearest name and all names.
[[noreturn]] GARRISON_EXPORT void refuse_unknown(const std::string& owner, const std::string& name,
                                                 std::span<const std::string> known);
/// Converts between whole numbers and numbers where nothing is lost; refuses other types.
GARRISON_EXPORT ParamValue convert_param(const std::string& owner, const ParamInfo& info,
                                         const ParamValue& value);

namespace detail {
template <class T>
using Stored = std::conditional_t<std::is_same_v<T, int>, std::int64_t, T>;

template <class P, class Visit>
void each_field(Visit&& visit) {
  static const auto all = P::fields();
  std::apply([&](const auto&... one) { (visit(one), ...); }, all);
}
}  // namespace detail

/// Descriptions of all parameters of P.
template <class P>
std::vector<ParamInfo> describe() {
  std::vector<ParamInfo> all;
  detail::each_field<P>([&](const auto& one) { all.push_back(one.info); });
  return all;
}

/// The present values, by name.
template <class P>
ParamMap values(const P& params) {
  ParamMap all;
  detail::each_field<P>([&](const auto& one) {
    using T = std::decay_t<decltype(params.*(one.member))>;
    all.emplace(one.info.name, detail::Stored<T>(params.*(one.member)));
  });
  return all;
}

/// Refuses values outside their ranges.
template <class P>
void check_params(const std::string& owner, const P& params) {
  const ParamMap all = values(params);
  for (const ParamInfo& info : describe<P>()) check_param(owner, info, all.at(info.name));
}

/// Params from names and values; refuses unknown names, missing required ones and values out of range.
template <class P>
P parse_params(const std::string& owner, const ParamMap& given) {
  std::vector<std::string> known;
  for (const ParamInfo& info : describe<P>()) known.push_back(info.name);
  for (const auto& [name, value] : given)
    if (std::find(known.begin(), known.end(), name) == known.end()) refuse_unknown(owner, name, known);
  P params;
  detail::each_field<P>([&](const auto& one) {
    const auto entry = given.find(one.info.name);
    if (entry == given.end()) {
      if (one.info.required) refuse_absent(owner, one.info);
      return;
    }
    using T = std::decay_t<decltype(params.*(one.member))>;
    params.*(one.member) =
        static_cast<T>(std::get<detail::Stored<T>>(convert_param(owner, one.info, entry->second)));
  });
  check_params(owner, params);
  return params;
}

}  // namespace garrison
