// SPDX-License-Identifier: Apache-2.0
// The log files of a node: the next one begins where the last is full, the oldest one goes.
#pragma once

#include <optional>
#include <string>

#include "garrison/node/log.hpp"

namespace garrison::node {

class LogKeeper {
 public:
  /// Files are FOLDER/NAME-BOOT-NUMBER.mcap ("/" in the name becomes "_"); at most `files` of this name stay.
  /// @throws IoError
  LogKeeper(std::string folder, std::string name, std::uint64_t boot, std::vector<std::byte> part, int files);

  /// The next file; as it was where the disk does not take the begin of one. @throws IoError
  void begin();
  LogWriter& file() { return *file_; }
  /// The disk has taken all of the present file.
  bool whole() const noexcept { return file_->failed() == 0; }
  /// The disk has room for the begin of another one.
  bool room() const noexcept;
  const std::string& folder() const noexcept { return folder_; }
  /// Another number of files, from the next one on.
  void keep(int files) noexcept { files_ = files; }
  /// Writes that failed, of all files.
  std::int64_t failed() const noexcept { return failed_ + file_->failed(); }

 private:
  void drop_oldest() const;

  std::string folder_;
  std::string name_;
  std::uint64_t boot_;
  std::vector<std::byte> part_;
  int files_;
  int number_ = 0;
  std::optional<LogWriter> file_;
  std::int64_t failed_ = 0;
};

}  // namespace garrison::node
