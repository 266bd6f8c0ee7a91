// SPDX-License-Identifier: Apache-2.0
// What the machine says of itself, as measurements: load, temperature, clock, traffic.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "garrison/node/bytes.hpp"

namespace garrison::node {

/// Names: "load" (average over a minute), "temp:zoneN" (degrees Celsius), "clock" (microseconds that the
/// kernel still has to correct it by), "net:IF" (bytes per second that interface IF received). Nothing of it
/// lies in /proc, which the service unit hides.
class Machine {
 public:
  /// `which`: the key, for refusals. @throws InvalidInput
  Machine(const std::string& which, std::vector<std::string> names);
  std::size_t size() const noexcept { return names_.size(); }
  /// NaN for what is not there.
  void read(Micros steady, std::span<double> y);

 private:
  double value(std::size_t k, Micros steady);
  double rate(std::size_t k, double total, Micros steady);

  struct Total {
    double count = 0;
    Micros at = -1;  ///< -1: not read yet
  };
  std::vector<std::string> names_;
  std::vector<Total> totals_;
};

}  // namespace garrison::node
