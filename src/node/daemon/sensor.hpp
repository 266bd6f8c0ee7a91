// SPDX-License-Identifier: Apache-2.0
// Where measurements come from: lines of a program or pipe, datagrams, a table, the machine itself, or local
// clients.
#pragma once

#include <atomic>
#include <optional>
#include <string_view>

#include "node/daemon/machine.hpp"
#include "node/daemon/reading.hpp"
#include "node/daemon/settings.hpp"

namespace garrison::node {

/// "[@unix_seconds] y1 y2 ...", with nan for what is missing.
struct SensorLine {
  std::vector<double> y;
  std::optional<Micros> taken;
};
/// Nothing unless there are exactly `outputs` numbers.
std::optional<SensorLine> parse_line(std::string_view line, std::size_t outputs);

class Sensor {
 public:
  struct Counters {
    std::int64_t taken = 0;      ///< lines, readings, rows of a table that a sample came to
    std::int64_t malformed = 0;  ///< lines
    std::int64_t outside = 0;    ///< numbers beyond least or most: missing
    std::int64_t restarts = 0;   ///< of the command, or of a pipe that ended
  };

  /// @throws InvalidInput, IoError: limits of another size, a file that does not fit
  Sensor(const SensorSettings& settings, std::size_t outputs, const std::string& file);
  ~Sensor();
  Sensor(const Sensor&) = delete;
  Sensor& operator=(const Sensor&) = delete;

  /// The loop's: the measurement for sample `sample`, which begins now.
  void measure(std::int64_t sample, Micros now, std::span<double> y) const noexcept;

  /// The other thread's, from here on. What to wait for, or -1; and what to do when it can be read.
  int descriptor() const noexcept { return input_.get(); }
  void readable(Micros now);
  /// Starts the command or opens the pipe again, with growing pauses.
  void tick(Micros steady);
  void line(std::string_view text, Micros now);
  bool takes_lines_from_clients() const noexcept {
    return settings_.source == SensorSettings::Source::socket;
  }
  Counters counters() const noexcept;

 private:
  void prepare(std::span<double> y) noexcept;
  void take(std::span<double> y, Micros taken) noexcept;
  void read_machine(Micros steady);
  void open();
  std::string what() const;
  void ended();
  void close();
  void start_command();
  void read_table();

  SensorSettings settings_;
  std::size_t outputs_;
  Reading reading_;
  std::vector<double> table_;
  std::optional<Machine> machine_;
  Descriptor input_;
  bool failing_ = false;  ///< it cannot be opened, or its command ends: said once
  int child_ = -1;
  std::string pending_;
  Micros open_at_ = 0;
  Micros pause_ = 0;
  bool opened_ = false;
  Counters counters_;
  mutable std::atomic<std::int64_t> rows_taken_{0};  ///< of the table, by the loop
};

}  // namespace garrison::node
