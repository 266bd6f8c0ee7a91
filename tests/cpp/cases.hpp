// SPDX-License-Identifier: Apache-2.0
// Reading reference cases and comparing with their tolerance.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "garrison/core/types.hpp"

namespace garrison::cases {

using Json = nlohmann::json;

/// `path` below tests/cases.
inline Json load_case(const std::string& path) {
  std::ifstream file(std::string(GARRISON_CASES) + "/" + path);
  REQUIRE_MESSAGE(file.good(), path);
  return Json::parse(file);
}

inline double number(const Json& j) {
  if (!j.is_string()) return j.get<double>();
  return j == "nan" ? kNaN : j == "inf" ? kInfinity : -kInfinity;
}

inline std::vector<double> numbers(const Json& j) {
  std::vector<double> all;
  for (const auto& one : j) all.push_back(number(one));
  return all;
}

/// Agreement as the cases define it: relative to the largest entry of the field; nan, inf exactly.
inline bool agree(const std::vector<double>& got, const std::vector<double>& expected,
                  double tolerance = 1e-9) {
  if (got.size() != expected.size()) return false;
  double scale = 0.0;
  for (const double e : expected)
    if (std::isfinite(e)) scale = std::max(scale, std::abs(e));
  for (std::size_t k = 0; k < got.size(); ++k) {
    if (std::isfinite(expected[k])
            ? !(std::abs(got[k] - expected[k]) <= tolerance * scale + 1e-12)
            : !(got[k] == expected[k] || (std::isnan(got[k]) && std::isnan(expected[k]))))
      return false;
  }
  return true;
}

inline bool agree(double got, const Json& expected, double tolerance = 1e-9) {
  return agree(std::vector{got}, {number(expected)}, tolerance);
}

inline Vector vector(const Json& j) {
  const std::vector<double> all = numbers(j);
  return Eigen::Map<const Vector>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Rows of numbers; `columns` where there may be no row.
inline Matrix matrix(const Json& rows, Eigen::Index columns = 0) {
  Matrix m(static_cast<Eigen::Index>(rows.size()),
           rows.empty() ? columns : static_cast<Eigen::Index>(rows[0].size()));
  for (std::size_t i = 0; i < rows.size(); ++i) m.row(static_cast<Eigen::Index>(i)) = vector(rows[i]);
  return m;
}

inline bool agree_entries(const Vector& got, const Vector& expected, double tolerance = 1e-9) {
  return agree(std::vector<double>(got.begin(), got.end()),
               std::vector<double>(expected.begin(), expected.end()), tolerance);
}

}  // namespace garrison::cases
