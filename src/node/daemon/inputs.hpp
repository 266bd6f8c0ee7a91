// SPDX-License-Identifier: Apache-2.0
// Known inputs of the plant, all of them before the run begins: an agent does not know them (docs/adr/0016).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "garrison/engine/agent.hpp"

namespace garrison::node {

/// s(t+1) = A s(t) + B u(t), s(0) = 0, as a table. Agents get y - C s, and what they estimate plus s is of
/// the plant, so all nodes must have the same inputs. Nothing is allocated after construction. Threads: any
/// number.
class Inputs {
 public:
  /// Of a plant without inputs.
  Inputs() = default;
  /// `path`: a CSV file, row t leads from sample t to t + 1, from t = 0 on. `part` outlives this.
  /// @throws IoError, InvalidInput
  Inputs(const std::string& path, const AgentPart& part);

  bool empty() const noexcept { return part_ == nullptr; }
  /// The last sample that they lead to.
  std::int64_t last() const noexcept { return empty() ? INT64_MAX : rows_; }
  /// Takes C s from a measurement of the plant; all is missing where s is not known.
  void without(std::int64_t sample, std::span<double> y) const noexcept;
  /// Makes an estimate one of the plant; nan where s is not known.
  void add(std::int64_t sample, std::span<double> x) const noexcept;
  /// u(sample - 1), which led to this sample; empty where there is none.
  std::span<const double> before(std::int64_t sample) const noexcept;
  /// All of them, row by row: what nodes must have in common.
  std::span<const double> numbers() const noexcept { return u_; }

 private:
  /// n numbers, or none.
  std::span<const double> response(std::int64_t sample) const noexcept;

  const AgentPart* part_ = nullptr;
  std::int64_t rows_ = 0;
  std::vector<double> u_;  // row by row
  std::vector<double> s_;  // n numbers a sample, from sample 0 on
};

}  // namespace garrison::node
