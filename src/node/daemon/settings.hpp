// SPDX-License-Identifier: Apache-2.0
// node.toml: what one node is told.
#pragma once

#include <string>
#include <vector>

#include "node/daemon/udp.hpp"

namespace garrison::node {

struct SensorSettings {
  enum class Source { none, lines, udp, file, procfs, socket };
  Source source = Source::none;
  std::string command;            ///< lines: run by a shell; else `path`
  std::string path;               ///< lines: "-" or a named pipe; file: CSV, a row a sample, from sample 1 on
  Address address;                ///< udp
  std::vector<std::string> read;  ///< procfs: names, as in machine.hpp
  std::vector<double> scale, offset, least, most;
  std::int64_t max_age = 500'000;  ///< microseconds
};

struct Settings {
  std::string file;  ///< node.toml itself
  std::string name;
  std::string part;
  std::string roster;
  std::string key;
  Address listen;
  SensorSettings sensor;
  std::string inputs;  ///< CSV, a row a sample, from sample 0 on; empty = none
  bool require_synchronised = true;
  bool log_inputs = true;
  std::string log_folder;
  std::int64_t log_bytes = 64 << 20;
  int log_files = 4;
  std::string state_folder;
  std::int64_t state_every = 60'000'000;  ///< microseconds
  std::string socket;                     ///< empty = none
  int receive_buffer = 1024 << 10;
};

/// Paths in it are relative to the file. @throws IoError, InvalidInput
Settings read_settings(const std::string& path);
Settings parse_settings(const std::string& text, const std::string& path);

}  // namespace garrison::node
