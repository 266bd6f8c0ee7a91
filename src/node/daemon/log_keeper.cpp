// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/log_keeper.hpp"

#include <algorithm>
#include <filesystem>

#include "garrison/core/error.hpp"
#include "node/daemon/files.hpp"

namespace garrison::node {

namespace {
constexpr std::uintmax_t kLeastRoom = 1 << 18;

/// With zeros in front, so that names are in the order of time.
std::string padded(std::uint64_t number, std::size_t digits) {
  const std::string text = std::to_string(number);
  return std::string(digits - std::min(digits, text.size()), '0') + text;
}
}  // namespace

LogKeeper::LogKeeper(std::string folder, std::string name, std::uint64_t boot, std::vector<std::byte> part,
                     int files)
    : folder_(std::move(folder)), name_(std::move(name)), boot_(boot), part_(std::move(part)), files_(files) {
  std::replace(name_.begin(), name_.end(), '/', '_');
  make_folder(folder_);
  begin();
}

void LogKeeper::begin() {
  const std::string file =
      name_ + "-" + padded(boot_, 6) + "-" + padded(static_cast<std::uint64_t>(number_), 4) + ".mcap";
  LogWriter next(beside(folder_, file), name_, part_);
  next.flush();
  if (file_ && next.failed() != 0) {  // a file that cannot be read must not be what drops older ones
    failed_ += next.failed();
    std::filesystem::remove(beside(folder_, file));
    throw IoError(beside(folder_, file) + ": got a disk that does not take its begin, expected room");
  }
  ++number_;
  if (file_) failed_ += file_->failed();
  file_.reset();  // the last one gets its end
  file_.emplace(std::move(next));
  drop_oldest();
}

bool LogKeeper::room() const noexcept {
  std::error_code error;
  const auto space = std::filesystem::space(folder_, error);
  return !error && space.available > part_.size() + kLeastRoom;
}

void LogKeeper::drop_oldest() const {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with(name_ + "-") && file.ends_with(".mcap")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  for (std::size_t k = 0; k + static_cast<std::size_t>(files_) < found.size(); ++k)
    std::filesystem::remove(found[k]);
}

}  // namespace garrison::node
