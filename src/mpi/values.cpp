// SPDX-License-Identifier: Apache-2.0
#include "mpi/values.hpp"

#include <cmath>

#include "garrison/core/error.hpp"

namespace garrison::mpi {

int whole(const Section& s, const char* key, int least, std::optional<std::int64_t> otherwise) {
  return static_cast<int>(s.whole(key, least, kMost, otherwise));
}

int agent_of(const Section& s, const char* key, double value) {
  if (!(value >= 0.0 && value <= kMost && value == std::floor(value)))
    refuse(s.where(key), text(value), "whole numbers of agents, from 0");
  return static_cast<int>(value);
}

ParamMap params_of(const Section& s, std::span<const ParamInfo> infos, std::vector<std::string> others) {
  ParamMap params;
  for (const ParamInfo& info : infos) {
    const std::string& key = info.name;
    others.push_back(key);
    if (!s.has(key)) continue;
    if (std::holds_alternative<bool>(info.initial)) params[key] = s.flag(key, false);
    if (std::holds_alternative<std::int64_t>(info.initial)) params[key] = s.whole(key, -kMost, kMost);
    if (std::holds_alternative<double>(info.initial)) params[key] = s.number(key, -kInfinity, kInfinity);
    if (std::holds_alternative<std::string>(info.initial)) params[key] = s.text(key);
    if (std::holds_alternative<std::vector<double>>(info.initial)) params[key] = s.numbers(key);
  }
  s.only(others);
  return params;
}

Matrix matrix(const Section& s, const char* key, std::size_t columns) {
  const auto rows = s.rows(key);
  Matrix M(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].size() != columns)
      refuse(s.where(key), "a row of " + amount(rows[r].size(), "number"),
             amount(columns, "number") + " in every row");
    for (std::size_t c = 0; c < columns; ++c)
      M(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
  }
  return M;
}

Vector vector(const Section& s, const char* key, int states) {
  const auto numbers = s.numbers(key);
  if (!numbers.empty() && static_cast<int>(numbers.size()) != states)
    refuse(s.where(key), amount(numbers.size(), "number"), std::to_string(states) + ", one per state");
  return Eigen::Map<const Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

}  // namespace garrison::mpi
