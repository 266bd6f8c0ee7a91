// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/machine.hpp"

#include <sys/sysinfo.h>
#include <sys/timex.h>

#include <fstream>
#include <utility>

#include "garrison/core/error.hpp"
#include "garrison/core/types.hpp"

namespace garrison::node {

namespace {
constexpr const char* kExpected = "\"load\", \"clock\", \"temp:zoneN\" or \"net:INTERFACE\"";
constexpr std::string_view kZone = "temp:zone", kNet = "net:";

/// Whether a name from the settings may be a part of a path.
bool plain(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}
bool known(std::string_view name) {
  if (name == "load" || name == "clock") return true;
  if (name.starts_with(kZone))
    return name.size() > kZone.size() &&
           name.find_first_not_of("0123456789", kZone.size()) == std::string_view::npos;
  return name.starts_with(kNet) && plain(name.substr(kNet.size()));
}

double number_in(const std::string& path) {
  double value = 0;
  return std::ifstream(path) >> value ? value : kNaN;
}
double load() {
  struct sysinfo found{};
  return ::sysinfo(&found) == 0 ? static_cast<double>(found.loads[0]) / (1 << SI_LOAD_SHIFT) : kNaN;
}
double clock_offset() {
  timex found{};
  if (::adjtimex(&found) < 0) return kNaN;
  return static_cast<double>(found.offset) / ((found.status & STA_NANO) != 0 ? 1000.0 : 1.0);
}
}  // namespace

Machine::Machine(const std::string& which, std::vector<std::string> names)
    : names_(std::move(names)), totals_(names_.size()) {
  if (names_.empty()) refuse(which, "nothing", std::string("a list of ") + kExpected + ", one per output");
  for (const std::string& name : names_)
    if (!known(name)) refuse(which, "\"" + name + "\"", kExpected);
}

void Machine::read(Micros steady, std::span<double> y) {
  for (std::size_t k = 0; k < std::min(names_.size(), y.size()); ++k) y[k] = value(k, steady);
}

double Machine::value(std::size_t k, Micros steady) {
  const std::string& name = names_[k];
  if (name == "load") return load();
  if (name == "clock") return clock_offset();
  if (name.starts_with(kZone))
    return number_in("/sys/class/thermal/thermal_zone" + name.substr(kZone.size()) + "/temp") / 1000;
  return rate(k, number_in("/sys/class/net/" + name.substr(kNet.size()) + "/statistics/rx_bytes"), steady);
}

/// Per second, since the last reading.
double Machine::rate(std::size_t k, double total, Micros steady) {
  const Total before = std::exchange(totals_[k], {total, steady});
  const auto passed = static_cast<double>(steady - before.at) / 1e6;
  return before.at >= 0 && passed > 0 ? (total - before.count) / passed : kNaN;
}

}  // namespace garrison::node
