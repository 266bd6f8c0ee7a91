// SPDX-License-Identifier: Apache-2.0
// A node's log: an MCAP file (mcap.dev, version 0, without chunks and index) that begins with the agent's
// part of the design and goes on with every call that changed the agent. Cut anywhere, it is read up to its
// last whole record.
//
//   attachment "part"      the agent's part of the design
//   channel 1 "calls"      garrison-journal-1: node/journal.hpp, one entry a message
//   channel 2 "samples"    json: the end of a sample, for people and plots
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "garrison/core/error.hpp"
#include "garrison/node/journal.hpp"

namespace garrison::node {

/// Threads: one at a time.
class GARRISON_EXPORT LogWriter {
 public:
  /// @throws IoError
  LogWriter(const std::string& path, std::string_view node, Bytes part);
  LogWriter(LogWriter&&) noexcept = default;
  LogWriter& operator=(LogWriter&&) noexcept = default;
  /// Writes the end of the file.
  ~LogWriter();

  /// `wall`: microseconds since 1970.
  void entry(Bytes entry, Micros wall) { message(1, entry, wall); }
  void sample(std::string_view json, Micros wall);
  void flush() noexcept;
  std::int64_t bytes() const noexcept { return bytes_; }
  /// Writes that failed; after the first one the file does not grow.
  std::int64_t failed() const noexcept { return failed_; }

 private:
  void message(std::uint16_t channel, Bytes data, Micros wall);
  void record(std::uint8_t code, Bytes content);
  void write(Bytes bytes) noexcept;

  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<std::byte> room_;
  std::uint32_t sequence_ = 0;
  std::int64_t bytes_ = 0;
  std::int64_t failed_ = 0;
};

/// What came of a log.
struct LogReplay {
  int agent = 0;
  std::string family;
  std::int64_t calls = 0;
  std::int64_t estimates = 0;  ///< compared with those of the log
  std::int64_t wrong = 0;      ///< of them that differ in a bit, and calls that were refused this time
  std::int64_t first = 0;      ///< sample of the first estimate; 0 and 0 where there is none
  std::int64_t last = 0;
  bool ended = false;  ///< the file has its end: the node was stopped, not killed
};

/// Makes the agent of a part; null when it is none.
using AgentMaker = std::function<std::unique_ptr<Agent>(Bytes part)>;

/// Does again what a log says. @throws InvalidInput when the file is no log of a node
GARRISON_EXPORT LogReplay replay_log(Bytes file, const AgentMaker& make);
/// The same with the whole library: any family, with its certificate.
GARRISON_EXPORT LogReplay replay_log(Bytes file);

}  // namespace garrison::node
