// SPDX-License-Identifier: Apache-2.0
#include "garrison/core/params.hpp"

#include <cmath>
#include <numeric>

namespace garrison {
namespace {

/// Parameters that are whole numbers are kept as int.
constexpr double kMostWhole = 2147483647.0;
/// Letters of a name from which on a longer one that holds it is meant.
constexpr std::size_t kTelling = 4;

std::string join(std::span<const std::string> names) {
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// Letters put in, left out, replaced, or exchanged with the next one, that lead from a to b.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  std::vector<std::size_t> last = row;
  std::vector<std::size_t> before = row;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

std::string type_name(const ParamValue& value) {
  constexpr const char* names[] = {"true or false", "a whole number", "a number", "a string",
                                   "a list of numbers"};
  return names[value.index()];
}

std::string shown(const ParamValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return text(*number);
  if (const auto* words = std::get_if<std::string>(&value)) return "\"" + *words + "\"";
  std::string all;
  for (const double number : std::get<std::vector<double>>(value))
    all += (all.empty() ? "" : ", ") + text(number);
  return "[" + all + "]";
}

std::string range(const ParamInfo& info) {
  std::string words = type_name(info.initial);
  if (std::isfinite(info.least)) words += (info.open ? " > " : " >= ") + text(info.least);
  if (std::isfinite(info.most))
    words += (std::isfinite(info.least) ? " and" : "") + (" <= " + text(info.most));
  return words;
}

}  // namespace

std::string nearest_name(const std::string& unknown, std::span<const std::string> known) {
  std::string best;
  std::size_t least = std::max<std::size_t>(unknown.size() / 2, 1) + 1;
  for (const auto& name : known)
    if (const auto distance = edit_distance(unknown, name); distance < least) {
      least = distance;
      best = name;
    }
  if (!best.empty() || unknown.size() < kTelling) return best;
  // kalman: the only known name with it
  const auto holds = [&](const std::string& name) { return name.find(unknown) != std::string::npos; };
  if (std::count_if(known.begin(), known.end(), holds) == 1)
    best = *std::find_if(known.begin(), known.end(), holds);
  return best;
}

void refuse_unknown(const std::string& owner, const std::string& name, std::span<const std::string> known) {
  const std::string near = nearest_name(name, known);
  refuse(owner, "unknown name \"" + name + "\"", "one of: " + join(known),
         near.empty() ? "" : "did you mean \"" + near + "\"?");
}

void refuse_absent(const std::string& owner, const ParamInfo& info) {
  refuse(owner + "." + info.name, "no value, or nan", range(info), info.doc);
}

void check_param(const std::string& owner, const ParamInfo& info, const ParamValue& value) {
  const std::string which = owner + "." + info.name;
  if (const auto* words = std::get_if<std::string>(&value)) {
    if (!info.choices.empty() &&
        std::find(info.choices.begin(), info.choices.end(), *words) == info.choices.end()) {
      const std::string near = nearest_name(*words, info.choices);
      refuse(which, shown(value), "one of: " + join(info.choices),
             near.empty() ? info.doc : "did you mean \"" + near + "\"?");
    }
    return;
  }
  if (std::holds_alternative<bool>(value)) return;
  if (const auto* list = std::get_if<std::vector<double>>(&value)) {
    for (const double number : *list)
      if (!(number >= info.least && number <= info.most)) refuse(which, shown(value), range(info), info.doc);
    return;
  }
  const double number = std::holds_alternative<double>(value)
                            ? std::get<double>(value)
                            : static_cast<double>(std::get<std::int64_t>(value));
  if (std::isnan(number)) {
    if (info.required) refuse_absent(owner, info);
    if (!std::isnan(std::get<double>(info.initial))) refuse(which, "nan", range(info), info.doc);
    return;
  }
  const bool low = info.open ? number <= info.least : number < info.least;
  if (low || number > info.most) refuse(which, shown(value), range(info), info.doc);
}

void require_no_huge(const std::string& owner, const ParamMap& params) {
  const auto look = [&](const std::string& name, double number) {
    if (std::isfinite(number) && std::abs(number) > kHuge)
      refuse(owner + "." + name, text(number), "a number of size at most " + text(kHuge));
  };
  for (const auto& [name, value] : params) {
    if (const auto* number = std::get_if<double>(&value)) look(name, *number);
    if (const auto* list = std::get_if<std::vector<double>>(&value))
      for (const double number : *list) look(name, number);
  }
}

ParamValue convert_param(const std::string& owner, const ParamInfo& info, const ParamValue& value) {
  const auto* const whole = std::get_if<std::int64_t>(&value);
  if (whole != nullptr && std::holds_alternative<std::int64_t>(info.initial) &&
      std::abs(static_cast<double>(*whole)) > kMostWhole)
    refuse(owner + "." + info.name, shown(value), "a whole number of at most 2147483647", info.doc);
  if (value.index() == info.initial.index()) return value;
  if (std::holds_alternative<double>(info.initial) && std::holds_alternative<std::int64_t>(value))
    return static_cast<double>(std::get<std::int64_t>(value));
  if (std::holds_alternative<std::int64_t>(info.initial) && std::holds_alternative<double>(value)) {
    const double number = std::get<double>(value);
    if (std::abs(number) <= kMostWhole && number == std::floor(number))
      return static_cast<std::int64_t>(number);
  }
  // A text without choices holds a number as text (the attack "constant").
  if (std::holds_alternative<std::string>(info.initial) && info.choices.empty()) {
    if (const auto* number = std::get_if<double>(&value)) return text(*number);
    if (whole != nullptr) return std::to_string(*whole);
  }
  refuse(owner + "." + info.name, shown(value), range(info), info.doc);
}

}  // namespace garrison
